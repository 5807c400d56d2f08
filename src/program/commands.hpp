#pragma once

#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// Each command returns the exit code. @throws InputError
int check_command(const CheckArguments& arguments, const Console& console);
int models_command(const ModelsArguments& arguments, const Console& console);
int simulate_command(const SimulateArguments& arguments, const Console& console);
int run_command(const RunArguments& arguments, const Console& console);
int export_command(const ExportArguments& arguments, const Console& console);
int plot_command(const PlotArguments& arguments, const Console& console);
int info_command(const InfoArguments& arguments, const Console& console);
int help_command(const CLI::App& app, const HelpArguments& arguments, const Console& console);
int completion_command(const CLI::App& app, const CompletionArguments& arguments, const Console& console);
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

/// Writes a table to the file or to standard output. In format `table`, columns that do not fit the terminal are left
/// out with a message, unless all were asked for.
/// @param kept names of columns that are never left out
/// @throws InputError when it cannot be written
void deliver(const Table& table, const OutputArguments& output, const JsonObject& heading, const Console& console,
             const std::vector<std::string>& kept = {});
/// Flushes standard output. @throws InputError when what was written to it could not be delivered
void require_delivered(const Console& console);

} // namespace graze
