#include "graze/results/hdf5.hpp"
#include "graze/results/result_file.hpp"
#include "program/commands.hpp"
#include "program/output_file.hpp"
#include "program/picture_kinds.hpp"
#include "program/result_query.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace graze {

namespace {

std::vector<std::string> chosen_runs(const ResultFile& file, const std::vector<std::string>& wanted) {
    std::vector<std::string> known;
    for (const RunRecord& run : file.runs())
        known.push_back(run.name);
    for (const std::string& name : wanted)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw InputError({"--run", 0, 0}, fmt::format("there are no results of a run '{}'", name),
                             name_advice(name, known, "there are none at all"));
    return wanted.empty() ? known : wanted;
}

/// How many points of each run are there.
std::string query_of_runs(const ResultFile& file) {
    std::string counts;
    for (const RunRecord& run : file.runs())
        counts += fmt::format(" WHEN {} THEN (SELECT count(*) FROM {})", in_quotes(run.name),
                              StoredRun(file, run.name, {}).points);
    return fmt::format("SELECT r.name AS run, r.kind, r.status, r.points, {} AS done, r.model_name AS model, r.version "
                       "FROM runs AS r ORDER BY r.number",
                       counts.empty() ? "0" : fmt::format("CASE r.name{} END", counts));
}

/// What lies in tables of all runs, and the columns of each that are shown.
const std::map<std::string, std::string> details{
    {"multipliers", "m.position, m.real, m.imaginary"},
    {"half_multipliers", "m.position, m.real, m.imaginary"},
    {"minima", "m.segment, m.event, m.time, m.value, m.size"},
    {"end_values", "m.segment, m.event, m.value, m.rate"},
};

std::string query_of_details(const ResultFile& file, const std::vector<std::string>& names, const std::string& what,
                             const std::string& where) {
    bool branches = false, others = false;
    for (const RunRecord& run : file.runs())
        (run.is_branch() ? branches : others) = true;
    // Of a branch, its parts are directions, and the parameter that is followed the coordinate.
    const std::string of_branches =
        "SELECT run, number, part AS direction, value AS coordinate, label, type FROM branch_points";
    const std::string of_others = "SELECT run, number, direction, coordinate, label, label AS type FROM all_points";
    return fmt::format("SELECT m.run, m.point, p.direction, p.coordinate, {} FROM "
                       "{} AS m JOIN ({}) AS p ON p.run = m.run AND p.number = m.point WHERE m.run IN "
                       "({}) AND {} ORDER BY m.run, m.point, m.position",
                       details.at(what), what,
                       branches && others ? of_others + " UNION ALL " + of_branches
                       : branches         ? of_branches
                                          : of_others,
                       in_list(names), where);
}

/// What is shown of a run's table.
std::string columns_of(const StoredRun& run, const std::string& what) {
    if (what == "points")
        return "p.*";
    std::string columns = what == "segments" ? "s.point, p.part, p.type, p.label" : std::string("s.point, p.direction");
    const std::size_t shown = what == "samples" ? run.record.coordinates.size() : 1; // of a branch what is followed
    for (std::size_t c = 0; c < std::min(shown, run.record.coordinates.size()); ++c)
        columns += ", " + run.column(run.record.coordinates[c].name);
    if (what == "segments") {
        columns += ", s.segment, s.mode, s.ending, s.duration, s.approach_speed, s.departure, s.guard_margin";
        for (const std::string& name : run.state_columns)
            columns += ", s." + quoted_column(name);
        return columns;
    }
    columns += ", s.sampling, s.time";
    for (const ResultColumn& column : run.record.values)
        columns += ", " + run.value_column(column.name);
    return columns;
}

/// Which runs have a table: branches have segments and no samples, other runs the reverse; points of both kinds do not
/// go into one table.
std::vector<StoredRun> runs_with(const std::string& what, const ExportArguments& arguments, const ResultFile& file,
                                 const Console& console) {
    std::vector<StoredRun> branches, others;
    for (const std::string& name : chosen_runs(file, split_list(arguments.runs))) {
        StoredRun run(file, name, {});
        (run.record.is_branch() ? branches : others).push_back(std::move(run));
    }
    const bool named = !arguments.runs.empty();
    const bool wants_branches = what == "segments" || (what == "points" && others.empty());
    std::vector<StoredRun>& chosen = wants_branches ? branches : others;
    const std::vector<StoredRun>& rest = wants_branches ? others : branches;
    if (chosen.empty() && rest.empty())
        throw InputError("there are no runs in the file", "run the study first");
    if (chosen.empty() || (named && !rest.empty()))
        throw InputError({"--what", 0, 0},
                         fmt::format("run '{}' is of kind {}, which has no {}{}", rest.front().record.name,
                                     rest.front().record.kind, what, what == "points" ? " like the others" : ""),
                         what == "points" ? "export one of them at a time, by --run NAME"
                                          : fmt::format("export its {}", wants_branches ? "samples" : "segments"));
    if (what == "points" && !rest.empty())
        console.err << fmt::format("graze: branches have other columns and are left out: see graze points {0}, or "
                                   "graze export {0} --run {1}\n",
                                   arguments.file, rest.front().record.name);
    return std::move(chosen);
}

/// Which rows are asked for. @param type column of another name that a label may be
std::string condition_of(const ExportArguments& arguments, const char* type, const char* direction) {
    std::string where = "1";
    if (!arguments.label.empty())
        where += fmt::format(" AND {} IN (p.label, {})", in_quotes(arguments.label), type);
    if (!arguments.direction.empty())
        where += fmt::format(" AND {} = {}", direction, in_quotes(arguments.direction));
    return where;
}

std::string query_of(const ExportArguments& arguments, const ResultFile& file, const Console& console) {
    if (!arguments.sql.empty())
        return arguments.sql;
    const std::vector<std::string> names = chosen_runs(file, split_list(arguments.runs));
    const std::string& what = arguments.what;
    if (what == "runs")
        return query_of_runs(file);
    if (details.contains(what))
        return query_of_details(file, names, what, condition_of(arguments, "p.type", "p.direction"));
    const std::vector<std::string> tables{"points", "samples", "segments"};
    if (std::find(tables.begin(), tables.end(), what) == tables.end())
        throw InputError({"--what", 0, 0}, fmt::format("there is no table '{}'", what),
                         name_advice(what,
                                     {"points", "samples", "segments", "multipliers", "half_multipliers", "minima",
                                      "end_values", "runs"},
                                     ""));
    const std::vector<StoredRun> runs = runs_with(what, arguments, file, console);
    std::string all;
    std::vector<std::string> shape;
    for (const StoredRun& run : runs) {
        const bool branch = run.record.is_branch();
        const std::string from = what == "points" ? run.points + " AS p" : run.joined;
        const std::string where =
            condition_of(arguments, branch ? "p.type" : "p.label", branch ? "p.part" : "p.direction");
        const std::string columns = columns_of(run, what);
        const std::string order = what == "points" ? "p.number" : branch ? "s.point, s.segment" : "s.rowid";
        if (runs.size() == 1)
            return fmt::format("SELECT {} FROM {} WHERE {} ORDER BY {}", columns, from, where, order);
        std::vector<std::string> here;
        for (const auto* list : {&run.record.coordinates, &run.record.values, &run.record.states})
            for (const ResultColumn& column : *list)
                here.push_back(column.name);
        if (!shape.empty() && (branch ? shape != here : shape.size() != here.size()))
            throw InputError("the runs do not have the same columns",
                             branch ? "export one of them at a time, by --run NAME, or see graze points FILE --all"
                                    : "export one of them at a time, by --run NAME");
        shape = here;
        all += fmt::format("{}SELECT {} AS run, {} FROM {} WHERE {}", all.empty() ? "" : " UNION ALL ",
                           in_quotes(run.record.name), columns, from, where);
    }
    return all;
}

/// With quotes where it needs them.
std::string quoted_cell(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
    std::string result = "\"";
    for (const char letter : text)
        result += letter == '"' ? std::string("\"\"") : std::string(1, letter);
    return result + '"';
}

/// Row by row, for results larger than memory.
void write_csv(std::ostream& out, ResultFile::Rows& rows, int digits) {
    for (std::size_t c = 0; c < rows.columns(); ++c)
        out << (c > 0 ? "," : "") << quoted_cell(rows.column_name(c));
    out << '\n';
    while (rows.next()) {
        for (std::size_t c = 0; c < rows.columns(); ++c) {
            out << (c > 0 ? "," : "");
            if (rows.is_integer(c)) {
                out << rows.integer(c);
            } else if (rows.is_text(c)) {
                out << quoted_cell(rows.text(c));
            } else if (!rows.is_null(c)) {
                out << fmt::format("{:.{}g}", rows.number(c), digits);
            }
        }
        out << '\n';
    }
}

/// Units of columns by their names, of those that have the same unit in all of the runs.
std::map<std::string, std::string> units_of(const ResultFile& file, const std::vector<std::string>& names) {
    std::map<std::string, std::set<std::string>> all;
    for (const std::string& name : names) {
        const StoredRun run(file, name, {});
        const auto note = [&](const std::vector<ResultColumn>& columns, const std::vector<std::string>& in_tables) {
            for (std::size_t c = 0; c < std::min(columns.size(), in_tables.size()); ++c)
                all[in_tables[c]].insert(columns[c].unit);
        };
        note(run.record.coordinates, run.coordinate_columns);
        note(run.record.states, run.state_columns);
        note(run.record.values, run.value_columns);
        const std::string& time = run.model.time_unit;
        for (const char* column : {"time", "duration", "ending_time", "event_time"})
            all[column].insert(time);
        if (run.record.is_branch()) // otherwise it is counted in returns
            all["period"].insert(time);
        else
            all["period"].insert("");
        for (const char* column : {"lyapunov", "lyapunov_error"})
            all[column].insert(time.empty() ? "" : "1/" + time);
        if (!run.record.coordinates.empty())
            for (const char* column : {"coordinate", "coordinate_before", "value", "bracket_low", "bracket_high"})
                all[column].insert(run.record.coordinates.front().unit);
    }
    std::map<std::string, std::string> units;
    for (const auto& [column, found] : all)
        if (found.size() == 1)
            units[column] = *found.begin();
    return units;
}

Table table_of(ResultFile::Rows& rows, const std::map<std::string, std::string>& units) {
    std::vector<Table::Column> columns;
    for (std::size_t c = 0; c < rows.columns(); ++c) {
        const auto unit = units.find(rows.column_name(c));
        columns.push_back({rows.column_name(c), unit == units.end() ? "" : unit->second});
    }
    Table table(columns);
    while (rows.next())
        for (std::size_t c = 0; c < rows.columns(); ++c)
            if (rows.is_text(c))
                table.add(rows.text(c));
            else if (!rows.is_null(c) && std::isinf(rows.number(c)))
                table.add(rows.number(c) > 0 ? "inf" : "-inf");
            else
                table.add(rows.is_null(c) ? std::nan("") : rows.number(c));
    return table;
}

} // namespace

int export_command(const ExportArguments& arguments, const Console& console) {
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    if (arguments.hdf5 == "hdf5") {
        if (arguments.output.file.empty())
            throw InputError("HDF5 cannot be written to standard output", "name a file by --output FILE.h5");
        FileReplacement target(arguments.output.file);
        export_hdf5(file, chosen_runs(file, split_list(arguments.runs)), target.temporary_path());
        target.commit();
        return exit_success;
    }
    OutputArguments output = arguments.output;
    output.format = arguments.hdf5 == "csv"    ? TableFormat::csv
                    : arguments.hdf5 == "json" ? TableFormat::json
                                               : TableFormat::table;
    auto rows = file.query(query_of(arguments, file, console));
    if (output.format == TableFormat::csv && output.file.empty()) {
        write_csv(console.out, rows, output.digits);
        return exit_success;
    }
    if (output.format == TableFormat::csv) {
        FileReplacement target(output.file);
        std::ofstream stream(target.temporary_path(), std::ios::binary);
        write_csv(stream, rows, output.digits);
        stream.close();
        if (!stream)
            throw InputError({output.file, 0, 0}, "it cannot be written", "look whether the disk is full");
        target.commit();
        return exit_success;
    }
    JsonObject heading;
    heading.add("file", file.path());
    std::map<std::string, std::string> units;
    if (arguments.what != "runs" || !arguments.sql.empty())
        units = units_of(file, chosen_runs(file, split_list(arguments.runs)));
    // In tables of details a value is that of an event function.
    if (details.contains(arguments.what) && arguments.sql.empty())
        units.erase("value");
    deliver(table_of(rows, units), output, heading, console);
    return exit_success;
}

} // namespace graze
