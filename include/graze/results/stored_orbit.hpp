#pragma once

#include "graze/results/result_file.hpp"
#include "graze/results/stored_run.hpp"

#include <complex>
#include <string>
#include <vector>

namespace graze {

/// The runs of a file that have orbits: all, or those with the given names.
/// @throws InputError for a name of another run, and if there are no such runs
std::vector<RunRecord> branch_runs(const ResultFile& file, const std::vector<std::string>& names, const Place& place);

/// An orbit of one run by its label, for example "GR1", or by its number. @throws InputError if there is none
OrbitRecord orbit_of_run(const ResultFile& file, const RunRecord& run, const std::string& point, const Place& place);

struct StoredOrbit {
    StoredRun run;
    OrbitRecord record;
};
/// An orbit of a file, named LABEL (if only one run has it), RUN:LABEL, RUN:NUMBER, or RUN (if it has only one orbit).
/// @throws InputError if no orbit or several orbits have this name
StoredOrbit find_stored_orbit(const ResultFile& file, const std::string& point, const Place& place);
/// The same. @throws InputError also for a torus, whose motions do not close
StoredOrbit find_closed_orbit(const ResultFile& file, const std::string& point, const Place& place);

/// The label, for example "GR1", or "point 17" if there is none.
std::string title_of(const OrbitRecord& record);
/// Multipliers as text, for example "0.5, -0.1+0.2i", in the given order.
std::string multipliers_text(const std::vector<std::complex<double>>& multipliers, int digits);
/// All multipliers of an orbit as text; "undefined" if the orbit meets an event with zero speed.
std::string multipliers_text(const OrbitSolution& solution, int digits);
/// Whether the orbit is no motion of the model. False at special points where physical orbits end, for example grazing.
bool is_unphysical(const OrbitRecord& record);
/// The parameter that a run follows; empty if it follows none.
std::string followed_parameter(const RunRecord& run);
/// Values at an orbit of all parameters that are coordinate columns of its run.
std::vector<double> parameters_of(const StoredRun& run, const OrbitRecord& record);

} // namespace graze
