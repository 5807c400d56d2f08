#pragma once

#include "graze/base/input_error.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "graze/model/model.hpp"
#include "graze/results/result_file.hpp"
#include "graze/results/run_kind.hpp"
#include "graze/study/figure_style.hpp"
#include "graze/study/identify_request.hpp"
#include "graze/study/record_request.hpp"
#include "graze/sweep/attractor.hpp"
#include "graze/sweep/sampling.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Something that varies from point to point: a parameter or an initial state.
struct Variation {
    std::string name, unit;
    std::optional<std::size_t> state = std::nullopt; ///< whose initial value varies; none: the parameter does
    ParameterId parameter{};
    std::vector<double> values; ///< in rising order as the file gives them; empty: drawn at random
    double low = 0, high = 0;   ///< of random draws
    bool logarithmic = false;   ///< draws are uniform in the logarithm
    double offset = 0;          ///< added to draws
};

/// An initial state that follows from what varies.
struct FollowingState {
    std::size_t state = 0;
    Expression value{}; ///< in parameters and in states that vary
};

/// In which order a sweep goes through the values of its first axis.
enum class SweepDirection { up, down, both };

/// Where the points of a run begin, instead of the model's initial state.
struct StartFrom {
    std::string run;                       ///< an earlier run of the study
    std::optional<std::string> coordinate; ///< the point nearest to `value`; none: its last point
    double value = 0;
    std::optional<std::string> direction; ///< "up" or "down"
    std::string point;                    ///< of runs of orbits: a label such as "GR1", or a number
    std::string onto; ///< "same", "other", "twin", of curves a type; or empty: chosen by type and parameter
    Place place;
};

/// What runs of kind orbit and continue ask for besides.
struct BranchRequest {
    std::string signature; ///< of the orbit; empty: whatever is found
    Place signature_place;
    std::string table;            ///< file of a motion to start from; empty: none
    std::string table_text;       ///< its contents, where they are known already and no file is read
    std::vector<ParameterId> set; ///< parameters that the run itself sets, rather than the orbit that it starts from
    BranchSettings settings;
    std::size_t rungs = 8; ///< of ladders: grazings, at most
    bool touches = false;  ///< whether orbits that touch are told what becomes of them: OrbitRecord::touch

    bool has_table() const { return !table.empty() || !table_text.empty(); }
    /// Whether a curve holds what its first point is, rather than a monitor that is fixed.
    bool keeps_point() const;
    /// How many of the free parameters are those of the point: two for one of codimension two.
    std::size_t kept_conditions() const;
    /// Of curves as if a point that can be kept was known already. @throws InputError as BranchSettings::validate
    void validate(RunKind kind, const Model& model) const;
};

/// One named computation.
struct StudyRun {
    std::string name, text, model_path; ///< of the model; empty: it is a shipped one
    RunKind kind = RunKind::simulate;
    Place place;
    /// Parameters and initial state set as the run asks. Of a record its channels, as states that rest.
    Model model;
    std::vector<Variation> axes;           ///< the first is swept along, the others make chains. Lists vary as a grid
    std::vector<FollowingState> following; ///< initial states, other than the model's, of each point anew
    std::size_t draws = 0;                 ///< points drawn at random (times the grid of the lists); 0: none
    std::uint64_t seed = 1;
    SweepDirection direction =
        SweepDirection::up; ///< also of branches, at first; in files these go both ways if not told
    bool carry = true;      ///< sweeps: states are carried along
    std::optional<StartFrom> start;
    std::vector<std::string> parameters; ///< runs of kind identify: what they find takes the place of what is set
    Place parameters_place;
    AttractorOptions attractor; ///< of sweeps and basins
    TransientOptions transient; ///< of simulations
    BranchRequest branch;       ///< of orbits and their branches
    RecordRequest record;       ///< of records
    IdentifyRequest identify;   ///< of what is found from them
    SimulationOptions simulation;
    std::vector<Sampling> samplings;
    std::vector<std::string> value_names, value_units;
    std::vector<Expression> values;     ///< in states and parameters
    std::vector<PointName> point_names; ///< of special points of a branch; no part of what is computed

    /// How many points there are, and how many of them begin by themselves: a sweep carries states along its first
    /// axis.
    double points() const;
    double chains() const;
    /// Names of the runs that have to be there before, with where that is said.
    std::vector<std::pair<std::string, Place>> needs() const;
    /// Of what its points are sampled.
    std::vector<std::string> sampling_names() const;
    bool has_motions() const { return graze::has_motions(kind); }
    bool is_branch() const { return graze::is_branch(kind); }
    bool is_followed() const { return graze::is_followed(kind); }
    bool is_measured() const { return graze::is_measured(kind); }
};

/// One picture or table made from runs. What is not said is chosen by `kind` and the run.
struct StudyPicture {
    std::string name, kind,
        title; ///< kind: bifurcation, branch, basin, map, spectrum, history, portrait, regression, scatter, residuals
    std::vector<std::string> runs;
    std::vector<std::string> over;       ///< runs that are drawn over those, into panels of the same values
    std::string x;                       ///< coordinate or value
    std::vector<std::string> y;          ///< values, one panel each
    std::vector<std::string> samplings;  ///< empty: all
    std::vector<std::string> directions; ///< of sweeps; empty: all
    std::optional<std::pair<double, double>> x_range, y_range, fit; ///< fit: range of x of a regression
    std::vector<std::pair<std::string, double>> at; ///< points nearest to these, of histories, portraits, spectra
    /// Of histories and portraits: labels, or numbers, of orbits. Of branches: labels or types that are marked.
    std::vector<std::string> points;
    bool logarithmic_x = false, logarithmic_y = false;
    bool successive = false; ///< regression: each value against the one before it in the same point
    std::string group;       ///< coordinate by which a regression is split
    std::string format = "png";
    std::vector<std::pair<std::string, std::string>>
        names;                         ///< what is shown in the place of names of runs, values, ...
    std::string x_label;               ///< all of what stands beside the axis; empty: by itself
    std::vector<std::string> y_labels; ///< the same of the panels' y
    FigureStyle style;
    Place place;
};

/// A table made from runs, in a file of its own: a row for each special point of a branch, for each sample of another
/// run, or for each of its points if only they are asked for.
struct StudyTable {
    struct Column {
        std::string name;
        std::string value; ///< what a run calls it, or an expression of SQL in such names
    };
    std::string name, text;
    std::vector<std::string> runs; ///< one below the other
    std::vector<Column> columns; ///< behind the run's name, if there are several, and the point's label, if it has one
    std::vector<Column> ratios;  ///< how the distances between rows go on: `value` names the column
    std::vector<std::string> points; ///< of branches: only these types, such as "GR", or labels, such as "GR1"
    std::vector<std::string> samplings, directions; ///< only these; empty: all
    Place place;
};

/// Whether pictures can be made so. @throws InputError with this place
void check_style(const FigureStyle& style, const Place& place);

/// Values of parameters that take the place of those that a study and its models give.
using ParameterValues = std::vector<std::pair<std::string, double>>;

struct Study {
    std::string name, text, source;
    std::string file;           ///< for messages
    ParameterValues set;        ///< with which it was read, instead of its own
    std::vector<StudyRun> runs; ///< each after those it starts from
    std::vector<StudyPicture> pictures;
    std::vector<StudyTable> tables;

    /// Null when there is none of that name; valid until runs are added or removed.
    const StudyRun* find_run(const std::string& run) const;
};

/// Reads a study from TOML text; docs/study-format.md describes it.
/// @param file the name to use in messages; models are looked for relative to its folder
/// @param set parameters of all models that have them, in the place of what the study says of them: expressions in the
///        study see these values
/// @throws InputErrors with the places of all that is wrong, or InputError for the only one; without a place for a
///         parameter that no model has, or that every run varies
Study parse_study(std::string_view text, const std::string& file, const ParameterValues& set = {});
Study read_study(const std::string& path, const ParameterValues& set = {});
/// Whether a TOML text is a study rather than a model: it has runs. @throws InputError when it is no TOML
bool is_study_text(std::string_view text, const std::string& file);
/// The files that a study is made of: itself, its models, tables of orbits.
std::vector<std::string> input_files(const Study& study);

} // namespace graze
