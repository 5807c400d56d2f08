#pragma once

#include "graze/results/stored_run.hpp"
#include "graze/sweep/escape_law.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// How motions of a run that have the same parameters leave a chaotic transient.
struct EscapeRate {
    std::vector<double> parameters; ///< those that the run varies, in their order
    EscapeLaw law;
    std::vector<std::size_t> chaotic; ///< numbers of points that are chaotic so far, but bound to leave by that law
};

/// Of a run whose points begin at many states: a basin, or simulations that count the passages of a section. A motion
/// has left when it has settled on something regular, or has escaped or ended. Only parameters at which there is a law.
std::vector<EscapeRate> escape_rates(const StoredRun& run);

/// Labels as `transient` those points of a run that were called chaotic, where others leave by a law that these agree
/// with too.
void label_transients(ResultFile& file, const std::string& run);

} // namespace graze
