#include "graze/branch/special_point.hpp"
#include "graze/symbolic/file_name.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace graze {

namespace {

std::string trimmed(const std::string& text) {
    const std::size_t start = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
    return start == std::string::npos ? "" : text.substr(start, end - start + 1);
}

/// "V", or "voltage = V". A comparison has no such sign by itself.
StudyTable::Column column_of(const StudyReader& reader, const TomlEntry& entry) {
    const std::string text = reader.toml().line(entry);
    const std::size_t sign = text.find('=');
    const bool named =
        sign != std::string::npos && sign > 0 && text.find_first_of("<>!=") == sign && text.compare(sign, 2, "==") != 0;
    StudyTable::Column column{trimmed(named ? text.substr(0, sign) : text),
                              trimmed(named ? text.substr(sign + 1) : text)};
    if (column.name.empty() || column.value.empty())
        reader.fail(entry, fmt::format("{} names nothing", entry.path), "write \"V\" or \"voltage = V\"");
    return column;
}

void read_columns(const StudyReader& reader, const TomlEntry& entry, StudyTable& table) {
    const auto items = entry.node->is_array() ? reader.toml().elements(entry) : std::vector<TomlEntry>{entry};
    for (const TomlEntry& item : items) {
        const StudyTable::Column column = column_of(reader, item);
        const std::vector<std::string> known = names_of(table.columns);
        if (std::find(known.begin(), known.end(), column.name) != known.end())
            reader.fail(item, fmt::format("there is another column '{}'", column.name),
                        fmt::format("leave it out, or give it a name of its own: \"NAME = {}\"", column.value));
        table.columns.push_back(column);
    }
}

void read_ratios(const StudyReader& reader, const TomlEntry& entry, StudyTable& table) {
    const std::vector<std::string> known = names_of(table.columns);
    const auto is_column = [&](const std::string& name) {
        return std::find(known.begin(), known.end(), name) != known.end();
    };
    for (const TomlEntry& item : reader.toml().entries(reader.toml().table(entry), entry.path)) {
        require_plain_line(item.name, "column", item.place);
        if (is_column(item.name))
            throw InputError(item.place, fmt::format("there is another column '{}'", item.name),
                             "give the ratios a name of their own");
        const std::string of = reader.toml().line(item);
        if (!is_column(of))
            reader.fail(item, fmt::format("the table has no column '{}'", of), study_name_remedy(of, known));
        table.ratios.push_back({item.name, of});
    }
}

/// Types, or types with a number.
void read_points(const StudyReader& reader, const TomlEntry& entry, StudyTable& table) {
    table.points = reader.strings(entry);
    for (const std::string& point : table.points) {
        const std::size_t digits = std::min(point.find_first_of("0123456789"), point.size());
        if (point_type(point.substr(0, digits)) && point.find_first_not_of("0123456789", digits) == std::string::npos)
            continue;
        std::vector<std::string> types;
        for (const PointKind& kind : point_kinds())
            types.emplace_back(kind.short_name);
        reader.fail(entry, fmt::format("'{}' is no label and no type of points", point),
                    fmt::format("labels are like GR1; types are {}", fmt::join(types, ", ")));
    }
}

const StudyRun& run_of(const Study& study, const StudyTable& table, const std::string& name) {
    const auto found =
        std::find_if(study.runs.begin(), study.runs.end(), [&](const StudyRun& run) { return run.name == name; });
    if (found == study.runs.end())
        throw InputError(table.place, fmt::format("the study has no run '{}'", name),
                         study_name_remedy(name, names_of(study.runs)));
    return *found;
}

/// What a table begins with, unless it has one run, or has points without labels.
void check_names(const StudyTable& table, bool branches) {
    for (const auto* columns : {&table.columns, &table.ratios})
        for (const StudyTable::Column& column : *columns)
            if ((column.name == "run" && table.runs.size() > 1) || (column.name == "label" && branches))
                throw InputError(table.place, fmt::format("the table has a column '{}' by itself", column.name),
                                 "leave it out, or give it another name");
}

void check_runs(const Study& study, const StudyTable& table) {
    std::vector<std::string> samplings;
    const bool branches = run_of(study, table, table.runs.front()).is_branch();
    for (const std::string& name : table.runs) {
        const StudyRun& run = run_of(study, table, name);
        if (run.is_branch() != branches)
            throw InputError(table.place, "branches and other runs have different columns", "make a table of each");
        for (const Sampling& sampling : run.samplings)
            samplings.push_back(sampling.name);
    }
    check_names(table, branches);
    if (!branches && !table.points.empty())
        throw InputError(table.place, fmt::format("points of run '{}' have no labels", table.runs.front()),
                         "leave `points` out");
    if (branches && !table.samplings.empty())
        throw InputError(table.place, fmt::format("orbits of run '{}' are not sampled", table.runs.front()),
                         "leave `samples` out");
    for (const std::string& name : table.samplings)
        if (std::find(samplings.begin(), samplings.end(), name) == samplings.end())
            throw InputError(table.place, fmt::format("there is no sampling '{}'", name),
                             study_name_remedy(name, samplings));
}

} // namespace

StudyTable read_table(const StudyReader& reader, const TomlEntry& entry) {
    StudyTable table;
    table.name = entry.name;
    table.place = entry.place;
    require_file_name(table.name, "name of a table", entry.place);
    std::optional<TomlEntry> ratios;
    for (const TomlEntry& item :
         reader.toml().entries(reader.toml().table(entry), entry.path,
                               {"text", "run", "runs", "columns", "ratios", "points", "samples", "directions"})) {
        const std::string& key = item.name;
        if (key == "text")
            table.text = reader.toml().string(item);
        else if (key == "run" || key == "runs")
            table.runs = reader.strings(item);
        else if (key == "columns")
            read_columns(reader, item, table);
        else if (key == "ratios")
            ratios = item;
        else if (key == "points")
            read_points(reader, item, table);
        else
            (key == "samples" ? table.samplings : table.directions) = reader.strings(item);
    }
    if (table.runs.empty())
        throw InputError(entry.place, fmt::format("{} shows no run", entry.path), "give run = \"NAME\"");
    if (table.columns.empty())
        throw InputError(entry.place, fmt::format("{} has no columns", entry.path),
                         "name parameters, values or monitors: columns = [\"NAME\"]");
    if (ratios)
        read_ratios(reader, *ratios, table);
    return table;
}

void check_tables(const Study& study) {
    for (const StudyTable& table : study.tables) {
        check_runs(study, table);
        // Pictures may have a table beside them, of their name.
        if (std::any_of(study.pictures.begin(), study.pictures.end(),
                        [&](const StudyPicture& picture) { return picture.name == table.name; }))
            throw InputError(table.place,
                             fmt::format("there is a picture '{}', whose table has the same file", table.name),
                             "give the table another name");
    }
}

} // namespace graze
