#pragma once

#include "graze/picture/figure.hpp"
#include "python/binding.hpp"

namespace graze::python {

/// A figure as an object of Python (class `_graze.Figure`), which knows its data and where texts and labels have room.
py::object object_of(Figure figure);

} // namespace graze::python
