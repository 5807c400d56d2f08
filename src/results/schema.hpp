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
constexpr int result_format = 11;
/// The oldest format whose readers can read what this version writes: with columns and tables that they do not know,
/// but nothing that they need changed or gone. To be raised to `result_format` only where something changes or goes.
constexpr int oldest_reader = 7;
/// The oldest format that this version reads, and goes on with.
constexpr int oldest_result_format = 6;
constexpr int result_application = 0x67727a31; ///< "grz1", for tools that recognise files by it

/// A table with several rows for each point of all runs. Its first columns are run, point and position.
struct DetailTable {
    std::string name;
    std::vector<ColumnKind> columns;
    bool of_branches;      ///< whether only branches have rows in it
    bool position_matters; ///< whether the position identifies the row and is shown
};
const std::vector<DetailTable>& detail_tables();

/// Tables of all runs, with what is between their parentheses, that older files may lack.
std::vector<std::pair<std::string, std::string>> shared_tables();
/// Tables that every file has.
std::string common_tables();
/// Statements that create the views over all runs. To be executed whenever the runs change.
std::string views(const std::vector<RunRecord>& runs);
/// Statement that inserts a row with this number of cells.
std::string insert_into(const std::string& table, std::size_t columns);
/// The name, with a number appended if it is already taken. Upper and lower case count as equal, as in SQL.
std::string distinct_name(const std::string& name, std::set<std::string>& taken);
/// Checks that a result file can store a run of this name.
/// @param branch whether it is a run of kind orbit or continue
/// @param others names of the other runs of the file
/// @throws InputError if it differs from another name only in case, which SQL ignores, or is the name of a view
void require_free_name(const std::string& name, bool branch, const std::vector<std::string>& others,
                       const Place& place);
/// Names of columns, separated by commas.
std::string listed(const std::vector<ColumnKind>& columns, std::string_view before_each = "");

/// A column of a table of one run.
struct RunColumn {
    std::string column; ///< name of the column, unquoted
    ColumnKind kind;
    std::string name, own_unit; ///< name and unit of the parameter, state or value of the column, if any
};

/// The tables of points and samples of one run. On a branch, `points` are orbits, `samples` segments, coordinates
/// parameters, and values monitors.
struct RunTables {
    explicit RunTables(const RunRecord& run);

    std::string points, samples; ///< quoted names of the tables
    bool is_branch = false;
    std::vector<RunColumn> point_columns, sample_columns; ///< in the order of the table

    /// Names of the columns of a group, unquoted, in the order of the coordinates, states or values of the run.
    std::vector<std::string> names_of(ColumnGroup group) const;
    std::string create() const;
    std::string insert_point() const;
    std::string insert_sample() const; ///< the first cell of a sample is its rowid
    std::string select_point() const;  ///< gives the columns in the order of insert_point
    std::string select_sample() const; ///< the same, without a rowid
    /// The rowids of the samples of a point begin at its number times this, so that they are found without an index.
    static constexpr std::int64_t samples_of_a_point = std::int64_t{1} << 24;
};

} // namespace graze
