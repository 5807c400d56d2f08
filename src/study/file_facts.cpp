#include "graze/study/file_facts.hpp"

#include "graze/results/stored_run.hpp"
#include "graze/study/run_times.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/setting_list.hpp"
#include "graze/study/stored_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sys/stat.h>

namespace graze {

void Facts::add(const std::string& item, const std::string& name, const std::string& property,
                const std::string& text) {
    if (!text.empty())
        all_.push_back({item, name, property, std::nullopt, text, ""});
}

void Facts::add(const std::string& item, const std::string& name, const std::string& property, double number,
                const std::string& unit) {
    all_.push_back({item, name, property, number, fmt::format("{}", number), unit});
}

const Fact* Facts::find(const std::string& item, const std::string& name, const std::string& property) const {
    const auto found = std::find_if(all_.begin(), all_.end(), [&](const Fact& fact) {
        return fact.item == item && fact.name == name && fact.property == property;
    });
    return found == all_.end() ? nullptr : &*found;
}

std::string Facts::text(const std::string& item, const std::string& name, const std::string& property) const {
    const Fact* found = find(item, name, property);
    return found ? found->text : "";
}

std::vector<std::string> Facts::texts(const std::string& item, const std::string& name,
                                      const std::string& property) const {
    std::vector<std::string> texts;
    for (const Fact& fact : all_)
        if (fact.item == item && fact.name == name && fact.property == property)
            texts.push_back(fact.text);
    return texts;
}

std::optional<double> Facts::number(const std::string& item, const std::string& name,
                                    const std::string& property) const {
    const Fact* found = find(item, name, property);
    return found ? found->number : std::nullopt;
}

std::vector<std::string> Facts::names(const std::string& item) const {
    std::vector<std::string> names;
    for (const Fact& fact : all_)
        if (fact.item == item && (names.empty() || names.back() != fact.name))
            names.push_back(fact.name);
    return names;
}

namespace {

void add_parameters(Facts& facts, const std::string& run, const Model& model) {
    const std::vector<double> values = model.parameter_values();
    const std::vector<std::string> names = model.independent_parameters();
    for (std::size_t p = 0; p < names.size(); ++p)
        facts.add("parameter", run, names[p], values[p], model.parameter_unit(names[p]));
}

void add_settings(Facts& facts, const std::string& run, const std::string& settings, const std::string& file) {
    for (const Setting& setting : setting_list(settings, stored_place(file, fmt::format("settings of run '{}'", run))))
        if (setting.number)
            facts.add("setting", run, setting.name, *setting.number);
        else
            facts.add("setting", run, setting.name, setting.text);
}

/// In a few words, such as "V from 1 to 2 (101 values)".
void add_axes(Facts& facts, const StudyRun& run) {
    if (run.has_motions())
        for (const Variation& axis : run.motion().axes) {
            const auto& values = axis.values;
            const std::string range =
                values.empty()
                    ? fmt::format("at random from {:.6g} to {:.6g} ({} draws)", axis.low + axis.offset,
                                  axis.high + axis.offset, run.motion().draws)
                    : fmt::format("from {:.6g} to {:.6g} ({} values)", values.front(), values.back(), values.size());
            facts.add("run", run.name, "varies", axis.name + " " + range);
        }
    if (run.is_followed()) {
        const BranchSettings& branch = run.branch().settings;
        const std::vector<std::string> names = run.model.independent_parameters();
        const auto bound = [](const std::optional<double>& value) {
            return value ? fmt::format("{:.6g}", *value) : std::string("anywhere");
        };
        std::string along = fmt::format("{} from {} to {}, followed",
                                        run.kind == RunKind::curve ? names[branch.parameter.place()]
                                                                   : coordinate_name(branch, run.model),
                                        bound(branch.least), bound(branch.greatest));
        if (run.kind == RunKind::curve && !branch.free_bounds.empty()) {
            const FreeBounds& other = branch.free_bounds.front();
            along += fmt::format(" with {} from {} to {}", names[other.parameter.place()], bound(other.least),
                                 bound(other.greatest));
        }
        facts.add("run", run.name, "varies", along);
    }
    if (run.start)
        facts.add("run", run.name, "starts_from", run.start->run);
}

void add_pictures(Facts& facts, const Study& study) {
    for (const StudyPicture& picture : study.pictures) {
        facts.add("picture", picture.name, "kind", picture.kind);
        facts.add("picture", picture.name, "title", picture.title);
        for (const std::string& run : picture.runs)
            facts.add("picture", picture.name, "run", run);
    }
}

void add_words(Facts& facts, const std::string& item, const std::string& name, const std::string& text,
               const std::string& source) {
    facts.add(item, name, "name", name);
    facts.add(item, name, "text", text);
    facts.add(item, name, "source", source);
}

/// @param asked the run as it was asked for; may be null
void add_stored_run(Facts& facts, const ResultFile& file, const RunRecord& record, const StudyRun* asked) {
    const std::string& run = record.name;
    facts.add("run", run, "kind", record.kind);
    facts.add("run", run, "status", std::string(name_of(record.status)));
    facts.add("run", run, "failure", record.failure);
    if (!record.is_branch())
        facts.add("run", run, "planned", static_cast<double>(record.points));
    facts.add("run", run, "points", static_cast<double>(file.point_count(run)));
    const StoredRun stored(file, run, {});
    for (const auto& [label, count] : stored.label_counts())
        if (!record.is_branch())
            facts.add("run", run, "points_" + label, static_cast<double>(count));
    facts.add("run", run, record.is_branch() ? "segments" : "samples", static_cast<double>(stored.samples()));
    facts.add("run", run, "model", record.model_name);
    facts.add("run", run, "version", record.version);
    if (const auto times = times_of(file, run)) {
        facts.add("run", run, "begun", times->begun);
        facts.add("run", run, "ended", times->ended);
        facts.add("run", run, "seconds", times->seconds, "s");
    }
    facts.add("run", run, "fingerprint", record.fingerprint);
    if (asked)
        add_axes(facts, *asked);
}

} // namespace

void add_file_facts(Facts& facts, const std::string& path, const std::string& kind) {
    facts.add("file", "", "kind", kind);
    struct stat status {};
    if (path.empty() || ::stat(path.c_str(), &status) != 0) {
        facts.add("file", "", "version", GRAZE_VERSION);
        return;
    }
    facts.add("file", "", "path", path);
    facts.add("file", "", "size", static_cast<double>(status.st_size), "bytes");
    facts.add("file", "", "written", text_of(status.st_mtime));
}

void add_facts(Facts& facts, const Model& model) {
    add_words(facts, "model", model.name, model.text, model.source);
    facts.add("model", model.name, "time_unit", model.time_unit);
    const auto count = [&](const char* what, std::size_t number) {
        facts.add("model", model.name, what, static_cast<double>(number));
    };
    count("states", model.states.size());
    count("parameters", model.parameters.size());
    count("definitions", model.definitions.size());
    count("modes", model.modes.size());
    count("events", model.events.size());
    count("transitions", model.transitions.size());
    count("sections", model.sections.size());
    count("symmetries", model.symmetries.size());
    count("quantities", model.quantities.size());
}

void add_facts(Facts& facts, const Study& study) {
    add_words(facts, "study", study.name, study.text, study.source);
    for (const StudyRun& run : study.runs) {
        facts.add("run", run.name, "kind", std::string(name_of(run.kind)));
        if (!run.is_branch())
            facts.add("run", run.name, "planned", static_cast<double>(points_of(run)));
        facts.add("run", run.name, "model", run.model.name);
        add_axes(facts, run);
    }
    for (const StudyRun& run : study.runs) {
        add_parameters(facts, run.name, run.model);
        add_settings(facts, run.name, settings_of(run), "");
    }
    add_pictures(facts, study);
}

void add_facts(Facts& facts, const ResultFile& file) {
    facts.add("file", "", "format", static_cast<double>(file.format()));
    for (const std::string& missing : file.missing())
        facts.add("file", "", "missing", missing);
    std::optional<Study> study;
    try {
        study = stored_study(file);
        add_words(facts, "study", study->name, study->text, study->source);
        for (const auto& [name, value] : study->set)
            facts.add("study", study->name, "set." + name, value);
    } catch (const InputError& error) { // settings of another version, say: the rest can be told
        facts.add("file", "", "problem", error.what());
    }
    const std::vector<RunRecord> records = file.runs();
    for (const RunRecord& record : records)
        add_stored_run(facts, file, record, study ? study->find_run(record.name) : nullptr);
    for (const StudyRun& run : study ? study->runs : std::vector<StudyRun>())
        if (!file.find_run(run.name)) {
            facts.add("run", run.name, "kind", std::string(name_of(run.kind)));
            facts.add("run", run.name, "status", "not begun");
            facts.add("run", run.name, "model", run.model.name);
            add_axes(facts, run);
        }
    for (const RunRecord& record : records) {
        add_parameters(facts, record.name, stored_model(record));
        add_settings(facts, record.name, record.settings, record.file);
    }
    if (study)
        add_pictures(facts, *study);
}

} // namespace graze
