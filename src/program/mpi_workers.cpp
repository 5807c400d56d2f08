#include "program/mpi_workers.hpp"

#include "graze/study/part_computer.hpp"
#include "program/mpi_messages.hpp"
#include "program/program.hpp"

#include <algorithm>

namespace graze {

namespace {

std::size_t threads_of(int jobs) {
    return static_cast<std::size_t>(std::max(jobs, 1));
}

} // namespace

std::unique_ptr<Workers> mpi_workers(const MpiStart& start, int jobs) {
    return std::make_unique<Workers>(mpi_messages(start), threads_of(jobs));
}

int work_by_mpi(const MpiStart& start, int jobs) {
    std::unique_ptr<Messages> messages;
    try {
        messages = mpi_messages(start);
    } catch (const InputError&) { // which process 0 meets too
        return exit_bad_input;
    }
    compute_parts(*messages, threads_of(jobs));
    return exit_success;
}

} // namespace graze
