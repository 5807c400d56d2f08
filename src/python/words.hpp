#pragma once

#include "python/binding.hpp"

#include <string>

namespace graze::python {

/// Reads a keyword argument if it is given. @return whether it is
/// @throws TypeError of Python, naming the argument, for a value of another type
template <class Value>
bool read_word(const py::dict& words, const char* name, Value& value) {
    PyObject* const item = PyDict_GetItemString(words.ptr(), name);
    if (!item)
        return false;
    try {
        value = py::reinterpret_borrow<py::object>(item).cast<Value>();
    } catch (const py::cast_error&) {
        throw py::type_error(std::string(name) + " is " + py::repr(item).cast<std::string>());
    }
    return true;
}

} // namespace graze::python
