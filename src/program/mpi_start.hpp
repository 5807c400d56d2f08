#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace graze {

/// How this process was started together with others that belong to it.
struct MpiStart {
    std::size_t processes = 2; ///< all of them
    std::size_t number = 0;    ///< of this one, from 0 on
    bool knows_others = true;  ///< whether Open MPI can find the others; without that it ends the process

    bool operator==(const MpiStart&) const = default;
};

/// Looks at the variables that mpirun and srun set. None: this process was started alone, as by the script of a batch
/// job, or by mpirun -n 1.
/// @param variable gives the value of a variable of the environment, or null
std::optional<MpiStart> mpi_start(const std::function<const char*(const char* name)>& variable);
/// The same of this process.
std::optional<MpiStart> mpi_start();

} // namespace graze
