#include "base/enumerator_name.hpp"
#include "graze/branch/special_point.hpp"
#include "graze/results/hdf5.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/result_table.hpp"
#include "graze/sweep/attractor.hpp"
#include "program/commands.hpp"
#include "program/output_file.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace graze {

namespace {

/// The distinct words in some columns of the points of a file.
/// @param of_points columns of points of sweeps; @param of_branches columns of points of branches
std::vector<std::string> words_in(const ResultFile& file, const std::vector<std::string>& of_points,
                                  const std::vector<std::string>& of_branches) {
    std::vector<std::string> words;
    const auto add = [&](const std::string& column, const char* view) {
        auto rows = file.query(fmt::format("SELECT DISTINCT {0} FROM {1} WHERE {0} <> ''", column, view));
        while (rows.next())
            words.push_back(rows.text(0));
    };
    const std::vector<RunRecord> runs = file.runs();
    const auto is_branch = [](const RunRecord& run) { return run.is_branch(); };
    if (!std::all_of(runs.begin(), runs.end(), is_branch))
        for (const std::string& column : of_points)
            add(column, "all_points");
    if (std::any_of(runs.begin(), runs.end(), is_branch))
        for (const std::string& column : of_branches)
            add(column, "branch_points");
    return words;
}

/// Checks --label and --direction. A known word that no point of this file has selects no rows; an unknown word is an
/// error.
void require_selection(const ResultTableRequest& request, const ResultFile& file) {
    const auto require = [](const char* option, const std::string& word, const std::vector<std::string>& there,
                            const char* what) {
        if (std::find(there.begin(), there.end(), word) == there.end())
            throw InputError({option, 0, 0}, fmt::format("no point has the {} '{}'", what, word),
                             name_advice(word, there, "leave it out"));
    };
    const auto is_label = [](const std::string& word) {
        return enumerator_named(word, Label::failed) || point_type(word);
    };
    if (!request.label.empty() && !is_label(request.label))
        require("--label", request.label, words_in(file, {"label"}, {"label", "type"}), "label");
    if (!request.direction.empty() && request.direction != "up" && request.direction != "down")
        require("--direction", request.direction, words_in(file, {"direction"}, {"part"}), "direction");
}

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
    require_selection(request, file);
    ResultTable table = result_table(file, request);
    if (!table.left_out.empty())
        console.err << fmt::format("graze: branches have other columns and are left out: see graze points {0}, or "
                                   "graze export {0} --run {1}\n",
                                   arguments.file, table.left_out.front());
    return table;
}

/// A cell of a CSV file, quoted if necessary.
std::string quoted_cell(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
    std::string result = "\"";
    for (const char letter : text)
        result += letter == '"' ? std::string("\"\"") : std::string(1, letter);
    return result + '"';
}

/// Writes rows as they are read, since results may be larger than memory.
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

Table export_table(ResultTable& given) {
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

/// True when an output is a folder, which gets one file for each run.
bool is_folder(const std::string& path) {
    std::error_code error;
    return path.ends_with('/') || std::filesystem::is_directory(path, error);
}

/// Writes one file for each run, since runs may have different columns.
void export_each(const ExportArguments& arguments, const ResultFile& file, const Console& console) {
    if (!arguments.sql.empty())
        throw InputError({"--output", 0, 0}, "a query has one table, and a folder is given", "name a file");
    const std::string& folder = arguments.output.file;
    make_folder(folder, "--output");
    const std::string ending = arguments.hdf5.empty() || arguments.hdf5 == "table" ? "txt" : arguments.hdf5;
    for (const std::string& run : chosen_runs(file, split_list(arguments.runs), {"--run", 0, 0})) {
        const bool branch = file.find_run(run)->is_branch(); // branches have segments, sweeps have samples
        if (arguments.runs.empty() && arguments.what == (branch ? "samples" : "segments"))
            continue;
        ExportArguments one = arguments;
        one.runs = {run};
        one.output.file = (std::filesystem::path(folder) / (run + "." + ending)).string();
        export_command(one, console);
        console.out << one.output.file << '\n';
    }
}

} // namespace

int export_command(const ExportArguments& arguments, const Console& console) {
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    if (arguments.hdf5 != "hdf5" && arguments.what != "runs" && is_folder(arguments.output.file)) {
        export_each(arguments, file, console);
        return exit_success;
    }
    if (arguments.hdf5 == "hdf5") {
        if (arguments.output.file.empty())
            throw InputError("HDF5 cannot be written to standard output", "name a file by --output FILE.h5");
        FileReplacement target(arguments.output.file);
        const std::vector<std::string> runs = chosen_runs(file, split_list(arguments.runs), {"--run", 0, 0});
        target.written_by([&](const std::string& path) { export_hdf5(file, runs, path); });
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
    output.all = output.all || !arguments.sql.empty(); // a query chooses its columns itself
    JsonObject heading;
    heading.add("file", file.path());
    deliver(export_table(table), output, heading, console,
            arguments.what == "estimates" ? std::vector<std::string>{"name", "unit", "value", "error", "low", "high"}
                                          : std::vector<std::string>{});
    return exit_success;
}

} // namespace graze
