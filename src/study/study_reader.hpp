#pragma once

#include "graze/base/input_errors.hpp"
#include "graze/model/named_value.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/study_keys.hpp"
#include "model/catalogue_data.hpp"
#include "model/model_file_toml.hpp"
#include "study/run_key.hpp"

#include <exception>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Reads the parts of a study file. A mistake throws InputError with its place, several mistakes throw InputErrors.
class StudyReader {
public:
    /// @param models that the study can name, kept by the caller; null: none besides shipped ones and files
    explicit StudyReader(std::string file, const NamedModels* models = nullptr)
        : toml_(file), file_(std::move(file)), models_(models) {}

    const TomlReader& toml() const { return toml_; }
    const std::string& file() const { return file_; }
    /// The model that the study was given under this name; null if there is none.
    const Model* given_model(const std::string& name) const;
    /// A model of the catalogue or of a file, which is read once however many runs have it.
    /// @throws InputErrors, InputError as load_model, each time
    const Model& loaded_model(const std::string& name_or_path) const;

    /// A number, or an expression in the model's parameters.
    double number(const Model& model, const TomlEntry& entry) const;
    double number(const Model& model, const TomlEntry& entry, const NumberRange& range) const;
    double positive(const Model& model, const TomlEntry& entry) const;
    /// The text of a number or expression, to be evaluated when the parameters in it are known.
    std::string number_text(const Model& model, const TomlEntry& entry) const;
    std::size_t count(const TomlEntry& entry, std::size_t least = 0, std::size_t most = 1'000'000'000) const;
    /// Two numbers in ascending order.
    std::pair<double, double> range(const Model& model, const TomlEntry& entry) const;
    std::vector<std::string> strings(const TomlEntry& entry) const;
    /// The place of the first letter of a string, behind its quotation mark.
    Place inside(const TomlEntry& entry) const;
    /// Index of one of several words.
    std::size_t choice(const TomlEntry& entry, const std::vector<std::string>& words) const;
    [[noreturn]] void fail(const TomlEntry& entry, const std::string& problem, const std::string& remedy) const;

    /// Calls `work` with each entry, and reports the mistakes of all entries together.
    template <class Work>
    static void each(const std::vector<TomlEntry>& entries, const Work& work) {
        Mistakes mistakes;
        for (const TomlEntry& entry : entries)
            mistakes.attempt([&] { work(entry); });
        mistakes.throw_noted();
    }
    /// The same for the entries of a table. @param known the only keys that it may have; none: any key
    template <class Work>
    void each_of(const TomlEntry& table, const std::vector<std::string>& known, const Work& work) const {
        each(toml_.entries(toml_.table(table), table.path), [&](const TomlEntry& entry) {
            if (!known.empty())
                toml_.require_known(entry, table.path, known);
            work(entry);
        });
    }
    using ReadEntry = std::function<void(const TomlEntry&)>;
    /// Reads a table in which only these keys may stand, each by its function. All mistakes are reported together.
    void read_keys(const TomlEntry& table, const std::vector<std::pair<std::string, ReadEntry>>& keys) const;
    /// What reads an entry into a variable that outlives it: a line, lines, true or false, or numbers.
    ReadEntry into(std::string& text) const {
        return [this, &text](const TomlEntry& e) { text = toml_.line(e); };
    }
    ReadEntry into(std::vector<std::string>& lines) const {
        return [this, &lines](const TomlEntry& e) { lines = strings(e); };
    }
    ReadEntry into(bool& truth) const {
        return [this, &truth](const TomlEntry& e) { truth = toml_.boolean(e); };
    }
    /// @param model may name parameters in it
    ReadEntry into(double& value, const Model& model = no_model(), const NumberRange& range = any_number) const {
        return [this, &value, &model, range](const TomlEntry& e) { value = number(model, e, range); };
    }
    ReadEntry into(std::optional<double>& value, const Model& model = no_model(),
                   const NumberRange& range = any_number) const {
        return [this, &value, &model, range](const TomlEntry& e) { value = number(model, e, range); };
    }
    ReadEntry into(std::size_t& value, const CountRange& range) const {
        return [this, &value, range](const TomlEntry& e) { value = count(e, range.least, range.most); };
    }
    ReadEntry into(std::optional<std::pair<double, double>>& ends) const {
        return [this, &ends](const TomlEntry& e) { ends = range(no_model(), e); };
    }
    /// A model without names, for numbers that depend on nothing.
    static const Model& no_model();

    /// The items of a list; an entry that is no list counts as a list of one.
    std::vector<TomlEntry> items(const TomlEntry& entry) const;

private:
    TomlReader toml_;
    std::string file_;
    const NamedModels* models_;
    struct Loaded {
        Model model;
        std::exception_ptr failure; ///< null: there is none
    };
    mutable std::map<std::string, Loaded> loaded_; ///< one thread reads a study
};

/// Settings of a study that hold for all of its runs.
struct StudyDefaults {
    std::string model; ///< name or path; empty: each run says its own
    Place model_place;
    std::optional<TomlEntry> set, values;
    ParameterValues given; ///< they replace the values of the study
    bool whole = true;     ///< false: some of these settings could not be read
};

using RunKeys = std::map<std::string, TomlEntry>;

/// Calls `work` with a key of a run if the run has it. @return false after a mistake, which is noted
template <class Work>
bool with_key(Mistakes& mistakes, const RunKeys& keys, const char* key, const Work& work) {
    const auto found = keys.find(key);
    return found == keys.end() || mistakes.attempt([&] { work(found->second); });
}

/// Reads a run. @param keys receives the keys of the run, for checks that need other runs
/// @return nothing where a mistake elsewhere makes it impossible to read the run
std::optional<StudyRun> read_run(const StudyReader& reader, const TomlEntry& entry, const StudyDefaults& defaults,
                                 RunKeys& keys);
StudyPicture read_picture(const StudyReader& reader, const TomlEntry& entry);
/// @param study with the runs that it shows
StudyTable read_table(const StudyReader& reader, const TomlEntry& entry, const Study& study);
/// @throws InputError for `names` that name nothing of what the picture, the table `entry`, shows
void check_shown_names(const StudyReader& reader, const Study& study, const StudyPicture& picture,
                       const TomlEntry& entry);
/// @param names of all runs, of which the study has those that could be read
/// @throws InputError for a table that does not go with the study's runs, or whose file a picture writes
void check_table(const Study& study, const StudyTable& table, const std::vector<std::string>& names,
                 const std::vector<std::string>& pictures);
/// @param names of all runs @throws InputError unless it is one of them
void require_run(const std::string& name, const std::vector<std::string>& names, const Place& place);
/// Sorts runs so that each follows those that it needs; otherwise their order stays.
/// @throws InputError for a run that starts from one that is not there, or from itself
std::vector<StudyRun> in_order(std::vector<StudyRun> runs);
/// Reads one entry of `vary`.
Variation read_variation(const StudyReader& reader, const Model& model, const TomlEntry& entry);

/// Reads the records of a run: files, or a virtual bench with the run's model.
void read_inputs(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, const RunKeys& keys);
/// Reads channels and samplings of records. The run's model becomes that of the record.
void read_record(const StudyReader& reader, StudyRun& run, const RunKeys& keys);
/// Sets what the study leaves open, once values have been read.
void complete_record(const StudyReader& reader, StudyRun& run, const RunKeys& keys);
/// Reads which estimate a run of kind identify makes.
void read_estimate(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, const RunKeys& keys);
/// Completes a run of kind identify, once its keys have been read. @throws InputError where it lacks one
void complete_identify(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// @throws InputError when the runs that another one needs do not give what it needs
void check_needs(const StudyRun& run, const Study& study);

/// The monitors of branches whose study names none: the period, and the greatest value of each state. Of tori those
/// that are extremes.
std::vector<Monitor> usual_monitors(const Model& model, RunKind kind);
/// The keys of what monitors measure, in the order of Monitor::Kind.
const std::vector<std::string>& monitor_kinds();
/// Settings that follow from others, once the keys of a run of orbits have been read.
void complete_branch(StudyRun& run, const RunKeys& keys);
/// @throws InputError when they do not go together
void check_branch(const StudyReader& reader, const StudyRun& run, const TomlEntry& entry, const RunKeys& keys);
/// How many parameters the box of an atlas has at most.
inline constexpr std::size_t most_axes_of_atlas = 2;
/// Why an axis is none of an atlas, as the end of a sentence that begins with its name; empty: it is one.
std::string why_no_axis_of_atlas(const Variation& axis);
/// @throws InputErrors when the keys of an atlas that was read do not go together
void check_atlas(const StudyReader& reader, const StudyRun& run, const RunKeys& keys);
/// Adds the parameters of a table `set` to StudyRun::set.
void note_set(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// Sets defaults of runs in study files that depend on the kind and the model.
void set_standards(StudyRun& run);
/// Names of the keys of runs of all kinds.
const std::vector<std::string>& names_of_keys();
/// @throws InputError for a key that runs of this kind do not use, or that another one makes useless
void check_keys_of_kind(const StudyReader& reader, RunKind kind, const RunKeys& keys);

/// @throws InputError for a key that pictures of this kind (if any is given) do not use
void check_keys_of_picture(const StudyReader& reader, const std::string& kind, const std::vector<TomlEntry>& keys);
/// @throws InputError when what a run starts from does not go with it
void check_start(const StudyReader& reader, const StudyRun& run, const StudyRun& parent, const RunKeys& keys);

/// The remedy for an unknown name: the nearest known name, or all known names.
std::string study_name_remedy(const std::string& name, const std::vector<std::string>& known);

/// The text of a file that is part of the program. @param kind "study", "design"
/// @throws InputError when there is none of this name
std::string embedded_text(std::span<const EmbeddedModel> files, const std::string& kind, const std::string& name);

/// Checks texts that become names, titles and units.
void require_lines(const std::vector<const std::vector<std::string>*>& lists, const std::string& what,
                   const Place& place);
/// The short names of the types of points: of all, or of those of which this holds.
std::vector<std::string> short_names_of_points(bool PointKind::*which = nullptr);
/// The formats of files of pictures.
std::vector<std::string> picture_formats();

} // namespace graze
