#pragma once

#include "results/columns.hpp"

#include <complex>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Columns of a table of points.
const ColumnsOf<RunRecord, PointRecord>& point_columns();

/// One sample of a point.
struct SampleRow {
    std::size_t point = 0, sampling = 0;
    double time = 0;
    std::vector<double> values;
};
/// Columns of a table of samples.
const ColumnsOf<RunRecord, SampleRow>& sample_columns();

/// Columns of tables of multipliers, after run, point and position.
const ColumnsOf<RunRecord, std::complex<double>>& multiplier_columns();

/// Index of a name; the number of names if it is not among them.
std::size_t index_of(const std::vector<std::string>& names, const std::string& name);

/// Reports a file whose contents contradict each other. @throws InputError
[[noreturn]] void throw_contradiction(const std::string& path, const std::string& what);
/// @throws InputError unless a statement gives this number of columns
void require_columns(const Statement& rows, std::size_t columns, const std::string& path);

} // namespace graze
