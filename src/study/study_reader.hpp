#pragma once

#include "graze/model/named_value.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/study.hpp"
#include "model/model_file_toml.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Reads what studies are made of; every mistake is an InputError with its place.
class StudyReader {
public:
    explicit StudyReader(std::string file) : toml_(file), file_(std::move(file)) {}

    const TomlReader& toml() const { return toml_; }
    const std::string& file() const { return file_; }

    /// A number, or an expression in the model's parameters.
    double number(const Model& model, const TomlEntry& entry) const;
    double positive(const Model& model, const TomlEntry& entry) const;
    std::size_t count(const TomlEntry& entry, std::size_t least = 0) const;
    /// Two numbers in order.
    std::pair<double, double> range(const Model& model, const TomlEntry& entry) const;
    std::vector<std::string> strings(const TomlEntry& entry) const;
    /// The place of the text within a string.
    Place inside(const TomlEntry& entry) const;
    /// One of several words. @return its index
    std::size_t choice(const TomlEntry& entry, const std::vector<std::string>& words) const;
    [[noreturn]] void fail(const TomlEntry& entry, const std::string& problem, const std::string& remedy) const;

private:
    TomlReader toml_;
    std::string file_;
};

/// What all runs of a study begin with.
struct StudyDefaults {
    std::string model; ///< name or path; empty: each run says its own
    Place model_place;
    std::optional<TomlEntry> set, values;
    ParameterValues given; ///< in the place of what the study says
};

using RunKeys = std::map<std::string, TomlEntry>;

/// @param keys receives those of the run, for checks that need other runs
StudyRun read_run(const StudyReader& reader, const TomlEntry& entry, const StudyDefaults& defaults, RunKeys& keys);
StudyPicture read_picture(const StudyReader& reader, const TomlEntry& entry);
StudyTable read_table(const StudyReader& reader, const TomlEntry& entry);
/// @throws InputError for a table that does not go with the study's runs, or whose file a picture writes
void check_tables(const Study& study);
/// Each run after the one that it starts from, otherwise in their order.
/// @throws InputError for a run that starts from one that is not there, or from itself
std::vector<StudyRun> in_order(std::vector<StudyRun> runs);
/// The values of one entry of `vary`.
Variation read_variation(const StudyReader& reader, const Model& model, const TomlEntry& entry, bool& random);

/// What only runs of kind orbit and continue say.
void read_branch(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, const RunKeys& keys);
/// Remembers which parameters a run itself sets.
void note_set(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// Keys that runs of any kind have.
std::vector<std::string> run_keys();
/// @throws InputError for a key that runs of this kind do not use, or that another one makes useless
void check_keys_of_kind(const StudyReader& reader, RunKind kind, const RunKeys& keys);

/// @throws InputError for a key that pictures of this kind (if any is given) do not use
void check_keys_of_picture(const StudyReader& reader, const std::string& kind, const std::vector<TomlEntry>& keys);
/// @throws InputError when what a run starts from does not go with it
void check_start(const StudyReader& reader, const StudyRun& run, const StudyRun& parent, const RunKeys& keys);

/// "did you mean", or all there are.
std::string study_name_remedy(const std::string& name, const std::vector<std::string>& known);

/// As what pictures of a study can be written.
std::vector<std::string> picture_formats();

} // namespace graze
