#include "program/mpi_start.hpp"

#include <charconv>
#include <cstdlib>
#include <string_view>

namespace graze {

namespace {

std::optional<std::size_t> whole_number(const char* text) {
    if (text == nullptr)
        return std::nullopt;
    const std::string_view digits(text);
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return error == std::errc() && end == digits.data() + digits.size() ? std::optional(number) : std::nullopt;
}

/// Names of the variables of one way to start processes.
struct StartVariables {
    const char* processes;
    const char* number;
    const char* step; ///< a further one that has to be there; null: none
};

// The first that is there counts: mpirun starts its processes by srun where there is Slurm. The variables of jobs and
// of arrays of jobs do not count: scripts have them too.
constexpr StartVariables ways[] = {{"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK", nullptr},
                                   {"PMI_SIZE", "PMI_RANK", nullptr},
                                   {"SLURM_STEP_NUM_TASKS", "SLURM_PROCID", "SLURM_STEP_ID"}};

} // namespace

std::optional<MpiStart> mpi_start(const std::function<const char*(const char* name)>& variable) {
    for (const StartVariables& way : ways) {
        const auto processes = whole_number(variable(way.processes)), number = whole_number(variable(way.number));
        if (!processes || !number || (way.step != nullptr && !whole_number(variable(way.step))))
            continue;
        if (*processes < 2)
            return std::nullopt;
        const bool by_open_mpi = &way == &ways[0];
        return MpiStart{*processes, *number, by_open_mpi || variable("PMIX_RANK") != nullptr};
    }
    return std::nullopt;
}

std::optional<MpiStart> mpi_start() {
    return mpi_start([](const char* name) { return std::getenv(name); });
}

} // namespace graze
