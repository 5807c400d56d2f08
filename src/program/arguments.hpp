#pragma once

#include "graze/record/impacts.hpp"
#include "graze/record/processed_record.hpp"
#include "program/table.hpp"

#include <CLI/App.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Options of the output of tables, which many commands share.
struct OutputArguments {
    TableFormat format = TableFormat::table;
    int digits = 0;   ///< significant digits; 0: the default of the format
    std::string file; ///< empty: standard output
    bool all = false; ///< show all columns, even if the table is wider than the terminal

    int shown_digits() const { return digits > 0 ? digits : format == TableFormat::table ? 8 : 17; }
};

struct CheckArguments {
    std::string model, graph;
    OutputArguments output;
};

struct ModelsArguments {
    std::string name, file, quadrature;
    bool show = false;
    std::optional<int> beam_modes, points;
    OutputArguments output;
};

/// The appearance of a picture.
struct StyleArguments {
    std::string size, font;
    bool grey = false;
};

/// Texts are expressions in the model's parameters, not yet evaluated; an empty text was not given.
struct SimulateArguments {
    std::string model, mode;
    std::vector<std::string> set, from;

    std::string time, after, phase;
    std::optional<int> periods, skip;
    std::optional<int> contact_count;

    std::string table;
    bool contacts = false, minima = false;
    std::vector<std::string> sections, extrema, events, quantities, derivatives;
    std::optional<int> samples;
    std::string every;
    OutputArguments output;

    std::string plot, plot_data;
    std::vector<std::string> portraits;
    StyleArguments style;

    double tolerance = 1e-12;
    int order = 0;
    std::string largest_step;
    std::size_t steps = 100'000'000;
    bool progress = false, quiet = false;
};

struct RunArguments {
    std::string study, folder, keys;
    std::vector<std::string> only, set;
    int jobs = 0; ///< 0: as many as there are cores
    bool progress = false, quiet = false, list = false, show = false, no_pictures = false, steps = false,
         schema = false;
    OutputArguments output;
};

struct ExportArguments {
    std::string file, what = "points", sql, label, direction, hdf5;
    std::vector<std::string> runs;
    OutputArguments output;
};

struct PlotArguments {
    std::string file, kind, x, title, x_range, y_range, fit, group, output, data, x_label;
    StyleArguments style;
    std::vector<std::string> runs, y, samples, directions, at, points, logarithmic, names, y_labels;
    bool successive = false;
};

struct PointsArguments {
    std::string file;
    std::vector<std::string> runs, types;
    OutputArguments output;
};

struct OrbitArguments {
    std::string file, point, plot, data, x;
    std::vector<std::string> quantities, y;
    std::optional<std::size_t> samples;
    OutputArguments output;
};

struct LadderArguments {
    std::string file, point, parameter;
    int rungs = 8;
    OutputArguments output;
};

struct GrazingArguments {
    std::string file, point, parameter;
    bool verify = false;
    OutputArguments output;
};

struct TripArguments {
    std::string file, point, beside, parameter, until, at, plot, data;
    std::vector<std::string> overshoots, disturbances, ramps, waves, noises;
    std::optional<double> greatest_speed, wave_period, memory;
    std::optional<long> cycles; ///< none: 2000, and 100 under noise
    std::size_t motions = 1000, seed = 1;
    int jobs = 0; ///< 0: as many as there are cores
    OutputArguments output;
};

struct ToleranceArguments {
    std::string file, point, parameter, within, plot, data;
    std::vector<std::string> vary;
    std::size_t devices = 10'000, seed = 1;
    int jobs = 0; ///< 0: as many as there are cores
    OutputArguments output;
};

struct DesignArguments {
    std::string design, folder;
    int jobs = 0; ///< 0: as many as there are cores
    bool quiet = false, list = false, show = false, no_pictures = false;
    OutputArguments output;
};

struct LayoutArguments {
    std::string design, from_design, file, picture, parameters, recipe, markers, verilog, folder;
    std::optional<std::size_t> yield; ///< wafers
    std::uint64_t seed = 1;
    int jobs = 0;
    std::vector<std::string> set;
    std::optional<int> mask;
    bool wafer = false, despite_rules = false;
    OutputArguments output;
};

/// Items of lists may hold several values, separated by commas.
struct RecordArguments {
    std::vector<std::string> files;
    std::string columns, group;
    std::size_t skip = 0, names_line = 0, units_line = 0;
    std::vector<std::string> scales;
    std::optional<double> from, to;
    std::optional<double> pass, stop;
    std::size_t every = 1;
    std::string derivative;
    std::size_t half_width = 0;
    std::string what = "channels", reference, displacement;
    std::vector<std::string> channels, negated, phases;
    double level = 0, hysteresis = 0;
    ImpactWindow impacts;
    std::size_t part = 0;
    OutputArguments output;
    std::string write, plot, data;
};

struct IdentifyArguments {
    std::string what;
    RecordArguments reading; ///< the files and how they are read; the output and the picture
    std::string channel, displacement, voltage, current;
    std::size_t peaks = 10;
    ImpactWindow impacts;
    std::optional<double> gap, stiffness, frequency;
    double gap_error = 0, stiffness_error = 0, clamped = 0;
    std::vector<double> noise; ///< standard deviations of displacement and current; empty: not given
    std::string beta1, beta2;
    // For fits: lists of NAME=VALUE and similar items, not yet parsed.
    std::vector<std::string> free, set, start, known, meanings, gains, offsets, noises, own;
    std::string mode, loss = "squares", piece, table = "numbers", save;
    std::optional<double> time_limit; ///< for a fit, in seconds
    bool progress = false;
};

/// Lists hold texts NAME=VALUE, not yet parsed.
struct BenchArguments {
    std::string model;
    std::vector<std::string> set, from;
    std::string amplitude = "V0", frequency = "f", offset;
    double time_unit = 1;
    std::vector<std::string> channels, noise, bias, drift, range;
    int bits = 16;
    double anti_alias = 0;
    std::size_t seed = 1;
    std::string port;
    unsigned tcp = 0;
    double speed = 1;
    bool on_demand = false;
    std::optional<double> clip;
    std::string left_as;
    double drop = 0, delay = 0, break_for = 1;
    std::size_t break_after = 0, break_samples = 0;
};

struct AcquireArguments {
    std::string experiment, port, device, folder;
    bool dry_run = false, progress = false;
    std::string live, reference, channel;
    double phase = 0;
};

struct InfoArguments {
    std::string file;
    bool all = false;
    OutputArguments output;
};

struct HelpArguments {
    std::string command, folder;
    bool man = false;
};

struct CompletionArguments {
    std::string shell, file;
};

struct Console;

/// The options of all commands, and what the commands do.
struct Arguments {
    HelpArguments help;
    CompletionArguments completion;
    InfoArguments info;
    RunArguments run;
    ExportArguments exports;
    PlotArguments plot;
    PointsArguments points;
    OrbitArguments orbit;
    GrazingArguments grazing;
    TripArguments trip;
    LadderArguments ladder;
    ToleranceArguments tolerance;
    DesignArguments design;
    LayoutArguments layout;
    RecordArguments record;
    IdentifyArguments identify;
    BenchArguments bench;
    AcquireArguments acquire;
    CheckArguments check;
    ModelsArguments models;
    SimulateArguments simulate;
    std::map<std::string, std::function<int(const Console&)>> commands; ///< by name; each returns the exit code

    /// Registers a command. @param run what it does with its own options, which must outlive this
    template <class Own>
    void add_command(const char* name, int (*run)(const Own&, const Console&), const Own& own) {
        commands[name] = [run, &own](const Console& console) { return run(own, console); };
    }
};

/// Accepts only whole numbers within these bounds.
CLI::Validator whole_number(long least, long most);
/// These four accept only finite numbers: all, those above zero, those not below zero, and those within bounds.
CLI::Validator finite_number();
CLI::Validator positive_number();
CLI::Validator non_negative_number();
CLI::Validator number_between(double least, double most);
/// Accepts only these words.
CLI::Validator one_of(const std::vector<std::string>& words);

/// Number of threads for the option `--jobs`: the number of cores if it is 0.
int threads_for(int jobs);

/// Declares the command line: one sub-command for each member of `arguments`. Empty values are refused, except for
/// options declared as TEXT: an unset variable of a script would otherwise silently count as an option not given.
void declare_arguments(CLI::App& app, Arguments& arguments);

/// Joins `--contacts 4` into one word, since `--contacts` may also stand alone before the model's name.
std::vector<std::string> with_joined_counts(std::vector<std::string> arguments);

/// One line about what is wrong with a command line, and what to do.
std::string explain(const CLI::ParseError& error, const CLI::App& app);

} // namespace graze
