#pragma once

#include "graze/study/workers.hpp"
#include "program/mpi_start.hpp"

#include <memory>

namespace graze {

/// The processes that were started with this one, process 0. @param jobs threads of each; 0: one
/// @throws InputError when they cannot be reached
std::unique_ptr<Workers> mpi_workers(const MpiStart& start, int jobs);

/// What each of them does until process 0 lets it end. It prints nothing: process 0 says what is wrong.
/// @return the exit code
int work_by_mpi(const MpiStart& start, int jobs);

} // namespace graze
