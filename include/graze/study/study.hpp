#pragma once

#include "graze/base/input_error.hpp"
#include "graze/model/model.hpp"
#include "graze/results/result_file.hpp"
#include "graze/results/run_kind.hpp"
#include "graze/study/branch_request.hpp"
#include "graze/study/figure_style.hpp"
#include "graze/study/identify_request.hpp"
#include "graze/study/motion_request.hpp"
#include "graze/study/record_request.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace graze {

/// The point of another run at which a run begins, instead of the model's initial state.
struct StartFrom {
    std::string run;                       ///< an earlier run of the study
    std::optional<std::string> coordinate; ///< the point nearest to `value` of it is taken; none: the last point
    double value = 0;
    std::optional<std::string> direction; ///< only points of this direction: "up" or "down"
    std::string point;                    ///< label such as "GR1", or number of the point; empty: see `coordinate`
    /// Which branch through the point is followed: "same", "other", or "twin", which is the symmetric image. Of curves
    /// the type of points, such as "SN". Empty: chosen by the type of the point and the parameter.
    std::string onto;
    Place place;
};

/// What a run asks for besides what all runs have in common: the alternative that belongs to its kind.
using RunRequest = std::variant<MotionRequest, BranchRequest, RecordRequest, IdentifyRequest>;

/// One named computation: what runs of all kinds have in common, and a request that depends on the kind.
struct StudyRun {
    StudyRun() = default;
    explicit StudyRun(RunKind of_kind) { set_kind(of_kind); }

    std::string name, text, model_path; ///< path of the model's file; empty: the model is a shipped one
    RunKind kind = RunKind::simulate;   ///< changed by set_kind
    Place place;
    /// With the parameters and the initial state that the run sets. Of kind record: one whose states are the channels.
    Model model;
    std::vector<ParameterId> set; ///< parameters that the run itself sets, rather than the point that it starts from
    std::optional<StartFrom> start;
    std::vector<std::string> parameters; ///< runs of kind identify, whose estimates replace the values of parameters
    Place parameters_place;
    std::vector<std::string> value_names, value_units;
    std::vector<Expression> values;     ///< in states and parameters
    std::vector<PointName> point_names; ///< of special points of a branch; these do not influence what is computed
    RunRequest request;

    /// Replaces the request by the default one of the kind, unless it belongs to the kind already.
    void set_kind(RunKind of_kind);
    /// The request of the run; a copy of it where the run is a temporary. @throws InputError for a run of another kind
    MotionRequest& motion() & { return require<MotionRequest>(); }
    const MotionRequest& motion() const& { return require<MotionRequest>(); }
    MotionRequest motion() && { return std::move(require<MotionRequest>()); }
    BranchRequest& branch() & { return require<BranchRequest>(); }
    const BranchRequest& branch() const& { return require<BranchRequest>(); }
    BranchRequest branch() && { return std::move(require<BranchRequest>()); }
    RecordRequest& record() & { return require<RecordRequest>(); }
    const RecordRequest& record() const& { return require<RecordRequest>(); }
    RecordRequest record() && { return std::move(require<RecordRequest>()); }
    IdentifyRequest& identify() & { return require<IdentifyRequest>(); }
    const IdentifyRequest& identify() const& { return require<IdentifyRequest>(); }
    IdentifyRequest identify() && { return std::move(require<IdentifyRequest>()); }
    /// How a simulated motion settles, of runs of motions and of branches. @throws InputError for other runs
    AttractorOptions& attractor() & { return is_branch() ? branch().attractor : motion().attractor; }
    const AttractorOptions& attractor() const& { return is_branch() ? branch().attractor : motion().attractor; }
    void attractor() && = delete;

    /// Whether a parameter or initial state differs from point to point.
    bool varies(const std::string& parameter_or_state) const;
    /// The runs that must be computed before this one, each with the place where the study names it.
    std::vector<std::pair<std::string, Place>> needs() const;
    /// Names of the samplings of its points.
    std::vector<std::string> sampling_names() const;
    bool has_motions() const { return graze::has_motions(kind); }
    bool is_swept() const { return graze::is_swept(kind); }
    bool is_branch() const { return graze::is_branch(kind); }
    bool is_followed() const { return graze::is_followed(kind); }
    bool is_measured() const { return graze::is_measured(kind); }

private:
    [[noreturn]] void refuse_request() const;
    template <class Request>
    const Request& require() const {
        if (const auto* one = std::get_if<Request>(&request))
            return *one;
        refuse_request();
    }
    template <class Request>
    Request& require() {
        if (auto* one = std::get_if<Request>(&request))
            return *one;
        refuse_request();
    }
};

/// A picture made from runs. What is left empty is chosen by `kind` and by the run.
struct StudyPicture {
    std::string name, kind,
        title; ///< kind: bifurcation, branch, basin, map, spectrum, history, portrait, regression, scatter, residuals
    std::vector<std::string> runs;
    std::vector<std::string> over;       ///< runs that are drawn over `runs`, into panels of the same values
    std::string x;                       ///< coordinate or value
    std::vector<std::string> y;          ///< values, one panel each
    std::vector<std::string> samplings;  ///< empty: all
    std::vector<std::string> directions; ///< of sweeps; empty: all
    std::optional<std::pair<double, double>> x_range, y_range, fit; ///< fit: range of x of a regression
    std::vector<std::pair<std::string, double>>
        at; ///< of histories, portraits, spectra: points nearest to these values
    /// Of histories and portraits: labels, or numbers, of orbits. Of branches: labels or types that are marked.
    std::vector<std::string> points;
    bool logarithmic_x = false, logarithmic_y = false;
    bool successive = false; ///< regression: each value against the one before it in the same point
    std::string group;       ///< coordinate by which a regression is split
    std::string format = "png";
    std::vector<std::pair<std::string, std::string>> names; ///< text that replaces a name of a run, a value, ...
    std::string x_label;               ///< the whole label of the axis; empty: made from name and unit
    std::vector<std::string> y_labels; ///< the same for the y axis of each panel
    FigureStyle style;
    Place place;
};

/// A table made from runs, in a file of its own. It has a row for each special point of a branch. Of other runs it has
/// a row for each sample, or for each point if only quantities of points are asked for.
struct StudyTable {
    struct Column {
        std::string name;
        std::string value; ///< a name of the run, or an SQL expression in names of the run
    };
    std::string name, text;
    std::vector<std::string> runs;   ///< their rows follow one another
    std::vector<Column> columns;     ///< after the run's name, if there are several runs, and the point's label, if any
    std::vector<Column> ratios;      ///< ratios of successive differences (see make_table) of the column `value`
    std::vector<std::string> points; ///< of branches: only these types, such as "GR", or labels, such as "GR1"
    std::vector<std::string> samplings, directions; ///< only these; empty: all
    Place place;
};

/// @throws InputError with this place for sizes that no picture can have
void check_style(const FigureStyle& style, const Place& place);

/// Values of parameters, by name, that replace those of a study and its models.
using ParameterValues = std::vector<std::pair<std::string, double>>;
/// Models that a study can name besides shipped ones and those in files; they come first.
using NamedModels = std::map<std::string, Model, std::less<>>;

struct Study {
    std::string name, text, source;
    std::string file;           ///< for messages
    ParameterValues set;        ///< with which it was read, instead of the study's own values
    std::vector<StudyRun> runs; ///< each after the runs that it needs
    std::vector<StudyPicture> pictures;
    std::vector<StudyTable> tables;

    /// The run of this name, valid until runs are added or removed; null when there is none.
    const StudyRun* find_run(const std::string& run) const;
};

/// Reads a study from TOML text; docs/study-format.md describes it.
/// @param file the name to use in messages; models are looked for relative to its folder
/// @param set values that replace those of the study, in all models that have the parameters; expressions in the study
///        see these values
/// @param models that it can name
/// @throws InputErrors with the places of all mistakes, or InputError for a single one; without a place for a parameter
///         in `set` that no model has, or that every run varies
Study parse_study(std::string_view text, const std::string& file, const ParameterValues& set = {},
                  const NamedModels& models = {});
Study read_study(const std::string& path, const ParameterValues& set = {});
/// Reads a picture of runs of a study from TOML text: its keys, as they stand in a table `[pictures.NAME]`.
/// @param name of the picture @throws InputErrors, InputError as parse_study
StudyPicture parse_picture(std::string_view text, const std::string& name, const std::string& file, const Study& study);
/// True when a TOML text is a study rather than a model: it has a table `runs`. @throws InputError when it is no TOML
bool is_study_text(std::string_view text, const std::string& file);
/// Paths of the files that a study is read from: its own, those of models, tables of orbits and records.
std::vector<std::string> input_files(const Study& study);
/// Those of a run.
std::vector<std::string> input_files(const StudyRun& run);

} // namespace graze
