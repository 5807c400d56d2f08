#include "python/binding.hpp"

namespace graze::python {

/// pybind11 takes an object that was made by `__new__` alone for a complete one, and then uses memory that was never
/// written.
void forbid_raw_objects(py::module_& module) {
    const py::cpp_function refuse(
        [](const py::args& arguments, const py::kwargs& /*words*/) -> py::object {
            throw py::type_error("objects of " + py::str(arguments[0]).cast<std::string>() +
                                 " are not made by __new__ alone");
        },
        py::name("__new__"));
    // Of all types first, since what is set in a class changes those that are derived from it.
    std::vector<std::pair<py::object, newfunc>> types;
    for (const auto& [name, object] : module.attr("__dict__").cast<py::dict>())
        if (PyType_Check(object.ptr()))
            types.emplace_back(py::reinterpret_borrow<py::object>(object),
                               reinterpret_cast<PyTypeObject*>(object.ptr())->tp_new);
    for (const auto& [object, makes] : types)
        object.attr("__new__") = py::staticmethod(refuse); // for `__new__`, and for classes derived in Python
    for (const auto& [object, makes] : types) {
        auto* const type = reinterpret_cast<PyTypeObject*>(object.ptr());
        type->tp_new = makes; // for calls of the class, which are complete
        PyType_Modified(type);
    }
}

} // namespace graze::python
