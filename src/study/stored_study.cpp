#include "graze/study/stored_study.hpp"

#include "graze/base/file_name.hpp"
#include "graze/model/model_file.hpp"
#include "study/run_record.hpp"
#include "study/settings_fields.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

constexpr const char* key_of_study = "study";

template <class Fields, class Picture>
void describe_picture(Fields& fields, Picture& picture) {
    describe_fields(fields, "name", picture.name, "kind", picture.kind, "title", picture.title, "runs", picture.runs);
    describe_if_given(fields, "over", picture.over);
    describe_fields(fields, "x", picture.x, "y", picture.y, "samples", picture.samplings, "directions",
                    picture.directions);
    fields.optional("x_range", picture.x_range);
    fields.optional("y_range", picture.y_range);
    fields.optional("fit", picture.fit);
    fields.list("at", picture.at,
                [](auto& one, auto& at) { describe_fields(one, "name", at.first, "value", at.second); });
    describe_fields(fields, "points", picture.points, "logarithmic_x", picture.logarithmic_x, "logarithmic_y",
                    picture.logarithmic_y, "successive", picture.successive, "group", picture.group, "format",
                    picture.format);
    if (fields.has("names", !picture.names.empty()))
        fields.list("names", picture.names,
                    [](auto& one, auto& name) { describe_fields(one, "name", name.first, "text", name.second); });
    describe_if_given(fields, "x_label", picture.x_label);
    describe_if_given(fields, "y_labels", picture.y_labels);
    describe_if_given(fields, "width", picture.style.width);
    describe_if_given(fields, "height", picture.style.height);
    describe_if_given(fields, "font_size", picture.style.font_size);
    describe_if_given(fields, "font", picture.style.font);
    describe_if_given(fields, "grey", picture.style.grey);
}

template <class Fields, class Columns>
void describe_columns(Fields& fields, std::string_view name, Columns& columns) {
    fields.list(name, columns,
                [](auto& one, auto& column) { describe_fields(one, "name", column.name, "value", column.value); });
}

template <class Fields, class Table>
void describe_table(Fields& fields, Table& table) {
    describe_fields(fields, "name", table.name, "text", table.text, "runs", table.runs);
    describe_columns(fields, "columns", table.columns);
    describe_columns(fields, "ratios", table.ratios);
    describe_fields(fields, "points", table.points, "samples", table.samplings, "directions", table.directions);
}

template <class Fields, class One>
void describe_study(Fields& fields, One& study) {
    describe_fields(fields, "name", study.name, "text", study.text, "source", study.source);
    if (fields.has("set", !study.set.empty()))
        fields.list("set", study.set, [](auto& one, auto& parameter) {
            describe_fields(one, "name", parameter.first, "value", parameter.second);
        });
    fields.list("pictures", study.pictures, [](auto& one, auto& picture) { describe_picture(one, picture); });
    if (fields.has("tables", !study.tables.empty()))
        fields.list("tables", study.tables, [](auto& one, auto& table) { describe_table(one, table); });
}

/// A run as it is stored with the study, whether it has begun or not.
struct PlannedRun : WrittenRun {
    std::vector<PointName> point_names;
};

template <class Fields, class Runs>
void describe_runs(Fields& fields, Runs& runs) {
    fields.list("runs", runs, [](auto& one, auto& run) {
        describe_written(one, run);
        if (one.has("point_names", !run.point_names.empty()))
            one.list("point_names", run.point_names,
                     [](auto& point, auto& name) { describe_fields(point, "label", name.label, "name", name.name); });
    });
}

/// @throws InputError as for runs that were begun
StudyRun planned_run(const PlannedRun& run, const Place& place) {
    require_file_name(run.asked.name, "name of a run", place);
    require_lines({&run.asked.units}, "unit of a value", place);
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
    const std::vector<std::string> texts{picture.kind,  picture.title,  picture.x,
                                         picture.group, picture.format, picture.x_label};
    require_lines({&texts, &picture.y, &picture.samplings, &picture.directions, &picture.points, &picture.y_labels},
                  "text of a picture", place);
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
    require_lines({&table.points, &table.samplings, &table.directions}, "text of a table", place);
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
    // FNV-1a with two seeds, side by side.
    std::uint64_t first = 0xcbf29ce484222325u, second = 0x84222325cbf29ce4u;
    for (const char c : text) {
        first = (first ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
        second = (second ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    }
    return fmt::format("{:016x}{:016x}", first, second);
}

void store_study(const Study& study, ResultFile& file) {
    std::vector<PlannedRun> runs;
    for (const StudyRun& run : study.runs)
        runs.push_back({written(run), run.point_names});
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

std::optional<ParameterValues> other_set(const Study& study, const ResultFile& file) {
    auto stored = stored_set(file);
    if (!stored)
        return std::nullopt;
    ParameterValues asked = study.set, sorted = *stored;
    std::ranges::sort(sorted);
    std::ranges::sort(asked);
    return sorted == asked ? std::nullopt : stored;
}

void require_same_values(const Study& study, const ResultFile& file,
                         const std::function<std::string(const ParameterValues& set)>& words,
                         const std::string& remedy) {
    const auto other = other_set(study, file);
    if (!other)
        return;
    const auto said = [&](ParameterValues set) {
        std::ranges::sort(set);
        return set.empty() ? std::string("the study's own values") : words(set);
    };
    throw InputError(Place{file.path(), 0, 0},
                     fmt::format("the results there were made with {}, and those asked for are of {}", said(*other),
                                 said(study.set)),
                     remedy);
}

namespace {

/// @param only_asked whether runs that the file has besides those that were asked for are left out
Study study_in(const ResultFile& file, bool only_asked) {
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
    if (!only_asked)
        for (const RunRecord& record : file.runs())
            runs.push_back(stored_run(record));
    for (const PlannedRun& run : all)
        if (!is_in(runs, run.asked.name))
            runs.push_back(planned_run(run, place));
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

} // namespace

Study stored_study(const ResultFile& file) {
    return study_in(file, false);
}

Study asked_study(const ResultFile& file) {
    return study_in(file, true);
}

} // namespace graze
