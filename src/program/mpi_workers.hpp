#pragma once

#include "graze/study/workers.hpp"

#include <functional>
#include <memory>

namespace graze {

/// Carries out a command. If mpirun or srun has started this process with others, process 0 alone carries it out, with
/// the others, and these compute for it. They print nothing: process 0 says what is wrong.
/// @param jobs threads of each of them; 0: one
/// @param command given the others; null: there are none. It may let them end before it does.
/// @return the exit code @throws InputError when process 0 cannot reach the others
int with_workers(int jobs, const std::function<int(std::unique_ptr<Workers> workers)>& command);

/// How many threads this process has. @param workers null: there are none
int threads_beside(const Workers* workers, int jobs);

/// Carries out work in which the others may be asked for something. @param workers null: there are none
/// @param work given whether it has to end soon, because of a signal
void carry_out(Workers* workers, const std::function<void(const std::function<bool()>& interrupted)>& work);

} // namespace graze
