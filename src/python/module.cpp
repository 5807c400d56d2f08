#include "python/binding.hpp"

PYBIND11_MODULE(_graze, module) {
    using namespace graze::python;
    module.doc() = "The compiled part of the package graze.";
    module.attr("version") = GRAZE_VERSION;
    bind_errors(module);
    bind_parts(module); // before what is given some
    bind_analyses(module);
    bind_designs(module);
    bind_experiments(module);
    bind_expressions(module);
    bind_figures(module);
    bind_layouts(module);
    bind_models(module);
    bind_motions(module);
    bind_records(module);
    bind_results(module);
    bind_studies(module);
    bind_trips(module);
    forbid_raw_objects(module);
}
