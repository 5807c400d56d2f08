#include "python/binding.hpp"

PYBIND11_MODULE(_graze, module) {
    using namespace graze::python;
    module.doc() = "The compiled part of the package graze.";
    module.attr("version") = GRAZE_VERSION;
    bind_errors(module);
    bind_expressions(module);
    bind_models(module);
    bind_motions(module);
    bind_results(module);
    bind_studies(module);
}
