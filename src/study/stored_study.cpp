#include "graze/study/stored_study.hpp"

#include "graze/base/file_name.hpp"
#include "graze/model/model_file.hpp"
#include "study/asked_run.hpp"
#include "study/picture_style.hpp"
#include "study/settings_fields.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

constexpr const char* key_of_study = "study";

template <class Fields, class Picture>
void describe_picture(Fields& fields, Picture& picture) {
    fields.field("name", picture.name);
    fields.field("kind", picture.kind);
    fields.field("title", picture.title);
    fields.field("runs", picture.runs);
    if (fields.has("over", !picture.over.empty()))
        fields.field("over", picture.over);
    fields.field("x", picture.x);
    fields.field("y", picture.y);
    fields.field("samples", picture.samplings);
    fields.field("directions", picture.directions);
    fields.optional("x_range", picture.x_range);
    fields.optional("y_range", picture.y_range);
    fields.optional("fit", picture.fit);
    fields.list("at", picture.at, [](auto& one, auto& at) {
        one.field("name", at.first);
        one.field("value", at.second);
    });
    fields.field("points", picture.points);
    fields.field("logarithmic_x", picture.logarithmic_x);
    fields.field("logarithmic_y", picture.logarithmic_y);
    fields.field("successive", picture.successive);
    fields.field("group", picture.group);
    fields.field("format", picture.format);
    if (fields.has("names", !picture.names.empty()))
        fields.list("names", picture.names, [](auto& one, auto& name) {
            one.field("name", name.first);
            one.field("text", name.second);
        });
    if (fields.has("x_label", !picture.x_label.empty()))
        fields.field("x_label", picture.x_label);
    if (fields.has("y_labels", !picture.y_labels.empty()))
        fields.field("y_labels", picture.y_labels);
    if (fields.has("width", picture.style.width > 0))
        fields.field("width", picture.style.width);
    if (fields.has("height", picture.style.height > 0))
        fields.field("height", picture.style.height);
    if (fields.has("font_size", picture.style.font_size > 0))
        fields.field("font_size", picture.style.font_size);
    if (fields.has("font", !picture.style.font.empty()))
        fields.field("font", picture.style.font);
    if (fields.has("grey", picture.style.grey))
        fields.field("grey", picture.style.grey);
}

template <class Fields, class Columns>
void describe_columns(Fields& fields, std::string_view name, Columns& columns) {
    fields.list(name, columns, [](auto& one, auto& column) {
        one.field("name", column.name);
        one.field("value", column.value);
    });
}

template <class Fields, class Table>
void describe_table(Fields& fields, Table& table) {
    fields.field("name", table.name);
    fields.field("text", table.text);
    fields.field("runs", table.runs);
    describe_columns(fields, "columns", table.columns);
    describe_columns(fields, "ratios", table.ratios);
    fields.field("points", table.points);
    fields.field("samples", table.samplings);
    fields.field("directions", table.directions);
}

template <class Fields, class One>
void describe_study(Fields& fields, One& study) {
    fields.field("name", study.name);
    fields.field("text", study.text);
    fields.field("source", study.source);
    if (fields.has("set", !study.set.empty()))
        fields.list("set", study.set, [](auto& one, auto& parameter) {
            one.field("name", parameter.first);
            one.field("value", parameter.second);
        });
    fields.list("pictures", study.pictures, [](auto& one, auto& picture) { describe_picture(one, picture); });
    if (fields.has("tables", !study.tables.empty()))
        fields.list("tables", study.tables, [](auto& one, auto& table) { describe_table(one, table); });
}

/// A run as it is stored with the study, whether it has begun or not.
struct PlannedRun {
    AskedRun asked;
    std::string model; ///< text of its file
    std::vector<PointName> point_names;
};

template <class Fields, class Runs>
void describe_runs(Fields& fields, Runs& runs) {
    fields.list("runs", runs, [](auto& one, auto& run) {
        one.field("name", run.asked.name);
        one.field("kind", run.asked.kind);
        one.field("model", run.model);
        one.field("settings", run.asked.settings);
        one.field("version", run.asked.version);
        one.field("units", run.asked.units);
        if (one.has("point_names", !run.point_names.empty()))
            one.list("point_names", run.point_names, [](auto& point, auto& name) {
                point.field("label", name.label);
                point.field("name", name.name);
            });
    });
}

PlannedRun planned(const StudyRun& run) {
    PlannedRun result{{run.name, std::string(name_of(run.kind)), settings_of(run), GRAZE_VERSION, {}, run.value_units},
                      write_model(run.model),
                      run.point_names};
    if (run.is_branch()) {
        result.asked.units.clear();
        for (const Monitor& monitor : run.branch().settings.monitors)
            result.asked.units.push_back(monitor.unit);
    }
    return result;
}

/// @throws InputError as for runs that were begun
StudyRun run_of(const PlannedRun& run, const Place& place) {
    require_file_name(run.asked.name, "name of a run", place);
    for (const std::string& unit : run.asked.units)
        require_plain_line(unit, "unit of a value", place);
    AskedRun asked = run.asked;
    asked.file = place.file;
    const Place of_model = stored_place(place.file, fmt::format("model of run '{}'", asked.name));
    StudyRun result = graze::run_of(asked, parse_model(run.model, of_model.file));
    for (const PointName& point : run.point_names)
        require_plain_line(point.label + point.name, "name of a point", place);
    result.point_names = run.point_names;
    return result;
}

/// Checks names, which become names of files, and texts, which are drawn. @throws InputError as for study files
void check(StudyPicture& picture, const Place& place) {
    picture.place = place;
    require_file_name(picture.name, "name of a picture", place);
    for (const std::string* text :
         {&picture.kind, &picture.title, &picture.x, &picture.group, &picture.format, &picture.x_label})
        require_plain_line(*text, "text of a picture", place);
    for (const auto* texts : {&picture.y, &picture.samplings, &picture.directions, &picture.points, &picture.y_labels})
        for (const std::string& text : *texts)
            require_plain_line(text, "text of a picture", place);
    for (const auto& [name, value] : picture.at)
        require_plain_line(name, "coordinate", place);
    for (const auto& [name, text] : picture.names)
        require_plain_line(name + text, "name in a picture", place);
    check_style(picture.style, place);
    const std::vector<std::string> formats = picture_formats();
    if (std::find(formats.begin(), formats.end(), picture.format) == formats.end())
        throw InputError(place, fmt::format("pictures cannot be '{}'", picture.format), study_name_remedy("", formats));
}

void check(StudyTable& table, const Place& place) {
    table.place = place;
    require_file_name(table.name, "name of a table", place);
    for (const auto* texts : {&table.points, &table.samplings, &table.directions})
        for (const std::string& text : *texts)
            require_plain_line(text, "text of a table", place);
    for (const auto* columns : {&table.columns, &table.ratios})
        for (const StudyTable::Column& column : *columns)
            for (const std::string* text : {&column.name, &column.value})
                require_plain_line(*text, "column of a table", place);
}

} // namespace

std::string settings_of(const StudyPicture& picture) {
    SettingsWriter fields;
    describe_picture(fields, picture);
    return fields.text();
}

std::string fingerprint_of(std::string_view text) {
    // FNV-1a with two seeds.
    std::string result;
    for (std::uint64_t value : {std::uint64_t{0xcbf29ce484222325u}, std::uint64_t{0x84222325cbf29ce4u}}) {
        for (const char c : text)
            value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
        result += fmt::format("{:016x}", value);
    }
    return result;
}

void store_study(const Study& study, ResultFile& file) {
    std::vector<PlannedRun> runs;
    for (const StudyRun& run : study.runs)
        runs.push_back(planned(run));
    SettingsWriter fields;
    describe_study(fields, study);
    describe_runs(fields, runs);
    file.set_note(key_of_study, fields.text());
}

std::optional<ParameterValues> stored_set(const ResultFile& file) {
    const Place place{file.path(), 0, 0};
    const auto note = file.note(key_of_study);
    if (!note)
        return std::nullopt;
    Study study;
    const Json json = parse_json(*note, place);
    const SettingsReader fields(json, nullptr, place);
    describe_study(fields, study);
    for (const auto& [name, value] : study.set)
        require_plain_line(name, "name of a parameter", place);
    return study.set;
}

Study stored_study(const ResultFile& file) {
    const Place place{file.path(), 0, 0};
    Study study;
    study.file = file.path();
    const Json json = parse_json(file.note(key_of_study).value_or("{}"), place);
    const SettingsReader fields(json, nullptr, place);
    describe_study(fields, study);
    for (const auto& [name, value] : study.set)
        require_plain_line(name, "name of a parameter", place);
    if (study.name.empty())
        study.name = "results";
    require_file_name(study.name, "name of a study, which its folder bears", place);
    std::vector<PlannedRun> all;
    describe_runs(fields, all);
    std::vector<StudyRun> runs;
    const auto is_in = [](const std::vector<StudyRun>& some, const std::string& name) {
        return std::any_of(some.begin(), some.end(), [&](const StudyRun& run) { return run.name == name; });
    };
    for (const RunRecord& record : file.runs())
        runs.push_back(stored_run(record));
    for (const PlannedRun& run : all)
        if (!is_in(runs, run.asked.name))
            runs.push_back(run_of(run, place));
    study.runs = in_order(std::move(runs));
    const auto is_there = [&](const std::string& name) { return is_in(study.runs, name); };
    const auto is_of_others = [&](const auto& one) {
        return one.runs.empty() || !std::all_of(one.runs.begin(), one.runs.end(), is_there);
    };
    std::erase_if(study.pictures, is_of_others);
    std::erase_if(study.pictures,
                  [&](const StudyPicture& one) { return !std::all_of(one.over.begin(), one.over.end(), is_there); });
    std::erase_if(study.tables, is_of_others);
    for (StudyPicture& picture : study.pictures)
        check(picture, place);
    for (StudyTable& table : study.tables)
        check(table, place);
    return study;
}

} // namespace graze
