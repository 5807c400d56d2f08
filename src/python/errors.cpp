#include "graze/base/input_errors.hpp"
#include "graze/base/printable.hpp"
#include "python/binding.hpp"

#include <exception>

namespace graze::python {

namespace {

/// Texts that messages quote come from anywhere: what is not UTF-8 in them cannot be a text of Python.
py::object error_of(const Error& error) {
    return py::module_::import("graze._errors")
        .attr("made")(std::string(name_of(error.kind())), printable(error.problem()), printable(error.remedy()),
                      printable(error.place().file), error.place().line, error.place().column);
}

void raise(const Error& error) {
    try {
        py::object made = error_of(error);
        if (const auto* several = dynamic_cast<const InputErrors*>(&error)) {
            py::list all = made.attr("all"); // this one, which is the first
            for (std::size_t i = 1; i < several->all().size(); ++i)
                all.append(error_of(several->all()[i]));
        }
        PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(made.ptr())), made.ptr());
    } catch (py::error_already_set& other) {
        other.restore();
    }
}

} // namespace

void bind_errors(py::module_& /*module*/) {
    // NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 gives the type
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown)
                std::rethrow_exception(thrown);
        } catch (const Error& error) {
            raise(error);
        }
    });
}

} // namespace graze::python
