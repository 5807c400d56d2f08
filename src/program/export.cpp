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

std::string query_of_multipliers(const ResultFile& file, const std::vector<std::string>& names,
                                 const std::string& where) {
    bool branches = false, others = false;
    for (const RunRecord& run : file.runs())
        (run.is_branch() ? branches : others) = true;
    // Of a branch, its parts are directions, and the parameter that is followed the coordinate.
    const std::string of_branches =
        "SELECT run, number, part AS direction, value AS coordinate, label, type FROM branch_points";
    const std::string of_others = "SELECT run, number, direction, coordinate, label, label AS type FROM all_points";
    return fmt::format("SELECT m.run, m.point, p.direction, p.coordinate, m.position, m.real, m.imaginary FROM "
                       "multipliers AS m JOIN ({}) AS p ON p.run = m.run AND p.number = m.point WHERE m.run IN "
                       "({}) AND {} ORDER BY m.run, m.point, m.position",
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
    if (what == "multipliers") {
        return query_of_multipliers(file, names, condition_of(arguments, "p.type", "p.direction"));
    }
    const std::vector<std::string> tables{"points", "samples", "segments"};
    if (std::find(tables.begin(), tables.end(), what) == tables.end())
        throw InputError({"--what", 0, 0}, fmt::format("there is no table '{}'", what),
                         name_advice(what, {"points", "samples", "segments", "multipliers", "runs"}, ""));
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

/// Row by row, for results larger than memory.
void write_csv(std::ostream& out, ResultFile::Rows& rows, int digits) {
    for (std::size_t c = 0; c < rows.columns(); ++c)
        out << (c > 0 ? "," : "") << rows.column_name(c);
    out << '\n';
    while (rows.next()) {
        for (std::size_t c = 0; c < rows.columns(); ++c) {
            out << (c > 0 ? "," : "");
            if (rows.is_integer(c)) {
                out << rows.integer(c);
            } else if (rows.is_text(c)) {
                const std::string text = rows.text(c);
                if (text.find_first_of(",\"\n") == std::string::npos) {
                    out << text;
                } else {
                    out << '"';
                    for (const char letter : text)
                        out << (letter == '"' ? "\"\"" : std::string(1, letter));
                    out << '"';
                }
            } else if (!rows.is_null(c)) {
                out << fmt::format("{:.{}g}", rows.number(c), digits);
            }
        }
        out << '\n';
    }
}

Table table_of(ResultFile::Rows& rows) {
    std::vector<Table::Column> columns;
    for (std::size_t c = 0; c < rows.columns(); ++c)
        columns.push_back({rows.column_name(c), ""});
    Table table(columns);
    while (rows.next())
        for (std::size_t c = 0; c < rows.columns(); ++c)
            if (rows.is_text(c))
                table.add(rows.text(c));
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
    deliver(table_of(rows), output, heading, console);
    return exit_success;
}

} // namespace graze
