#include "graze/study/study.hpp"

#include "graze/symbolic/file_name.hpp"
#include "graze/symbolic/text_file.hpp"
#include "results/run_names.hpp"
#include "study/picture_style.hpp"
#include "study/start_point.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

const StudyRun* Study::find_run(const std::string& run) const {
    const auto found = std::find_if(runs.begin(), runs.end(), [&](const StudyRun& one) { return one.name == run; });
    return found == runs.end() ? nullptr : &*found;
}

std::string_view name_of(RunKind kind) {
    switch (kind) {
    case RunKind::simulate:
        return "simulate";
    case RunKind::sweep:
        return "sweep";
    case RunKind::basin:
        return "basin";
    case RunKind::orbit:
        return "orbit";
    case RunKind::follow:
        return "continue";
    case RunKind::curve:
        return "curve";
    }
    return "simulate";
}

std::vector<std::string> picture_kinds() {
    return {"bifurcation", "branch", "basin", "map", "history", "portrait", "spectrum", "regression", "scatter"};
}

bool BranchRequest::keeps_point() const {
    const auto& monitors = settings.monitors;
    return std::count_if(monitors.begin(), monitors.end(), [](const Monitor& one) { return one.fixed; }) <
           static_cast<std::ptrdiff_t>(settings.free.size());
}

void BranchRequest::validate(RunKind kind, const Model& model) const {
    BranchSettings known = settings;
    if (kind == RunKind::curve && keeps_point()) {
        known.kept.emplace();
        known.kept->type = PointType::fold;
    }
    known.validate(model);
}

std::vector<std::string> picture_formats() {
    return {"png", "svg", "pdf", "tex"};
}

std::vector<StudyRun> in_order(std::vector<StudyRun> runs) {
    const std::vector<std::string> names = names_of(runs);
    for (const StudyRun& run : runs)
        if (run.start && std::find(names.begin(), names.end(), run.start->run) == names.end())
            throw InputError(run.start->place, fmt::format("the study has no run '{}'", run.start->run),
                             study_name_remedy(run.start->run, names));
    std::vector<StudyRun> ordered;
    const auto is_done = [&](const std::string& name) {
        return std::any_of(ordered.begin(), ordered.end(), [&](const StudyRun& run) { return run.name == name; });
    };
    while (!runs.empty()) {
        const auto next = std::find_if(runs.begin(), runs.end(),
                                       [&](const StudyRun& run) { return !run.start || is_done(run.start->run); });
        if (next == runs.end())
            throw InputError(runs.front().start->place,
                             fmt::format("run '{}' starts from itself, by way of others", runs.front().name),
                             "let one of them start by itself");
        ordered.push_back(std::move(*next));
        runs.erase(next);
    }
    return ordered;
}

namespace {

void check_pictures(const Study& study) {
    const std::vector<std::string> names = names_of(study.runs);
    for (const StudyPicture& picture : study.pictures)
        for (const std::string& run : picture.runs)
            if (std::find(names.begin(), names.end(), run) == names.end())
                throw InputError(picture.place, fmt::format("the study has no run '{}'", run),
                                 study_name_remedy(run, names));
}

/// One point, or a list of points, each given by one coordinate.
void read_points(const StudyReader& reader, const TomlEntry& entry, StudyPicture& picture) {
    const Model none;
    const auto points = entry.node->is_array() ? reader.toml().elements(entry) : std::vector<TomlEntry>{entry};
    for (const TomlEntry& point : points)
        for (const TomlEntry& at : reader.toml().entries(reader.toml().table(point), point.path)) {
            require_plain_line(at.name, "coordinate", at.place);
            picture.at.emplace_back(at.name, reader.number(none, at));
        }
}

void read_logarithmic(const StudyReader& reader, const TomlEntry& entry, StudyPicture& picture) {
    for (const std::string& axis : reader.strings(entry)) {
        picture.logarithmic_x = picture.logarithmic_x || axis == "x";
        picture.logarithmic_y = picture.logarithmic_y || axis == "y";
        if (axis != "x" && axis != "y")
            reader.fail(entry, fmt::format("there is no axis '{}'", axis), "name x, y or both");
    }
}

/// Values that change nothing are mistakes.
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
            const bool varies =
                std::any_of(run.axes.begin(), run.axes.end(), [&](const Variation& axis) { return axis.name == name; });
            varied = varied || (is_known && varies);
            used = used || (is_known && !varies);
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

} // namespace

StudyPicture read_picture(const StudyReader& reader, const TomlEntry& entry) {
    const Model none;
    StudyPicture picture;
    picture.name = entry.name;
    picture.place = entry.place;
    require_file_name(picture.name, "name of a picture", entry.place);
    const std::vector<TomlEntry> items = reader.toml().entries(
        reader.toml().table(entry), entry.path,
        {"kind",    "title",   "run",     "runs",    "x",      "y",           "samples", "directions",
         "x_range", "y_range", "fit",     "at",      "points", "logarithmic", "format",  "successive",
         "group",   "names",   "x_label", "y_label", "size",   "font"});
    for (const TomlEntry& item : items) {
        const std::string& key = item.name;
        if (read_style(reader, item, picture))
            continue;
        if (key == "kind") {
            const std::vector<std::string> kinds = picture_kinds();
            picture.kind = kinds[reader.choice(item, kinds)];
        } else if (key == "title") {
            picture.title = reader.toml().line(item);
        } else if (key == "run" || key == "runs") {
            picture.runs = reader.strings(item);
        } else if (key == "x") {
            picture.x = reader.toml().line(item);
        } else if (key == "y") {
            picture.y = reader.strings(item);
        } else if (key == "samples") {
            picture.samplings = reader.strings(item);
        } else if (key == "directions") {
            picture.directions = reader.strings(item);
        } else if (key == "x_range") {
            picture.x_range = reader.range(none, item);
        } else if (key == "y_range") {
            picture.y_range = reader.range(none, item);
        } else if (key == "fit") {
            picture.fit = reader.range(none, item);
        } else if (key == "at") {
            read_points(reader, item, picture);
        } else if (key == "points") {
            picture.points = reader.strings(item);
        } else if (key == "logarithmic") {
            read_logarithmic(reader, item, picture);
        } else if (key == "successive") {
            picture.successive = reader.toml().boolean(item);
        } else if (key == "group") {
            picture.group = reader.toml().line(item);
        } else {
            const std::vector<std::string> formats = picture_formats();
            picture.format = formats[reader.choice(item, formats)];
        }
    }
    check_keys_of_picture(reader, picture.kind, items);
    if (picture.runs.empty())
        throw InputError(entry.place, fmt::format("{} shows no run", entry.path), "give run = \"NAME\"");
    return picture;
}

Study parse_study(std::string_view text, const std::string& file, const ParameterValues& set) {
    const toml::table root = parse_toml(text, file);
    const StudyReader reader(file);
    const TomlReader& toml = reader.toml();
    Study study;
    study.file = file;
    study.set = set;
    StudyDefaults defaults;
    defaults.given = set;
    Place name_place;
    std::optional<TomlEntry> runs, pictures, tables;
    for (const TomlEntry& entry :
         toml.entries(root, "", {"name", "text", "source", "model", "set", "values", "runs", "pictures", "tables"})) {
        if (entry.name == "name")
            study.name = toml.string(entry), name_place = toml.place(*entry.node);
        else if (entry.name == "text")
            study.text = toml.string(entry);
        else if (entry.name == "source")
            study.source = toml.string(entry);
        else if (entry.name == "model") {
            defaults.model = toml.string(entry);
            defaults.model_place = toml.place(*entry.node);
        } else if (entry.name == "set")
            defaults.set = entry;
        else if (entry.name == "values")
            defaults.values = entry;
        else
            (entry.name == "runs" ? runs : entry.name == "pictures" ? pictures : tables) = entry;
    }
    if (study.name.empty())
        throw InputError(Place{file, 1, 1}, "the study has no name", "give name = \"...\" in its first line");
    require_file_name(study.name, "name of a study, which its folder bears", name_place);
    if (!runs)
        throw InputError(Place{file, 1, 1}, "the study has no runs", "add a table [runs.NAME]");
    std::map<std::string, RunKeys> keys;
    std::size_t values = 0;
    for (const TomlEntry& entry : toml.entries(toml.table(*runs), "runs")) {
        study.runs.push_back(read_run(reader, entry, defaults, keys[entry.name]));
        for (const Variation& axis : study.runs.back().axes)
            values += axis.values.size();
        constexpr std::size_t most = 20'000'000; // of all runs, which are in memory at once
        if (values > most)
            throw InputError(entry.place, fmt::format("the study varies things through more than {} values", most),
                             "take larger steps, or make several studies");
    }
    if (study.runs.empty())
        throw InputError(runs->place, "the study has no runs", "add a table [runs.NAME]");
    check_given(study);
    for (const StudyRun& run : study.runs)
        require_free_name(run.name, run.is_branch(), names_of(study.runs), run.place);
    study.runs = in_order(std::move(study.runs));
    for (const StudyRun& run : study.runs)
        if (run.start)
            check_start(reader, run, run_named(study, run.start->run), keys[run.name]);
    if (pictures)
        for (const TomlEntry& entry : toml.entries(toml.table(*pictures), "pictures"))
            study.pictures.push_back(read_picture(reader, entry));
    check_pictures(study);
    if (tables)
        for (const TomlEntry& entry : toml.entries(toml.table(*tables), "tables"))
            study.tables.push_back(read_table(reader, entry));
    check_tables(study);
    return study;
}

bool is_study_text(std::string_view text, const std::string& file) {
    return parse_toml(text, file).contains("runs");
}

std::vector<std::string> input_files(const Study& study) {
    std::vector<std::string> files{study.file};
    for (const StudyRun& run : study.runs)
        for (const std::string& file : {run.model_path, run.branch.table})
            if (!file.empty())
                files.push_back(file);
    return files;
}

Study read_study(const std::string& path, const ParameterValues& set) {
    return parse_study(read_text_file(path, "study", longest_model), path, set);
}

} // namespace graze
