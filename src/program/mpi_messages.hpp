#pragma once

#include "graze/study/messages.hpp"
#include "program/mpi_start.hpp"

#include <memory>

namespace graze {

/// Connects this process with those that were started with it, until the messages are destroyed; once in a process. All
/// calls belong to one thread.
/// @throws InputError when that is not possible
std::unique_ptr<Messages> mpi_messages(const MpiStart& start);

} // namespace graze
