#pragma once

#include "graze/results/stored_orbit.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// Each command returns the exit code. @throws InputError
int check_command(const CheckArguments& arguments, const Console& console);
int models_command(const ModelsArguments& arguments, const Console& console);
int simulate_command(const SimulateArguments& arguments, const Console& console);
int run_command(const RunArguments& arguments, const Console& console);
int atlas_command(const AtlasArguments& arguments, const Console& console);
int merge_command(const MergeArguments& arguments, const Console& console);
int export_command(const ExportArguments& arguments, const Console& console);
int plot_command(const PlotArguments& arguments, const Console& console);
int view_command(const ViewArguments& arguments, const Console& console);
int info_command(const InfoArguments& arguments, const Console& console);
int help_command(const HelpArguments& arguments, const Console& console);
int completion_command(const CompletionArguments& arguments, const Console& console);
int points_command(const PointsArguments& arguments, const Console& console);
int orbit_command(const OrbitArguments& arguments, const Console& console);
int ladder_command(const LadderArguments& arguments, const Console& console);
int grazing_command(const GrazingArguments& arguments, const Console& console);
int trip_command(const TripArguments& arguments, const Console& console);
int tolerance_command(const ToleranceArguments& arguments, const Console& console);
int design_command(const DesignArguments& arguments, const Console& console);
int layout_command(const LayoutArguments& arguments, const Console& console);
int record_command(const RecordArguments& arguments, const Console& console);
int identify_command(const IdentifyArguments& arguments, const Console& console);
int bench_command(const BenchArguments& arguments, const Console& console);
int acquire_command(const AcquireArguments& arguments, const Console& console);

/// Commands, or parts of them, for some of their options. Each returns the exit code. @throws InputError
int list_studies(const RunArguments& arguments, const Console& console);
/// Lists the keys of runs of a kind, or of all kinds.
int list_study_keys(const RunArguments& arguments, const Console& console);
/// True when `graze trip` is asked about a parameter that changes in time: --ramp, --wave or --noise.
bool is_disturbed(const TripArguments& arguments);
int disturbed_trips(const ResultFile& file, const TripArguments& arguments, const Console& console);
/// @return exit_success if the fit converged and passed its checks
int identify_fit(const IdentifyArguments& arguments, const Console& console);
/// Computes the runs of kind `identify` of a study that have no results yet, and the runs they depend on, into the
/// study's result file; then shows their estimates.
int identify_study(const IdentifyArguments& arguments, const Console& console);

/// Writes a table to the file or to standard output. In format `table`, columns that do not fit the terminal are left
/// out with a message, unless all were asked for.
/// @param kept names of columns that are never left out
/// @throws InputError when it cannot be written
void deliver(const Table& table, const OutputArguments& output, const JsonObject& heading, const Console& console,
             const std::vector<std::string>& kept = {});
/// The first members of a table's heading in JSON: the point of a branch to which the table belongs.
JsonObject heading_of_point(const ResultFile& file, const StoredOrbit& stored);
/// Flushes standard output. @throws InputError when what was written to it could not be delivered
void require_delivered(const Console& console);

} // namespace graze
