#pragma once

#include "graze/results/result_file.hpp"
#include "results/columns.hpp"

#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// Format of result files that this version writes: to be raised with every column that comes, goes or changes. A
/// column that comes is `added` (see columns.hpp): older files lack it, and it is read from them as absent. One that is
/// called otherwise says its former name.
constexpr int result_format = 7;
/// The oldest format whose readers can read what this version writes: with columns and tables that they do not know,
/// but nothing that they need changed or gone. To be raised to `result_format` only where something changes or goes.
constexpr int oldest_reader = 7;
/// The oldest format that this version reads, and goes on with.
constexpr int oldest_result_format = 6;
constexpr int result_application = 0x67727a31; ///< "grz1", for tools that recognise files by it

/// A table of all runs with several rows for each of their points; columns come behind run, point and position.
struct DetailTable {
    std::string name;
    std::vector<ColumnKind> columns;
    bool of_branches;      ///< only
    bool position_matters; ///< to those who read it: it says which one it is
};
const std::vector<DetailTable>& detail_tables();

/// Tables of all runs, with what is between their parentheses, that older files may lack.
std::vector<std::pair<std::string, std::string>> shared_tables();
/// Tables that every file has.
std::string common_tables();
/// Views over all runs, to be made anew whenever runs change.
std::string views(const std::vector<RunRecord>& runs);
/// Writes a row with so many cells.
std::string insert_into(const std::string& table, std::size_t columns);
/// The name, with a number behind it if another column has it already; SQL does not tell upper and lower case apart.
std::string distinct_name(const std::string& name, std::set<std::string>& taken);
/// "a, b, c"
std::string listed(const std::vector<ColumnKind>& columns, std::string_view before_each = "");

/// A column of a run's table.
struct RunColumn {
    std::string column; ///< its name there, unquoted
    ColumnKind kind;
    std::string name, own_unit; ///< of the parameter, state or value that it belongs to, if any
};

/// A run's own tables. Of a branch, `points` are its orbits, `samples` their segments, coordinates the parameters, and
/// values the monitors.
struct RunTables {
    explicit RunTables(const RunRecord& run);

    std::string points, samples; ///< quoted names of the tables
    bool is_branch = false;
    std::vector<RunColumn> point_columns, sample_columns; ///< in their order

    /// Names of the columns of a group, unquoted, in the order of the run's own things.
    std::vector<std::string> names_of(ColumnGroup group) const;
    std::string create() const;
    std::string insert_point() const;
    std::string insert_sample() const; ///< of samples, the first cell is their rowid
    std::string select_point() const;  ///< columns as insert_point has them
    std::string select_sample() const; ///< the same, without a rowid
    /// Samples lie in the order of their points' numbers, by which they are found without an index: those of a point
    /// have rowids from this many times its number on.
    static constexpr std::int64_t samples_of_a_point = std::int64_t{1} << 24;
};

} // namespace graze
