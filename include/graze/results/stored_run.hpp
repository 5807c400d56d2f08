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

/// A column of a table of points or samples of a run.
struct StoredColumn {
    std::string name; ///< name of the column in the table
    std::string unit;
    ColumnType type = ColumnType::real;
};

/// Which rows and columns of a run are read. The columns of the rows are in the order of `columns`, `quantities`,
/// `values`, `statistics`.
struct Selection {
    /// true: a row for each sample, or for each segment of an orbit; false: a row for each point.
    bool samples = false;
    /// Columns that every run has, for example "label"; with samples also the columns of their points.
    std::vector<std::string> columns = {};
    /// Coordinates, values or monitors of the run, other columns, "multiplier" of orbits (the greatest modulus), or
    /// otherwise an SQL expression in columns.
    std::vector<std::string> quantities = {};
    std::vector<std::string> values = {}; ///< values of samples, also if a coordinate of the run has the same name
    /// Values of samples whose mean, least and greatest number over the samples of each point are read; then the table
    /// has one row for each point.
    std::vector<std::string> statistics = {};
    std::vector<std::string> directions = {}; ///< only rows of these directions, or parts of a branch; empty: of all
    std::vector<std::string> samplings = {};  ///< only samples of these samplings; empty: of all
    std::string sorted_by = {};               ///< quantity that orders the rows; empty: the order of points
};

/// One run of a result file that is read: its record, its model, its columns with their units, and its rows, which are
/// read one after the other without keeping them all in memory. It keeps the file open.
struct StoredRun {
    /// @param place where the user named the run, for messages
    /// @throws InputError if there is no such run, or its model cannot be read
    StoredRun(const ResultFile& from, const std::string& name, const Place& place);

    ResultFile file;
    RunRecord record;
    Model model;

    /// Columns of its points (orbits of a branch) or of its samples (segments of orbits), in the order of the table.
    std::vector<StoredColumn> columns(bool of_samples) const;
    /// Unit of a coordinate, value or column; empty for any other name.
    std::string unit(const std::string& name) const;
    bool has_value(const std::string& name) const;
    /// Names of the coordinates that the run varies, and names of its values.
    std::vector<std::string> coordinate_names() const;
    std::vector<std::string> value_names() const;
    /// Numeric columns of points that every run of this kind has.
    std::vector<std::string> number_columns() const;

    /// Rows in the order of points, then of samples. @throws InputError if SQLite does not accept a quantity
    ResultFile::Rows rows(const Selection& selection) const;
    /// Number of points.
    std::size_t points() const;
    /// Number of samples, or of segments of orbits.
    std::size_t samples() const;
    /// Least and greatest value of a quantity over all points; nothing if there are no two different ones.
    std::optional<std::pair<double, double>> extent(const std::string& quantity) const;
    /// Labels with the number of points that have them, most frequent first.
    std::vector<std::pair<std::string, std::size_t>> label_counts() const;
    /// Parts of a branch (directions in which it was followed) that have points.
    std::vector<std::string> parts() const;
    /// Labels of the special points of a branch, in the order of the points.
    std::vector<std::string> special_labels() const;
    /// Number of the point whose coordinates are nearest to the given ones, compared in their order; the last point if
    /// none are given. Only points of the given directions, or all if none are given. Nothing if there is no such
    /// point.
    /// @throws InputError for a name that is no coordinate of the run
    std::optional<std::size_t> nearest(const std::vector<std::pair<std::string, double>>& at,
                                       const std::vector<std::string>& directions) const;
};

} // namespace graze
