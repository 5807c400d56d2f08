#include "graze/flow/system.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/model/named_value.hpp"
#include "graze/results/model_findings.hpp"
#include "graze/results/model_table.hpp"
#include "graze/symbolic/transform.hpp"
#include "python/attended.hpp"
#include "python/tables.hpp"

namespace graze::python {

std::shared_ptr<const System> HeldModel::system() {
    if (!system_)
        system_ = std::make_shared<const System>(model);
    return system_;
}

namespace {

std::shared_ptr<HeldModel> held(Model model) {
    return std::make_shared<HeldModel>(std::move(model));
}

py::list parameter_list(const HeldModel& self) {
    py::list list;
    for (const Parameter& one : self.model.parameters) {
        py::dict item;
        item["name"] = one.name;
        item["unit"] = one.unit;
        item["text"] = one.text;
        item["expression"] = one.expression ? py::object(py::str(to_string(*one.expression))) : py::none();
        list.append(item);
    }
    return list;
}

py::list states_of(const HeldModel& self) {
    py::list list;
    for (const State& one : self.model.states) {
        py::dict item;
        item["name"] = one.name;
        item["unit"] = one.unit;
        item["text"] = one.text;
        item["initial"] = to_string(one.initial);
        item["period"] = one.period ? py::object(py::str(to_string(*one.period))) : py::none();
        item["drifting"] = one.drifting;
        list.append(item);
    }
    return list;
}

template <class Item>
py::list names_and_texts(const std::vector<Item>& items) {
    py::list list;
    for (const Item& one : items)
        list.append(py::make_tuple(one.name, one.text));
    return list;
}

py::list quantities_of(const HeldModel& self) {
    py::list list;
    for (const Quantity& one : self.model.quantities)
        list.append(py::make_tuple(one.name, one.text, one.unit, to_string(one.value)));
    return list;
}

py::list conserved_of(const HeldModel& self) {
    py::list list;
    for (const ConservedQuantity& one : self.model.conserved)
        list.append(py::make_tuple(one.name, one.text, one.unit));
    return list;
}

py::list transitions_of(const HeldModel& self) {
    py::list list;
    for (const Transition& one : self.model.transitions)
        list.append(py::make_tuple(one.label, self.model.modes[one.mode].name, self.model.events[one.event].name,
                                   self.model.jumps[one.jump].name));
    return list;
}

/// Pairs of the part that a warning is about and its text.
py::list findings_of(const HeldModel& self) {
    const Model copy = self.model; // the thread does not see what becomes of the model
    std::vector<ModelWarning> warnings;
    attended([&](const std::function<bool()>&) { warnings = model_findings(copy); });
    py::list list;
    for (const ModelWarning& one : warnings)
        list.append(py::make_tuple(one.part, one.text));
    return list;
}

} // namespace

void bind_models(py::module_& module) {
    py::class_<HeldModel, std::shared_ptr<HeldModel>>(module, "Model")
        .def_static(
            "parsed", [](const std::string& text, const std::string& file) { return held(parse_model(text, file)); },
            py::arg("text"), py::arg("file"), py::call_guard<Unlocked>())
        .def_static(
            "loaded", [](const std::string& name_or_path) { return held(load_model(name_or_path)); },
            py::arg("name_or_path"), py::call_guard<Unlocked>())
        .def("copied", [](const HeldModel& self) { return held(self.model); })
        .def("text", [](const HeldModel& self) { return write_model(self.model); })
        .def_property_readonly("name", [](const HeldModel& self) { return self.model.name; })
        .def_property_readonly("description", [](const HeldModel& self) { return self.model.text; })
        .def_property_readonly("source", [](const HeldModel& self) { return self.model.source; })
        .def_property_readonly("time_unit", [](const HeldModel& self) { return self.model.time_unit; })
        .def_property_readonly("states", &states_of)
        .def_property_readonly("parameters", &parameter_list)
        .def_property_readonly("modes", [](const HeldModel& self) { return names_and_texts(self.model.modes); })
        .def_property_readonly("events", [](const HeldModel& self) { return names_and_texts(self.model.events); })
        .def_property_readonly("jumps", [](const HeldModel& self) { return names_and_texts(self.model.jumps); })
        .def_property_readonly("sections", [](const HeldModel& self) { return names_and_texts(self.model.sections); })
        .def_property_readonly("symmetries",
                               [](const HeldModel& self) { return names_and_texts(self.model.symmetries); })
        .def_property_readonly("quantities", &quantities_of)
        .def_property_readonly("conserved", &conserved_of)
        .def_property_readonly("transitions", &transitions_of)
        .def_property_readonly("definitions",
                               [](const HeldModel& self) { return names_and_texts(self.model.definitions); })
        .def("parameter_values", [](const HeldModel& self) { return all_parameter_values(self.model); })
        .def("independent_parameters", [](const HeldModel& self) { return self.model.independent_parameters(); })
        .def("set_parameter",
             [](HeldModel& self, const std::string& name, double value) { self.model.set_parameter(name, value); })
        .def("set_initial",
             [](HeldModel& self, const std::string& name, double value) {
                 self.model.set_initial(name, value);
                 self.changed();
             })
        .def_property(
            "initial_mode", [](const HeldModel& self) { return self.model.modes[self.model.initial_mode].name; },
            [](HeldModel& self, const std::string& name) { self.model.set_initial_mode(name); })
        .def("initial_state", [](const HeldModel& self) { return self.model.initial_state(); })
        .def("periods", [](const HeldModel& self) { return self.model.periods(); })
        .def(
            "value_of",
            [](const HeldModel& self, const std::string& text, const std::string& called) {
                return value_of_text(self.model, text, {called, 0, 0});
            },
            py::arg("text"), py::arg("called"))
        .def("findings", &findings_of)
        .def("listing", [](const HeldModel& self) { return model_listing(self.model); })
        .def("table", [](const HeldModel& self) { return columns_of(model_table(self.model)); });

    module.def("shipped_models", [] {
        py::list list;
        for (const CatalogueEntry& one : catalogue())
            list.append(py::make_tuple(one.name, one.summary));
        return list;
    });
}

} // namespace graze::python
