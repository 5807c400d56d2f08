#include "graze/results/hdf5.hpp"
#include "graze/results/result_table.hpp"
#include "program/commands.hpp"
#include "program/output_file.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

namespace graze {

namespace {

ResultTable table_asked_for(const ExportArguments& arguments, const ResultFile& file, const Console& console) {
    ResultTableRequest request;
    request.what = arguments.what;
    request.runs = split_list(arguments.runs);
    request.label = arguments.label;
    request.direction = arguments.direction;
    request.place_of_runs = Place{"--run", 0, 0};
    request.place_of_what = Place{"--what", 0, 0};
    if (!arguments.sql.empty())
        return queried_table(file, arguments.sql, request.runs, request.place_of_runs);
    ResultTable table = result_table(file, request);
    if (!table.left_out.empty())
        console.err << fmt::format("graze: branches have other columns and are left out: see graze points {0}, or "
                                   "graze export {0} --run {1}\n",
                                   arguments.file, table.left_out.front());
    return table;
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

Table table_of(ResultTable& given) {
    ResultFile::Rows& rows = given.rows;
    std::vector<Table::Column> columns;
    for (std::size_t c = 0; c < rows.columns(); ++c)
        columns.push_back({rows.column_name(c), given.units[c]});
    Table table(columns);
    while (rows.next())
        for (std::size_t c = 0; c < rows.columns(); ++c)
            if (rows.is_text(c))
                table.add(rows.text(c));
            else
                table.add_extended(rows.is_null(c) ? std::nan("") : rows.number(c));
    return table;
}

} // namespace

int export_command(const ExportArguments& arguments, const Console& console) {
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    if (arguments.hdf5 == "hdf5") {
        if (arguments.output.file.empty())
            throw InputError("HDF5 cannot be written to standard output", "name a file by --output FILE.h5");
        FileReplacement target(arguments.output.file);
        export_hdf5(file, chosen_runs(file, split_list(arguments.runs), {"--run", 0, 0}), target.temporary_path());
        target.commit();
        return exit_success;
    }
    OutputArguments output = arguments.output;
    output.format = arguments.hdf5 == "csv"    ? TableFormat::csv
                    : arguments.hdf5 == "json" ? TableFormat::json
                                               : TableFormat::table;
    ResultTable table = table_asked_for(arguments, file, console);
    if (output.format == TableFormat::csv && output.file.empty()) {
        write_csv(console.out, table.rows, output.shown_digits());
        return exit_success;
    }
    if (output.format == TableFormat::csv) {
        FileReplacement target(output.file);
        std::ofstream stream(target.temporary_path(), std::ios::binary);
        write_csv(stream, table.rows, output.shown_digits());
        stream.close();
        if (!stream)
            throw InputError({output.file, 0, 0}, "it cannot be written", "look whether the disk is full");
        target.commit();
        return exit_success;
    }
    output.all = output.all || !arguments.sql.empty(); // which names its columns
    JsonObject heading;
    heading.add("file", file.path());
    deliver(table_of(table), output, heading, console,
            arguments.what == "estimates" ? std::vector<std::string>{"name", "unit", "value", "error", "low", "high"}
                                          : std::vector<std::string>{});
    return exit_success;
}

} // namespace graze
