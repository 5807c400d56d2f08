#include "graze/base/input_error.hpp"
#include "graze/design/design_folder.hpp"
#include "graze/design/finished_design.hpp"
#include "graze/layout/verilog_a.hpp"
#include "graze/model/model_file.hpp"
#include "graze/picture/design_page.hpp"
#include "graze/results/table_text.hpp"
#include "python/attended.hpp"
#include "python/design_work.hpp"
#include "python/figures.hpp"
#include "python/tables.hpp"

#include <filesystem>
#include <optional>

namespace graze::python {

namespace {

std::string path_in(const std::string& folder, const char* name) {
    return (std::filesystem::path(folder) / name).string();
}

/// A finished design with its tables.
class ComputedDesign {
public:
    /// @param folder receives the result files of the ways to the trip points
    ComputedDesign(const Design& design, const std::string& folder, const DesignReportOptions& options)
        : finished_(finish_design(
              design, {path_in(folder, "results.sqlite"), [&] { return path_in(folder, "designed.sqlite"); }},
              options)) {
        if (!finished_.interrupted) // otherwise `attended` throws what has interrupted
            tables_ = tables_of(finished_.device, *finished_.trip, finished_.report);
    }

    const Design& design() const { return finished_.device; }
    const DesignReport& report() const { return finished_.report; }
    const std::vector<NamedTable>& tables() const { return tables_; }
    const TripPoint& trip() const { return *finished_.trip; }

    std::string json() const { return report_json(design(), tables_, GRAZE_VERSION); }
    std::string device_text() const { return device_heading(finished_.written) + write_model(model_of_device(trip())); }

    std::vector<std::string> warnings() const { return finished_.warnings(); }

private:
    FinishedDesign finished_;
    std::vector<NamedTable> tables_;
};

std::shared_ptr<ComputedDesign> carried_out_design(const Design& design, const std::string& folder, int threads,
                                                   const py::object& told, const std::shared_ptr<PartExchange>& parts) {
    std::shared_ptr<ComputedDesign> result;
    attend_design(threads, told, parts, [&](const DesignReportOptions& options) {
        result = std::make_shared<ComputedDesign>(design, folder, options);
    });
    return result;
}

py::list dimensions_of(const Design& design) {
    const std::vector<double> values = design.model.parameter_values();
    py::list list;
    for (const DesignDimension& one : design.dimensions) {
        py::dict object;
        object["name"] = one.name;
        object["unit"] = one.unit;
        object["text"] = one.text;
        object["value"] = values[one.parameter.place()];
        object["range"] = py::make_tuple(one.least, one.greatest);
        list.append(object);
    }
    return list;
}

py::list found_wants_of(const DesignReport& report) {
    py::list list;
    if (!report.wishes)
        return list;
    const MetWishes& wishes = *report.wishes;
    for (std::size_t i = 0; i < wishes.found.wants.size(); ++i) {
        const FoundWant& found = wishes.found.wants[i];
        py::dict object;
        object["name"] = wishes.list.wants[i].name;
        object["least"] = wishes.list.wants[i].least;
        object["most"] = wishes.list.wants[i].most;
        object["value"] = found.value;
        object["met"] = found.met;
        object["binds"] = found.binds;
        object["weight"] = found.weight;
        object["violation"] = found.violation;
        list.append(object);
    }
    return list;
}

} // namespace

void bind_designs(py::module_& module) {
    py::class_<Design, std::shared_ptr<Design>>(module, "Design")
        .def_static(
            "parsed",
            [](const std::string& text, const std::string& file) {
                return std::make_shared<Design>(parse_design(text, file));
            },
            py::arg("text"), py::arg("file"), py::call_guard<Unlocked>())
        .def_readonly("name", &Design::name)
        .def_readonly("text", &Design::text)
        .def_readonly("source", &Design::source)
        .def_readonly("control", &Design::control)
        .def_property_readonly("inputs",
                               [](const Design& self) {
                                   return std::vector<std::string>{self.model_path, self.approach.study};
                               })
        .def_property_readonly("model", [](const Design& self) { return std::make_shared<HeldModel>(self.model); })
        .def_property_readonly("dimensions", &dimensions_of)
        .def("compute", &carried_out_design, py::arg("folder"), py::kw_only(), py::arg("threads"), py::arg("told"),
             py::arg("parts") = std::shared_ptr<PartExchange>());
    py::class_<ComputedDesign, std::shared_ptr<ComputedDesign>>(module, "ComputedDesign")
        .def_property_readonly("name", [](const ComputedDesign& self) { return self.design().name; })
        .def_property_readonly("control", [](const ComputedDesign& self) { return self.design().control; })
        .def_property_readonly("dimensions", [](const ComputedDesign& self) { return dimensions_of(self.design()); })
        .def_property_readonly("trip_value", [](const ComputedDesign& self) { return self.report().value; })
        .def_property_readonly(
            "outcome", [](const ComputedDesign& self) { return std::string(class_name(self.report().found.outcome)); })
        .def_property_readonly("outcome_reason", [](const ComputedDesign& self) { return self.report().found.reason; })
        .def_property_readonly("reset_value", [](const ComputedDesign& self) { return self.report().reset.value; })
        .def_property_readonly("wishes",
                               [](const ComputedDesign& self) {
                                   return self.report().wishes
                                              ? std::string(name_of(self.report().wishes->found.outcome))
                                              : std::string();
                               })
        .def_property_readonly("wants", [](const ComputedDesign& self) { return found_wants_of(self.report()); })
        .def_property_readonly("problems",
                               [](const ComputedDesign& self) {
                                   const auto& yield = self.report().yield;
                                   return yield ? yield->problems : decltype(yield->problems)();
                               })
        .def_property_readonly("warnings", &ComputedDesign::warnings)
        .def_property_readonly("table_names",
                               [](const ComputedDesign& self) {
                                   std::vector<std::string> names;
                                   for (const NamedTable& one : self.tables())
                                       names.push_back(one.name);
                                   return names;
                               })
        .def("table", [](const ComputedDesign& self, std::size_t i) { return columns_of(self.tables().at(i).table); })
        .def("csv", [](const ComputedDesign& self, std::size_t i) { return csv_text(self.tables().at(i).table); })
        .def_property_readonly("json", &ComputedDesign::json)
        .def_property_readonly("device_text", &ComputedDesign::device_text)
        .def_property_readonly(
            "device",
            [](const ComputedDesign& self) { return std::make_shared<HeldModel>(model_of_device(self.trip())); })
        .def_property_readonly("has_verilog_a",
                               [](const ComputedDesign& self) { return has_verilog_a(model_of_device(self.trip())); })
        .def("verilog_a",
             [](const ComputedDesign& self) {
                 return verilog_a_text(model_of_device(self.trip()), self.design().name, writer);
             })
        .def("figure", [](const ComputedDesign& self) {
            return object_of(design_page(self.design(), self.trip(), self.report()));
        });
    module.def("shipped_designs", &shipped_designs);
    module.def("shipped_design_text", &shipped_design_text);
}

} // namespace graze::python
