#pragma once

#include "graze/base/input_error.hpp"
#include "graze/model/model.hpp"
#include "graze/results/result_file.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// A column of a run's tables.
struct StoredColumn {
    std::string name; ///< in the table
    std::string unit;
    ColumnType type = ColumnType::real;
};

/// Which rows of a run are read, and what of them.
struct Selection {
    /// A row for each sample, or for each segment of an orbit, rather than for each point.
    bool samples = false;
    /// Columns that every run has, such as "label"; of a row of samples also those of its point.
    std::vector<std::string> columns = {};
    /// Behind them what a user names: what the run varies, values or monitors, other columns, "multiplier" of orbits
    /// (the greatest modulus). Anything else is an expression of SQL in columns.
    std::vector<std::string> quantities = {};
    std::vector<std::string> values = {}; ///< behind these values, even if what the run varies has such a name
    /// Behind these mean, least and greatest of values over each point's samples, in one row for the point.
    std::vector<std::string> statistics = {};
    std::vector<std::string> directions = {}; ///< only of these (parts, of a branch); empty: all
    std::vector<std::string> samplings = {};  ///< only samples of these; empty: all
    std::string sorted_by = {};               ///< a quantity by which rows are ordered before points; empty: none
};

/// One run of a result file, to be read: what is known of it, its model, its columns with their units, and its rows,
/// which come one after the other however many there are. It keeps the file open.
struct StoredRun {
    /// @param place for messages
    /// @throws InputError when there is no such run, or its model cannot be read
    StoredRun(const ResultFile& from, const std::string& name, const Place& place);

    ResultFile file;
    RunRecord record;
    Model model;

    /// Columns of its points (of a branch, its orbits), or of its samples (the orbits' segments), in their order.
    std::vector<StoredColumn> columns(bool of_samples) const;
    /// Unit of what the run varies, of a value, or of a column; none for anything else.
    std::string unit(const std::string& name) const;
    bool has_value(const std::string& name) const;
    /// Names of what the run varies, and of its values.
    std::vector<std::string> coordinate_names() const;
    std::vector<std::string> value_names() const;
    /// Columns of its points with numbers that every run of its kind has.
    std::vector<std::string> number_columns() const;

    /// Rows in the order of points, then of samples. @throws InputError for expressions that are none
    ResultFile::Rows rows(const Selection& selection) const;
    /// How many points there are.
    std::size_t points() const;
    /// How many samples, or segments of orbits, there are.
    std::size_t samples() const;
    /// From the least to the greatest value of a quantity over all points, if there are two.
    std::optional<std::pair<double, double>> extent(const std::string& quantity) const;
    /// How far each of the run's values goes over all samples.
    std::vector<double> value_spreads() const;
    /// Labels with the number of points that have them, most frequent first.
    std::vector<std::pair<std::string, std::size_t>> label_counts() const;
    /// Directions in which a branch was followed that have points.
    std::vector<std::string> parts() const;
    /// Labels of special points of a branch, in their order.
    std::vector<std::string> special_labels() const;
    /// Number of the point whose coordinates are nearest to those asked for (the first ones matter first), or of the
    /// last point if none are; of some directions only, unless there are none. Nothing when there is no such point.
    /// @throws InputError for a name that the run does not vary
    std::optional<std::size_t> nearest(const std::vector<std::pair<std::string, double>>& at,
                                       const std::vector<std::string>& directions) const;
};

} // namespace graze
