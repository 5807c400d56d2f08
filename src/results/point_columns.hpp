#pragma once

#include "results/columns.hpp"

#include <complex>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Of a table of points.
const ColumnsOf<RunRecord, PointRecord>& point_columns();

/// One sample of a point.
struct SampleRow {
    std::size_t point = 0, sampling = 0;
    double time = 0;
    std::vector<double> values;
};
/// Of a table of samples.
const ColumnsOf<RunRecord, SampleRow>& sample_columns();

/// Of tables of multipliers, behind run, point and position.
const ColumnsOf<RunRecord, std::complex<double>>& multiplier_columns();

/// Their number if there is none of that name.
std::size_t index_of(const std::vector<std::string>& names, const std::string& name);

/// A file is not what this program has written. @throws InputError
[[noreturn]] void throw_contradiction(const std::string& path, const std::string& what);
/// @throws InputError unless a statement gives that many
void require_columns(const Statement& rows, std::size_t columns, const std::string& path);

} // namespace graze
