#pragma once

#include "graze/picture/figure.hpp"
#include "python/binding.hpp"

namespace graze::python {

/// A figure as dictionaries and lists with the names of the C++ members; points are arrays of two columns.
py::object object_of(const Figure& figure);

} // namespace graze::python
