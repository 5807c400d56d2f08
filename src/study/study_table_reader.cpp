#include "graze/base/file_name.hpp"
#include "graze/base/trimmed.hpp"
#include "graze/branch/special_point.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace graze {

namespace {

/// "V", or "voltage = V". A comparison has no such sign by itself.
StudyTable::Column written_column(const StudyReader& reader, const TomlEntry& entry) {
    const std::string text = reader.toml().line(entry);
    const std::size_t sign = text.find('=');
    const bool named =
        sign != std::string::npos && sign > 0 && text.find_first_of("<>!=") == sign && text.compare(sign, 2, "==") != 0;
    const std::string_view whole = text;
    StudyTable::Column column{std::string(trimmed(named ? whole.substr(0, sign) : whole)),
                              std::string(trimmed(named ? whole.substr(sign + 1) : whole))};
    if (column.name.empty() || column.value.empty())
        reader.fail(entry, fmt::format("{} names nothing", entry.path), "write \"V\" or \"voltage = V\"");
    return column;
}

void read_columns(const StudyReader& reader, const TomlEntry& entry, StudyTable& table) {
    reader.each(reader.items(entry), [&](const TomlEntry& item) {
        const StudyTable::Column column = written_column(reader, item);
        const std::vector<std::string> known = names_of(table.columns);
        if (std::find(known.begin(), known.end(), column.name) != known.end())
            reader.fail(item, fmt::format("there is another column '{}'", column.name),
                        fmt::format("leave it out, or give it a name of its own: \"NAME = {}\"", column.value));
        table.columns.push_back(column);
    });
}

void read_ratios(const StudyReader& reader, const TomlEntry& entry, StudyTable& table) {
    const std::vector<std::string> known = names_of(table.columns);
    const auto is_column = [&](const std::string& name) {
        return std::find(known.begin(), known.end(), name) != known.end();
    };
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        require_plain_line(item.name, "column", item.place);
        if (is_column(item.name))
            throw InputError(item.place, fmt::format("there is another column '{}'", item.name),
                             "give the ratios a name of their own");
        const std::string of = reader.toml().line(item);
        if (!is_column(of))
            reader.fail(item, fmt::format("the table has no column '{}'", of), study_name_remedy(of, known));
        table.ratios.push_back({item.name, of});
    });
}

/// Types, types with a number, or names that the table's runs have.
void read_point_rows(const StudyReader& reader, const TomlEntry& entry, const Study& study, StudyTable& table) {
    const auto is_name = [&](const std::string& text) {
        return std::any_of(table.runs.begin(), table.runs.end(), [&](const std::string& name) {
            const StudyRun* run = study.find_run(name);
            return run && std::ranges::find(run->point_names, text, &PointName::name) != run->point_names.end();
        });
    };
    table.points = reader.strings(entry);
    for (const std::string& point : table.points) {
        if (point_type(point) || is_point_label(point) || is_name(point))
            continue;
        reader.fail(entry, fmt::format("'{}' is no label, no name and no type of points", point),
                    fmt::format("labels are like GR1; types are {}", fmt::join(short_names_of_points(), ", ")));
    }
}

/// What a table begins with, unless it has one run, or has points without labels.
void check_names(const StudyTable& table, const std::vector<const StudyRun*>& runs) {
    const bool branches = runs.front()->is_branch();
    const bool named =
        std::any_of(runs.begin(), runs.end(), [](const StudyRun* run) { return !run->point_names.empty(); });
    for (const auto* columns : {&table.columns, &table.ratios})
        for (const StudyTable::Column& column : *columns)
            if ((column.name == "run" && table.runs.size() > 1) || (column.name == "label" && branches) ||
                (column.name == "name" && named))
                throw InputError(table.place, fmt::format("the table has a column '{}' by itself", column.name),
                                 "leave it out, or give it another name");
}

/// @return false where a run could not be read
bool find_runs(const Study& study, const StudyTable& table, const std::vector<std::string>& names,
               std::vector<const StudyRun*>& runs) {
    Mistakes mistakes;
    for (const std::string& name : table.runs) {
        mistakes.attempt([&] { require_run(name, names, table.place); });
        if (const StudyRun* run = study.find_run(name))
            runs.push_back(run);
    }
    mistakes.throw_noted();
    return runs.size() == table.runs.size();
}

void check_table_samplings(const StudyTable& table, const std::vector<const StudyRun*>& runs) {
    std::vector<std::string> known;
    for (const StudyRun* run : runs)
        for (const std::string& name : run->sampling_names())
            known.push_back(name);
    Mistakes mistakes;
    for (const std::string& name : table.samplings)
        mistakes.attempt([&] {
            if (std::find(known.begin(), known.end(), name) == known.end())
                throw InputError(table.place, fmt::format("there is no sampling '{}'", name),
                                 study_name_remedy(name, known));
        });
    mistakes.throw_noted();
}

void check_runs(const StudyTable& table, const std::vector<const StudyRun*>& runs) {
    const bool branches = runs.front()->is_branch();
    for (const StudyRun* run : runs)
        if (run->is_branch() != branches)
            throw InputError(table.place, "branches and other runs have different columns", "make a table of each");
    check_names(table, runs);
    if (!branches && !table.points.empty())
        throw InputError(table.place, fmt::format("points of run '{}' have no labels", table.runs.front()),
                         "leave `points` out");
    if (branches && !table.samplings.empty())
        throw InputError(table.place, fmt::format("orbits of run '{}' are not sampled", table.runs.front()),
                         "leave `samples` out");
    check_table_samplings(table, runs);
}

} // namespace

StudyTable read_table(const StudyReader& reader, const TomlEntry& entry, const Study& study) {
    StudyTable table;
    table.name = entry.name;
    table.place = entry.place;
    std::optional<TomlEntry> ratios, points;
    Mistakes mistakes;
    mistakes.attempt([&] { require_file_name(table.name, "name of a table", entry.place); });
    const auto later = [](std::optional<TomlEntry>& kept) { return [&kept](const TomlEntry& item) { kept = item; }; };
    mistakes.attempt([&] {
        reader.read_keys(entry, {{"text", [&](const TomlEntry& item) { table.text = reader.toml().string(item); }},
                                 {"run", reader.into(table.runs)},
                                 {"runs", reader.into(table.runs)},
                                 {"columns", [&](const TomlEntry& item) { read_columns(reader, item, table); }},
                                 {"ratios", later(ratios)},
                                 {"points", later(points)},
                                 {"samples", reader.into(table.samplings)},
                                 {"directions", reader.into(table.directions)}});
    });
    mistakes.throw_noted();
    if (table.runs.empty())
        throw InputError(entry.place, fmt::format("{} shows no run", entry.path), "give run = \"NAME\"");
    if (table.columns.empty())
        throw InputError(entry.place, fmt::format("{} has no columns", entry.path),
                         "name parameters, values or monitors: columns = [\"NAME\"]");
    mistakes.attempt([&] {
        if (points)
            read_point_rows(reader, *points, study, table);
    });
    mistakes.attempt([&] {
        if (ratios)
            read_ratios(reader, *ratios, table);
    });
    mistakes.throw_noted();
    return table;
}

void check_table(const Study& study, const StudyTable& table, const std::vector<std::string>& names,
                 const std::vector<std::string>& pictures) {
    Mistakes mistakes;
    mistakes.attempt([&] {
        std::vector<const StudyRun*> runs;
        if (find_runs(study, table, names, runs))
            check_runs(table, runs);
    });
    // Pictures may have a table beside them, of their name.
    mistakes.attempt([&] {
        if (std::find(pictures.begin(), pictures.end(), table.name) != pictures.end())
            throw InputError(table.place,
                             fmt::format("there is a picture '{}', whose table has the same file", table.name),
                             "give the table another name");
    });
    mistakes.throw_noted();
}

} // namespace graze
