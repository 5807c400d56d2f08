#pragma once

#include "graze/results/stored_run.hpp"
#include "graze/sweep/escape_law.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// The law by which motions of a run leave a chaotic transient, at one set of parameter values.
struct EscapeRate {
    std::vector<double> parameters; ///< values of the parameters that the run varies, in their order
    EscapeLaw law;
    std::vector<std::size_t> chaotic; ///< numbers of points labelled chaotic that, by this law, will leave as well
};

/// Escape rates of a run whose points begin at many states: a basin, or simulations that count the passages of a
/// section. A motion has left when it has settled on a regular attractor, or has escaped or ended. Parameter values at
/// which no law holds are left out.
std::vector<EscapeRate> escape_rates(const StoredRun& run);

/// Changes the label of points of a run from `chaotic` to `transient` where other points leave by a law that these
/// points obey too.
void label_transients(ResultFile& file, const std::string& run);

} // namespace graze
