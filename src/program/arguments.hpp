#pragma once

#include "graze/picture/record_table.hpp"
#include "graze/study/run_length.hpp"
#include "graze/study/study.hpp"
#include "program/table.hpp"

#include <CLI/App.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
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

    std::string time, after;
    RunLengthRequest length; ///< but for these times

    std::string table;
    bool contacts = false, minima = false;
    std::vector<std::string> sections, extrema, events, quantities, derivatives;
    std::optional<int> samples;
    std::string every;
    OutputArguments output;

    std::string plot, plot_data;
    std::vector<std::string> portraits;
    StyleArguments style;

    SimulationOptions method; ///< but for the largest step
    std::string largest_step;
    bool progress = false, quiet = false;
};

/// What commands tell of the runs of a study.
struct StudyArguments {
    bool progress = false, quiet = false, no_pictures = false;
    OutputArguments output;
};

struct RunArguments : StudyArguments {
    std::string study, folder, keys, part;
    std::vector<std::string> only, set, sbatch;
    int jobs = 0;  ///< 0: as many as there are cores
    int slurm = 0; ///< parts that SLURM computes; 0: they are computed here
    bool list = false, show = false, steps = false, schema = false, no_wait = false;
};

/// Texts of ranges and values are not yet parsed; an empty text or list was not given.
struct AtlasArguments : StudyArguments {
    std::string subject; ///< a model, whose atlas is made; without `along` results that have one
    std::vector<std::string> along, set, from, starts;
    std::string folder, section, what, run;
    std::optional<std::size_t> contacts, multiple, branches, curves, draws, seed;
    std::optional<double> minutes;
    int jobs = 0; ///< 0: as many as there are cores
};

struct MergeArguments : StudyArguments {
    std::vector<std::string> parts;
    std::string folder;
};

struct ExportArguments {
    std::string file, what = "points", sql, label, direction, hdf5;
    std::vector<std::string> runs;
    OutputArguments output;
};

struct PlotArguments {
    StudyPicture picture; ///< what is written as it is meant; lists hold items that may be separated by commas
    std::string file, x_range, y_range, fit, output, data;
    StyleArguments style;
    std::vector<std::string> at, logarithmic, names;
};

struct ViewArguments {
    std::string opened, folder;
    int port = 0; ///< 0: a free one
    int jobs = 0; ///< 0: as many as there are cores
    bool model = false, open = false;
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
    std::vector<std::string> files, scales, phases;
    RecordProcessing processing;  ///< without scales
    RecordTableRequest request{}; ///< without `what` and phases
    std::string what = "channels";
    OutputArguments output;
    std::string write, plot, data;
};

struct IdentifyArguments {
    std::string what;
    RecordArguments reading;   ///< the files and how they are read; the output and the picture
    IdentifyRequest request;   ///< but for the following
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
    const CLI::App* app = nullptr; ///< all commands
    std::string command, folder;
    bool man = false;
};

struct CompletionArguments {
    const CLI::App* app = nullptr;
    std::string shell, file;
};

/// Number of threads for the option `--jobs`: the number of cores if it is 0.
inline int threads_for(int jobs) {
    return jobs > 0 ? jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

} // namespace graze
