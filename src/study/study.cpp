#include "graze/study/study.hpp"

#include "base/letter_case.hpp"
#include "graze/base/file_name.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/text_file.hpp"
#include "graze/results/query_interruption.hpp"
#include "graze/study/further_runs.hpp"
#include "results/schema.hpp"
#include "study/point_limits.hpp"
#include "study/start_point.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace graze {

const StudyRun* Study::find_run(const std::string& run) const {
    const auto found = std::ranges::find(runs, run, &StudyRun::name);
    return found == runs.end() ? nullptr : &*found;
}

void StudyRun::set_kind(RunKind of_kind) {
    kind = of_kind;
    const auto choose = [this](auto wanted) {
        if (!std::holds_alternative<decltype(wanted)>(request))
            request = std::move(wanted);
    };
    if (is_branch())
        choose(BranchRequest());
    else if (kind == RunKind::record)
        choose(RecordRequest());
    else if (kind == RunKind::identify)
        choose(IdentifyRequest());
    else
        choose(MotionRequest());
}

void StudyRun::refuse_request() const {
    throw InputError(place, fmt::format("run '{}' of kind \"{}\" has no request of another kind", name, name_of(kind)),
                     "set the kind of a run by set_kind, and ask for what runs of this kind have");
}

bool StudyRun::varies(const std::string& parameter_or_state) const {
    const auto* motion = std::get_if<MotionRequest>(&request);
    return motion && std::ranges::find(motion->axes, parameter_or_state, &Variation::name) != motion->axes.end();
}

bool BranchRequest::keeps_point() const {
    return kept_conditions() > 0;
}

std::size_t BranchRequest::kept_conditions() const {
    const std::size_t fixed = settings.fixed_monitors();
    const std::size_t varying = settings.free.size() + (settings.family ? 1U : 0U); // besides the first
    return varying - std::min(fixed, varying);
}

void BranchRequest::validate(RunKind kind, const Model& model) const {
    if (!is_followed(kind))
        return settings.validate_orbit(model);
    BranchSettings known = settings;
    if (kind == RunKind::curve && keeps_point()) {
        known.kept.emplace();
        known.kept->type = PointType::fold;
        if (kept_conditions() == 2) {
            known.kept->type = PointType::grazing;
            known.kept_too = PointType::sensitivity;
        }
    }
    known.validate(model);
}

std::vector<std::string> picture_formats() {
    return {"png", "svg", "pdf", "eps", "tex"};
}

void require_run(const std::string& name, const std::vector<std::string>& names, const Place& place) {
    if (std::find(names.begin(), names.end(), name) == names.end())
        throw InputError(place, fmt::format("the study has no run '{}'", name), study_name_remedy(name, names));
}

namespace {

/// Refuses given values of parameters that change nothing.
void check_given(const Study& study) {
    for (const auto& given : study.set) {
        const std::string& name = given.first;
        std::vector<std::string> known;
        bool is_state = false, follows = false, used = false, varied = false;
        for (const StudyRun& run : study.runs) {
            for (const std::string& parameter : run.model.independent_parameters())
                known.push_back(parameter);
            is_state = is_state || run.model.find_state(name);
            const bool is_known = run.model.find_independent_parameter(name).has_value();
            follows = follows || (!is_known && run.model.find_parameter(name));
            varied = varied || (is_known && run.varies(name));
            used = used || (is_known && !run.varies(name));
        }
        if (used)
            continue;
        if (varied)
            throw InputError(fmt::format("every run varies '{}', so that a value of it has no effect", name),
                             "change in the study from where to where it goes");
        if (follows)
            throw InputError(fmt::format("parameter '{}' follows from others", name), "give values of those");
        if (is_state)
            throw InputError(fmt::format("'{}' is a state, not a parameter", name),
                             "change in the study where it starts, by from = { ... }");
        std::sort(known.begin(), known.end());
        known.erase(std::unique(known.begin(), known.end()), known.end());
        throw InputError(fmt::format("no model of the study has a parameter '{}'", name),
                         study_name_remedy(name, known));
    }
}

/// @param names of all runs, of which the study has those that could be read
void check_picture(const StudyReader& reader, const Study& study, const std::vector<std::string>& names,
                   const StudyPicture& picture, const TomlEntry& entry) {
    Mistakes mistakes;
    bool all = true;
    for (const auto* runs : {&picture.runs, &picture.over})
        for (const std::string& name : *runs) {
            mistakes.attempt([&] { require_run(name, names, picture.place); });
            all = all && study.find_run(name);
        }
    mistakes.throw_noted();
    if (all)
        check_shown_names(reader, study, picture, entry);
}

/// Reads one study. After a mistake in a run, picture or table the others are read.
class WholeStudy {
public:
    WholeStudy(const std::string& file, const ParameterValues& set, const NamedModels& models)
        : reader_(file, &models) {
        study_.file = file;
        study_.set = set;
        defaults_.given = set;
    }
    /// Lets the runs that are read go on from those of another study.
    void go_on_from(const Study& earlier) {
        study_.runs = earlier.runs;
        names_ = names_of(earlier.runs);
        goes_on_ = true;
    }

    Study read(const toml::table& root) {
        defaults_.whole = mistakes_.attempt([&] { read_head(root); });
        check_head();
        if (runs_ && mistakes_.attempt([&] { run_entries_ = entries_of(*runs_); }))
            read_runs();
        if (pictures_)
            mistakes_.attempt(
                [&] { StudyReader::each(entries_of(*pictures_), [&](const auto& e) { add_picture(e); }); });
        if (tables_)
            mistakes_.attempt([&] { StudyReader::each(entries_of(*tables_), [&](const auto& e) { add_table(e); }); });
        mistakes_.throw_noted();
        return std::move(study_);
    }

private:
    std::vector<TomlEntry> entries_of(const TomlEntry& group) const {
        return reader_.toml().entries(reader_.toml().table(group), group.path);
    }

    void read_head(const toml::table& root) {
        const TomlReader& toml = reader_.toml();
        StudyReader::each(toml.entries(root, ""), [&](const TomlEntry& entry) {
            toml.require_known(entry, "",
                               {"name", "text", "source", "model", "set", "values", "runs", "pictures", "tables"});
            if (entry.name == "name")
                study_.name = toml.string(entry), name_place_ = toml.place(*entry.node);
            else if (entry.name == "text")
                study_.text = toml.string(entry);
            else if (entry.name == "source")
                study_.source = toml.string(entry);
            else if (entry.name == "model") {
                defaults_.model = toml.string(entry);
                defaults_.model_place = toml.place(*entry.node);
            } else if (entry.name == "set")
                defaults_.set = entry;
            else if (entry.name == "values")
                defaults_.values = entry;
            else
                (entry.name == "runs" ? runs_ : entry.name == "pictures" ? pictures_ : tables_) = entry;
        });
    }

    /// Reports a missing name or missing runs, unless a key could not be read, which may be the missing one.
    void check_head() {
        if (!study_.name.empty())
            mistakes_.attempt(
                [&] { require_file_name(study_.name, "name of a study, which its folder bears", name_place_); });
        else if (defaults_.whole)
            mistakes_.attempt([&] {
                throw InputError(Place{study_.file, 1, 1}, "the study has no name",
                                 "give name = \"...\" in its first line");
            });
        if (!runs_ && defaults_.whole)
            mistakes_.attempt([&] {
                throw InputError(Place{study_.file, 1, 1}, "the study has no runs", "add a table [runs.NAME]");
            });
    }

    /// Notes the names of runs before any run is read, which may name those that follow.
    void name_runs() {
        mistakes_.attempt([&] {
            if (run_entries_.empty())
                throw InputError(runs_->place, "the study has no runs", "add a table [runs.NAME]");
        });
        require_all(names_.size() + run_entries_.size() <= most_runs, runs_->place,
                    fmt::format("the study has more than {} runs", most_runs), "make several studies");
        std::set<std::string> there(names_.begin(), names_.end());
        for (const TomlEntry& entry : run_entries_)
            mistakes_.attempt([&] {
                if (!there.insert(entry.name).second)
                    throw InputError(entry.place, fmt::format("there is a run '{}' already", entry.name),
                                     "choose another name");
                names_.push_back(entry.name);
            });
    }

    /// Ends the reading unless something holds, since going on would take long.
    void require_all(bool holds, const Place& place, const std::string& problem, const std::string& remedy) {
        if (holds)
            return;
        mistakes_.attempt([&] { throw InputError(place, problem, remedy); });
        mistakes_.throw_noted();
    }

    void read_runs() {
        name_runs();
        constexpr std::size_t most_values_of_all = 20'000'000; // of all runs, which are in memory at once
        for (const TomlEntry& entry : run_entries_) {
            require_all(!QueryInterruption::requested(), entry.place, "the reading of the study was interrupted",
                        "ask again, or make several studies of it");
            mistakes_.attempt([&] { add_run(entry); });
            require_all(values_ <= most_values_of_all, entry.place,
                        fmt::format("the study varies things through more than {} values", most_values_of_all),
                        "take larger steps, or make several studies");
        }
        const bool all = mistakes_.none();
        if (all)
            mistakes_.attempt([&] { check_given(study_); });
        check_names();
        if (all)
            mistakes_.attempt([&] { check_order(); });
        for (const StudyRun& run : study_.runs)
            mistakes_.attempt([&] {
                for (const auto& [name, place] : run.needs())
                    require_run(name, names_, place);
                check_needs(run, study_);
            });
        for (const TomlEntry& entry : run_entries_)
            with_key(mistakes_, keys_[entry.name], "start", [&](const TomlEntry& start) { check_parent(start); });
        for (const StudyRun& run : study_.runs)
            if (const StudyRun* parent =
                    run.start && keys_.contains(run.name) ? study_.find_run(run.start->run) : nullptr)
                mistakes_.attempt([&] { check_start(reader_, run, *parent, keys_[run.name]); });
    }

    /// Refuses names that the exploration of an atlas gives to the runs that it adds.
    void check_reserved_names() {
        std::set<std::string> atlases; // in small letters
        for (const StudyRun& run : study_.runs)
            if (run.kind == RunKind::atlas)
                atlases.insert(in_small_letters(run.name));
        for (const StudyRun& run : study_.runs)
            for (std::size_t dot = run.name.find('.'); dot != std::string::npos; dot = run.name.find('.', dot + 1))
                if (const std::string atlas = run.name.substr(0, dot); atlases.contains(in_small_letters(atlas)))
                    mistakes_.attempt([&] {
                        throw InputError(run.place,
                                         fmt::format("run '{}' has a name of those that the atlas '{}' adds, which "
                                                     "begin with '{}.'",
                                                     run.name, atlas, atlas),
                                         "choose another name");
                    });
    }

    /// Each name against those that could be its likes, rather than against all.
    void check_names() {
        if (!goes_on_)
            check_reserved_names();
        std::map<std::string, std::vector<std::string>> alike;
        for (const std::string& name : names_)
            alike[in_small_letters(name)].push_back(name);
        for (const StudyRun& run : study_.runs)
            mistakes_.attempt(
                [&] { require_free_name(run.name, run.is_branch(), alike[in_small_letters(run.name)], run.place); });
    }

    void add_run(const TomlEntry& entry) {
        std::optional<StudyRun> run = read_run(reader_, entry, defaults_, keys_[entry.name]);
        if (!run)
            return;
        if (run->has_motions())
            for (const Variation& axis : run->motion().axes)
                values_ += axis.values.size();
        study_.runs.push_back(std::move(*run));
    }

    /// Sorts the runs, which fails for runs that start from each other. Runs that name no run are reported elsewhere.
    void check_order() {
        const bool known = std::all_of(study_.runs.begin(), study_.runs.end(), [&](const StudyRun& run) {
            const auto needs = run.needs();
            return std::all_of(needs.begin(), needs.end(),
                               [&](const auto& need) { return study_.find_run(need.first); });
        });
        if (known)
            study_.runs = in_order(std::move(study_.runs));
    }

    /// Checks the run that `start` names, also in runs that could not be read. Other types than texts are reported
    /// there.
    void check_parent(const TomlEntry& start) const {
        if (const toml::table* keys = start.node->as_table())
            if (const auto name = (*keys)["run"].value<std::string>(); name && !name->empty() && is_plain_text(*name))
                require_run(*name, names_, start.place);
    }

    void add_picture(const TomlEntry& entry) {
        picture_names_.push_back(entry.name);
        study_.pictures.push_back(read_picture(reader_, entry));
        check_picture(reader_, study_, names_, study_.pictures.back(), entry);
    }

    void add_table(const TomlEntry& entry) {
        study_.tables.push_back(read_table(reader_, entry, study_));
        check_table(study_, study_.tables.back(), names_, picture_names_);
    }

    StudyReader reader_;
    Study study_;
    StudyDefaults defaults_;
    Mistakes mistakes_;
    Place name_place_;
    std::optional<TomlEntry> runs_, pictures_, tables_;
    std::vector<TomlEntry> run_entries_;
    std::vector<std::string> names_, picture_names_; ///< including those of entries that could not be read
    std::map<std::string, RunKeys> keys_;
    std::size_t values_ = 0; ///< number of values of all axes
    bool goes_on_ = false;   ///< from another study, as an exploration does
};

} // namespace

Study parse_study(std::string_view text, const std::string& file, const ParameterValues& set,
                  const NamedModels& models) {
    const toml::table root = parse_toml(text, file, "docs/study-format.md shows how a study is written");
    return WholeStudy(file, set, models).read(root);
}

Study parse_further_runs(std::string_view text, const std::string& file, const Study& study,
                         const NamedModels& models) {
    const toml::table root = parse_toml(text, file, "docs/study-format.md shows how a study is written");
    WholeStudy whole(file, {}, models);
    whole.go_on_from(study);
    return whole.read(root);
}

StudyPicture parse_picture(std::string_view text, const std::string& name, const std::string& file,
                           const Study& study) {
    const toml::table root = parse_toml(text, file, "docs/study-format.md lists the keys of pictures");
    const StudyReader reader(file);
    const TomlEntry entry{name, "the picture", {file, 1, 1}, &root};
    StudyPicture picture = read_picture(reader, entry);
    check_picture(reader, study, names_of(study.runs), picture, entry);
    return picture;
}

bool is_study_text(std::string_view text, const std::string& file) {
    return parse_toml(text, file,
                      "docs/study-format.md shows how a study is written, docs/model-format.md shows a model")
        .contains("runs");
}

std::vector<std::string> input_files(const StudyRun& run) {
    std::vector<std::string> files;
    if (!run.model_path.empty())
        files.push_back(run.model_path);
    if (run.is_branch() && !run.branch().table.empty())
        files.push_back(run.branch().table);
    if (run.kind == RunKind::record)
        for (const RecordInput& input : run.record().inputs)
            files.push_back(input.path);
    return files;
}

std::vector<std::string> input_files(const Study& study) {
    std::vector<std::string> files{study.file};
    for (const StudyRun& run : study.runs)
        std::ranges::move(input_files(run), std::back_inserter(files));
    return files;
}

Study read_study(const std::string& path, const ParameterValues& set) {
    return parse_study(read_text_file(path, "study", longest_model), path, set);
}

} // namespace graze
