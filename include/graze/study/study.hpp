#pragma once

#include "graze/model/model.hpp"
#include "graze/sweep/attractor.hpp"
#include "graze/sweep/sampling.hpp"
#include "graze/symbolic/input_error.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

enum class RunKind { simulate, sweep, basin };
std::string_view name_of(RunKind kind);

/// Something that varies from point to point: a parameter or an initial state.
struct Variation {
    std::string name, unit;
    bool is_state = false;
    std::size_t index = 0;      ///< among the independent parameters, or the states
    std::vector<double> values; ///< in rising order as the file gives them; empty: drawn at random
    double low = 0, high = 0;   ///< of random draws
    bool logarithmic = false;   ///< draws are uniform in the logarithm
    double offset = 0;          ///< added to draws
};

/// In which order a sweep goes through the values of its first axis.
enum class SweepDirection { up, down, both };

/// Where the points of a run begin, instead of the model's initial state.
struct StartFrom {
    std::string run;                       ///< an earlier run of the study
    std::optional<std::string> coordinate; ///< the point nearest to `value`; none: its last point
    double value = 0;
    std::optional<std::string> direction; ///< "up" or "down"
    Place place;
};

/// One named computation.
struct StudyRun {
    std::string name, text;
    RunKind kind = RunKind::simulate;
    Place place;
    Model model;                 ///< parameters and initial state set as the run asks
    std::vector<Variation> axes; ///< the first is swept along, the others make chains. Lists vary as a grid
    std::size_t draws = 0;       ///< points drawn at random (times the grid of the lists); 0: none
    std::uint64_t seed = 1;
    SweepDirection direction = SweepDirection::up;
    bool carry = true; ///< sweeps: states are carried along
    std::optional<StartFrom> start;
    AttractorOptions attractor; ///< of sweeps and basins
    TransientOptions transient; ///< of simulations
    SimulationOptions simulation;
    std::vector<Sampling> samplings;
    std::vector<std::string> value_names, value_units;
    std::vector<Expression> values; ///< in states and parameters
};

/// One picture or table made from runs. What is not said is chosen by `kind` and the run.
struct StudyPicture {
    std::string name, kind,
        title; ///< kind: bifurcation, basin, spectrum, history, portrait, regression, scatter, table
    std::vector<std::string> runs;
    std::string x;                                                  ///< coordinate or value
    std::vector<std::string> y;                                     ///< values, one panel each
    std::vector<std::string> samplings;                             ///< empty: all
    std::vector<std::string> directions;                            ///< of sweeps; empty: all
    std::optional<std::pair<double, double>> x_range, y_range, fit; ///< fit: range of x of a regression
    std::vector<std::pair<std::string, double>> at; ///< points nearest to these, of histories, portraits, spectra
    bool logarithmic_x = false, logarithmic_y = false;
    bool successive = false; ///< regression: each value against the one before it in the same point
    std::string group;       ///< coordinate by which a regression is split
    std::string format = "png";
    Place place;
};

struct Study {
    std::string name, text, source;
    std::string file;           ///< for messages
    std::vector<StudyRun> runs; ///< each after those it starts from
    std::vector<StudyPicture> pictures;
};

/// Reads a study from TOML text; docs/study-format.md describes it.
/// @param file the name to use in messages; models are looked for relative to its folder
/// @throws InputError with the place of the first thing wrong
Study parse_study(std::string_view text, const std::string& file);
Study read_study(const std::string& path);

} // namespace graze
