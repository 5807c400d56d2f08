#pragma once

#include "graze/results/result_file.hpp"
#include "graze/results/stored_run.hpp"

#include <complex>
#include <string>
#include <vector>

namespace graze {

/// Runs with orbits: all of the file, or those of the names given.
/// @throws InputError for names of other runs, and when there are none, saying how to get some
std::vector<RunRecord> branch_runs(const ResultFile& file, const std::vector<std::string>& names, const Place& place);

/// An orbit of one run by its label, such as "GR1", or its number. @throws InputError when there is none
OrbitRecord orbit_of_run(const ResultFile& file, const RunRecord& run, const std::string& point, const Place& place);

struct StoredOrbit {
    StoredRun run;
    OrbitRecord record;
};
/// An orbit of a file: LABEL (if only one run has it), RUN:LABEL, RUN:NUMBER, or RUN where a run has only one.
/// @throws InputError when there is none, or several
StoredOrbit find_stored_orbit(const ResultFile& file, const std::string& point, const Place& place);

/// "GR1", or "point 17" where there is no label.
std::string title_of(const OrbitRecord& record);
/// "0.5, -0.1+0.2i", in the order in which they are kept: largest first.
std::string multipliers_text(const std::vector<std::complex<double>>& multipliers, int digits);
/// All multipliers of an orbit; "undefined" where an event is met without speed.
std::string multipliers_text(const OrbitSolution& solution, int digits);
/// Whether the model would not follow the orbit; not said of those at which just that begins, as at grazing.
bool is_unphysical(const OrbitRecord& record);
/// The followed parameter of a run of orbits; empty where none is.
std::string followed_parameter(const RunRecord& run);
/// Values of all parameters of a run's columns at an orbit.
std::vector<double> parameters_of(const StoredRun& run, const OrbitRecord& record);

} // namespace graze
