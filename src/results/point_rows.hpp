#pragma once

#include "graze/results/result_file.hpp"
#include "results/database.hpp"

#include <complex>
#include <string>
#include <vector>

namespace graze {

/// Writes a point, without its samples, as a row of its run's table.
void write_point(Statement& statement, const RunRecord& run, const PointRecord& point);
/// Reads one such row.
PointRecord read_point(const Statement& row, const RunRecord& run);
/// Writes multipliers of a point, infinite ones as such.
void write_multipliers(Statement& statement, const std::string& run, std::size_t point,
                       const std::vector<std::complex<double>>& multipliers);
/// Reads them from a query of real and imaginary parts. What earlier versions wrote as missing was infinite.
std::vector<std::complex<double>> read_multipliers(Statement& rows);
/// Their number if there is none of that name.
std::size_t index_of(const std::vector<std::string>& names, const std::string& name);

/// A file is not what this program has written. @throws InputError
[[noreturn]] void throw_contradiction(const std::string& path, const std::string& what);
/// @throws InputError unless a statement gives that many
void require_columns(const Statement& rows, std::size_t columns, const std::string& path);

} // namespace graze
