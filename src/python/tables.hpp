#pragma once

#include "graze/results/result_file.hpp"
#include "graze/results/table.hpp"
#include "python/binding.hpp"

namespace graze::python {

/// A table as (names, arrays, units): an array of numbers, with NaN where one is missing, or a list of texts for each
/// column. In a column with both, numbers are Python's.
py::tuple columns_of(const Table& table);

/// Rows of a query in the same form: columns of whole numbers without gaps are arrays of whole numbers.
/// @param units one for each column, or none
py::tuple columns_of(ResultFile::Rows rows, const std::vector<std::string>& units);

} // namespace graze::python
