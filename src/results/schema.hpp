#pragma once

#include "graze/results/result_file.hpp"

#include <string>
#include <vector>

namespace graze {

/// Format of result files that this version writes.
constexpr int result_format = 2;
constexpr int result_application = 0x67727a31; ///< "grz1", for tools that recognise files by it

/// Tables that every file has.
std::string common_tables();
/// Of these, those with rows of a run besides its points: `run` and `point` come first.
std::vector<std::string> tables_of_details();
/// Views over all runs, to be made anew whenever runs change.
std::string views(const std::vector<RunRecord>& runs);

/// Columns of a run's tables, in their order. Of a branch, `points` are its orbits, `samples` their segments,
/// coordinates the parameters, and values the monitors.
struct RunTables {
    explicit RunTables(const RunRecord& run);

    std::string points, samples; ///< quoted names of the tables
    bool is_branch = false;
    std::vector<std::string> coordinates, states, values; ///< names of columns, unquoted
    std::string create() const;
    std::string insert_point() const;
    std::string insert_sample() const;
    std::string select_point() const; ///< columns as insert_point has them
    std::size_t point_columns() const, sample_columns() const;
};

/// Columns between the coordinates and the final states.
constexpr int fixed_point_columns = 16;
/// Columns after the monitors of a branch.
constexpr int fixed_branch_columns = 20;

} // namespace graze
