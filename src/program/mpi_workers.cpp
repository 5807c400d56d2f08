#include "program/mpi_workers.hpp"

#include "graze/layout/wafer_yield.hpp"
#include "graze/study/part_computer.hpp"
#include "program/arguments.hpp"
#include "program/interrupt.hpp"
#include "program/mpi_messages.hpp"
#include "program/mpi_start.hpp"
#include "program/program.hpp"

#include <algorithm>
#include <cstddef>

namespace graze {

namespace {

/// What a process does until process 0 lets it end.
int work_by_mpi(const MpiStart& start, std::size_t threads) {
    const InterruptGuard guard; // a signal reaches process 0 too, which ends all in order
    std::unique_ptr<Messages> messages;
    try {
        messages = mpi_messages(start);
    } catch (const InputError&) { // which process 0 meets too
        return exit_bad_input;
    }
    compute_parts(*messages, threads, wafer_examination_of);
    return exit_success;
}

} // namespace

int with_workers(int jobs, const std::function<int(std::unique_ptr<Workers> workers)>& command) {
    const auto started = mpi_start();
    const auto threads = static_cast<std::size_t>(std::max(jobs, 1));
    if (!started)
        return command(nullptr);
    if (started->number > 0)
        return work_by_mpi(*started, threads);
    return command(std::make_unique<Workers>(mpi_messages(*started), threads));
}

int threads_beside(const Workers* workers, int jobs) {
    return workers ? std::max(jobs, 1) : threads_for(jobs);
}

void carry_out(Workers* workers, const std::function<void(const std::function<bool()>& interrupted)>& work) {
    const auto interrupted = [] { return InterruptGuard::requested(); };
    workers ? workers->carry_out(work, interrupted) : work(interrupted);
}

} // namespace graze
