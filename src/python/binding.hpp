#pragma once

#include "graze/model/model.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace graze {
class System;
}

/// What the Python module needs in C++: `_graze`, on which the package `graze` (python/graze) stands. Nothing here is
/// public; the package has the documented functions.
namespace graze::python {

namespace py = pybind11;

/// A model, and what it is compiled to once that is needed.
struct HeldModel {
    explicit HeldModel(Model of_model) : model(std::move(of_model)) {}
    Model model;
    /// Compiled at the first call after a change; to be called with the interpreter's lock.
    std::shared_ptr<const System> system();
    /// To be called when an expression of the model, and not only a parameter's value, has changed.
    void changed() { system_.reset(); }

private:
    std::shared_ptr<const System> system_;
};

/// A numpy array that owns the numbers, without a copy. @param shape empty: one axis
template <class Number>
py::array_t<Number> array_of(std::vector<Number> numbers, std::vector<py::ssize_t> shape = {}) {
    if (shape.empty())
        shape = {static_cast<py::ssize_t>(numbers.size())};
    auto kept = std::make_unique<std::vector<Number>>(std::move(numbers));
    auto* const vector = kept.get();
    const py::capsule owner(kept.release(), [](void* one) { delete static_cast<std::vector<Number>*>(one); });
    return py::array_t<Number>(std::move(shape), vector->data(), owner);
}

// Each adds its part to the module.
void bind_analyses(py::module_& module);
void bind_designs(py::module_& module);
void bind_errors(py::module_& module);
void bind_experiments(py::module_& module);
void bind_expressions(py::module_& module);
void bind_figures(py::module_& module);
void bind_layouts(py::module_& module);
void bind_models(py::module_& module);
void bind_motions(py::module_& module);
void bind_parts(py::module_& module);
void bind_records(py::module_& module);
void bind_results(py::module_& module);
void bind_studies(py::module_& module);
void bind_trips(py::module_& module);
/// To be called last.
void forbid_raw_objects(py::module_& module);

} // namespace graze::python
