#include "python/binding.hpp"

namespace graze::python {

namespace {

std::vector<py::object> classes_of(const py::module_& module) {
    std::vector<py::object> classes;
    for (const auto& [name, object] : module.attr("__dict__").cast<py::dict>())
        if (PyType_Check(object.ptr()))
            classes.push_back(py::reinterpret_borrow<py::object>(object));
    return classes;
}

/// pybind11 takes an object that was made by `__new__` alone for a complete one, and then uses memory that was never
/// written.
void forbid_new_alone(const std::vector<py::object>& classes) {
    const py::cpp_function refuse(
        [](const py::args& arguments, const py::kwargs& /*words*/) -> py::object {
            throw py::type_error("objects of " + py::str(arguments[0]).cast<std::string>() +
                                 " are not made by __new__ alone");
        },
        py::name("__new__"));
    // Of all types first, since what is set in a class changes those that are derived from it.
    std::vector<newfunc> makers;
    for (const py::object& one : classes)
        makers.push_back(reinterpret_cast<PyTypeObject*>(one.ptr())->tp_new);
    for (const py::object& one : classes)
        one.attr("__new__") = py::staticmethod(refuse); // for `__new__`, and for classes derived in Python
    for (std::size_t i = 0; i < classes.size(); ++i) {
        auto* const type = reinterpret_cast<PyTypeObject*>(classes[i].ptr());
        type->tp_new = makers[i]; // for calls of the class, which are complete
        PyType_Modified(type);
    }
}

/// The oldest protocols of pickles call a base class of pybind11's own, of which there are no objects: that ends the
/// process. Later ones make an object by `__new__` alone.
void forbid_pickles(const std::vector<py::object>& classes) {
    for (const py::object& one : classes)
        if (!one.attr("__dict__").contains("__reduce__"))
            one.attr("__reduce__") = py::cpp_function(
                [](const py::object& self) -> py::object {
                    throw py::type_error("objects of " + py::str(py::type::of(self)).cast<std::string>() +
                                         " can neither be copied nor pickled; "
                                         "copy or pickle the object of graze that holds it");
                },
                py::name("__reduce__"), py::is_method(one));
}

PyTypeObject* base_of_all() {
    return reinterpret_cast<PyTypeObject*>(py::detail::get_internals().instance_base);
}

/// The base class has no objects: pybind11 ends the process where one is made. Other modules derive from it too.
PyObject* new_but_of_base(PyTypeObject* type, PyObject* arguments, PyObject* words) {
    if (type != base_of_all())
        return py::detail::pybind11_object_new(type, arguments, words);
    PyErr_SetString(PyExc_TypeError, "the base class of compiled objects has no objects");
    return nullptr;
}

} // namespace

void forbid_raw_objects(py::module_& module) {
    const std::vector<py::object> classes = classes_of(module);
    forbid_new_alone(classes);
    forbid_pickles(classes);
    base_of_all()->tp_new = &new_but_of_base;
}

} // namespace graze::python
