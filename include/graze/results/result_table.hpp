#pragma once

#include "graze/base/input_error.hpp"
#include "graze/results/result_file.hpp"

#include <string>
#include <vector>

namespace graze {

/// What is taken out of a result file as one table.
struct ResultTableRequest {
    /// one of `result_table_names()`
    std::string what = "points";
    std::vector<std::string> runs = {}; ///< empty: all that have such a table
    std::string label = {};             ///< only points with this label (or, of a branch, of this type); empty: all
    std::string direction = {};         ///< only points of this direction (part, of a branch); empty: all
    Place place_of_runs = {}, place_of_what = {}; ///< for messages
};

/// Rows with what is known of their columns.
struct ResultTable {
    ResultFile::Rows rows;
    std::vector<std::string> units;    ///< of the columns, in their order; empty: none, or several
    std::vector<std::string> left_out; ///< runs that were not named, and have other columns
};

/// points, samples and segments; details of orbits: multipliers, half_multipliers, minima, end_values; what was found
/// from measurements: estimates, covariances; and runs.
std::vector<std::string> result_table_names();
/// @throws InputError for a table or run that is not there, and for runs that do not fit into one table
ResultTable result_table(const ResultFile& file, const ResultTableRequest& request);
/// The rows of a query of somebody's own. @param sql see ResultFile::query
/// @param runs from whose columns units are taken; empty: all
ResultTable queried_table(const ResultFile& file, const std::string& sql, const std::vector<std::string>& runs,
                          const Place& place_of_runs);
/// Names of the runs asked for, or of all. @throws InputError for one that is not there
std::vector<std::string> chosen_runs(const ResultFile& file, const std::vector<std::string>& wanted,
                                     const Place& place);

} // namespace graze
