#pragma once

#include "graze/base/input_error.hpp"
#include "graze/results/result_file.hpp"

#include <string>
#include <vector>

namespace graze {

/// Which table of a result file is read, and which of its rows.
struct ResultTableRequest {
    /// Name of the table, one of `result_table_names()`.
    std::string what = "points";
    std::vector<std::string> runs = {}; ///< only rows of these runs; empty: of all that have such a table
    std::string label = {};     ///< only points with this label, or on a branch also of this type; empty: all points
    std::string direction = {}; ///< only points of this direction, or part of a branch; empty: of all
    Place place_of_runs = {}, place_of_what = {}; ///< where the user named runs and table, for messages
};

/// Rows of a table and the units of its columns.
struct ResultTable {
    ResultFile::Rows rows;
    std::vector<std::string> units;    ///< unit of each column; empty: none, or not the same in all rows
    std::vector<std::string> left_out; ///< runs left out because their columns differ and the user did not name them
};

/// Names of all tables: points, samples and segments; the details of orbits multipliers, half_multipliers, minima and
/// end_values; the results of fits estimates and covariances; and runs.
std::vector<std::string> result_table_names();
/// Reads a table. @throws InputError for an unknown table or run, and for runs that do not fit into one table
ResultTable result_table(const ResultFile& file, const ResultTableRequest& request);
/// The rows of a query written by the user. @param sql see ResultFile::query
/// @param runs runs whose columns give the units of columns of the same name; empty: all runs
ResultTable queried_table(const ResultFile& file, const std::string& sql, const std::vector<std::string>& runs,
                          const Place& place_of_runs);
/// The requested names of runs, or the names of all runs if none are requested. @throws InputError for an unknown name
std::vector<std::string> chosen_runs(const ResultFile& file, const std::vector<std::string>& wanted,
                                     const Place& place);

} // namespace graze
