#include "graze/results/hdf5.hpp"
#include "graze/results/result_file.hpp"
#include "program/commands.hpp"
#include "program/output_file.hpp"
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

std::string in_quotes(const std::string& text) {
    std::string result = "'";
    for (const char c : text)
        result += c == '\'' ? std::string("''") : std::string(1, c);
    return result + "'";
}

std::string query_of(const ExportArguments& arguments, const ResultFile& file) {
    if (!arguments.sql.empty())
        return arguments.sql;
    std::string where = "1";
    if (!arguments.label.empty())
        where += " AND p.label = " + in_quotes(arguments.label);
    if (!arguments.direction.empty())
        where += " AND p.direction = " + in_quotes(arguments.direction);
    const auto names = chosen_runs(file, split_list(arguments.runs));
    if (arguments.what == "runs")
        return "SELECT r.name AS run, r.kind, r.status, r.points, (SELECT count(*) FROM all_points AS a WHERE a.run = "
               "r.name) AS done, r.model_name AS model, r.version FROM runs AS r ORDER BY r.number";
    if (arguments.what == "multipliers") {
        std::string list;
        for (const std::string& name : names)
            list += (list.empty() ? "" : ",") + in_quotes(name);
        return fmt::format(
            "SELECT m.run, m.point, p.direction, p.coordinate, m.position, m.real, m.imaginary FROM "
            "multipliers AS m JOIN all_points AS p ON p.run = m.run AND p.number = m.point WHERE m.run IN "
            "({}) AND {} ORDER BY m.run, m.point, m.position",
            list, where);
    }
    const std::vector<std::string> tables{"points", "samples"};
    if (std::find(tables.begin(), tables.end(), arguments.what) == tables.end())
        throw InputError({"--what", 0, 0}, fmt::format("there is no table '{}'", arguments.what),
                         name_advice(arguments.what, {"points", "samples", "multipliers", "runs"}, ""));
    if (names.empty())
        throw InputError("there are no runs in the file", "run the study first");
    std::string all;
    std::size_t width = 0;
    for (const std::string& name : names) {
        const StoredRun run(file, name, {});
        std::string columns = arguments.what == "points" ? "p.*" : "";
        if (columns.empty()) {
            columns = "s.point, p.direction";
            for (const ResultColumn& column : run.record.coordinates)
                columns += ", " + run.column(column.name);
            columns += ", s.sampling, s.time";
            for (const ResultColumn& column : run.record.values)
                columns += ", " + run.value_column(column.name);
        }
        const std::string from = arguments.what == "points" ? run.points + " AS p" : run.joined;
        const std::string order = arguments.what == "points" ? "p.number" : "s.rowid";
        if (names.size() == 1)
            return fmt::format("SELECT {} FROM {} WHERE {} ORDER BY {}", columns, from, where, order);
        const std::size_t here = run.record.coordinates.size() + run.record.values.size() + run.record.states.size();
        if (width != 0 && width != here)
            throw InputError("the runs do not have the same columns", "export one of them at a time, by --run NAME");
        width = here;
        all += fmt::format("{}SELECT {} AS run, {} FROM {} WHERE {}", all.empty() ? "" : " UNION ALL ", in_quotes(name),
                           columns, from, where);
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
    auto rows = file.query(query_of(arguments, file));
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
