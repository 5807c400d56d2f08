#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/design/design_folder.hpp"
#include "graze/layout/drawn_design.hpp"
#include "graze/layout/fabrication_rules.hpp"
#include "graze/layout/gds_stream.hpp"
#include "graze/layout/layout.hpp"
#include "graze/layout/layout_table.hpp"
#include "graze/layout/lumped_model.hpp"
#include "graze/layout/process_recipe.hpp"
#include "graze/layout/process_steps.hpp"
#include "graze/layout/rule_markers.hpp"
#include "graze/layout/verilog_a.hpp"
#include "graze/layout/wafer_tables.hpp"
#include "graze/layout/wafer_yield.hpp"
#include "graze/model/model_file.hpp"
#include "graze/results/table_text.hpp"
#include "python/design_work.hpp"
#include "python/tables.hpp"

#include <filesystem>
#include <optional>
#include <variant>

namespace graze::python {

namespace {

using GivenTexts = std::vector<std::pair<std::string, std::variant<double, std::string>>>;

GivenLengths lengths_of(const GivenTexts& given) {
    GivenLengths lengths;
    for (const auto& [name, value] : given)
        lengths.emplace_back(name, std::holds_alternative<double>(value)
                                       ? std::get<double>(value)
                                       : dimension_of_text(name, std::get<std::string>(value), given_place(name)));
    return lengths;
}

/// A drawing of a device or a wafer, and the file from which it comes.
class HeldLayout {
public:
    /// @param folder with the result of the design, whose drawing is solved for; none: the drawing of the file
    HeldLayout(const std::string& text, const std::string& name, const GivenTexts& given, bool wafer,
               const std::optional<std::string>& folder)
        : text_(text), name_(name), file_(parse_device_file(text, name, lengths_of(given))) {
        if (folder)
            match(*folder);
        layout_ = wafer ? draw_wafer_layout(file_) : draw_device_layout(file_);
        is_wafer_ = wafer;
        findings_ = rule_findings(file_, layout_);
    }

    const DeviceFile& file() const { return file_; }
    const Layout& layout() const { return layout_; }
    const std::vector<RuleFinding>& findings() const { return findings_; }
    Layout wafer() const { return is_wafer_ ? layout_ : draw_wafer_layout(file_); }
    void require_ruled() const { require_rules(file_, findings_); }
    Design design() const { return parse_design(text_, name_); }
    const std::optional<DesignedDevice>& designed() const { return designed_; }

    /// The only kind of device. @throws InputError when there are several
    const DrawnDevice& device() const {
        if (layout_.devices.size() > 1)
            throw InputError("the wafer has " + std::to_string(layout_.devices.size()) +
                                 " devices that differ (wafer.vary), and this is of one device",
                             "draw the device that is meant: layout(..., set={NAME: VALUE})");
        return layout_.devices.front();
    }
    ParameterFile parameters() const {
        ParameterFile parameters = parameters_of(lumped_model_of(device().drawing, file_), model_of(file_));
        parameters.text = "The device of the design " + file_.name + ", after the etch.";
        return parameters;
    }
    Model model() const {
        Model model = model_of(file_);
        for (const auto& [name, value] : parameters().set)
            model.set_parameter(name, value);
        return model;
    }
    std::string gds(std::optional<int> mask) const {
        if (mask)
            return gds_stream(mask_library(layout_, *mask));
        Layout all = layout_;
        add_masks(all);
        return gds_stream(all.library);
    }

private:
    void match(const std::string& folder) {
        const Design own = design();
        require_device_of(own, folder, {"from_design", 0, 0});
        DesignedDevice result{own, read_model((std::filesystem::path(folder) / device_model_name).string()), {}};
        if (result.device.name != own.model.name)
            throw InputError({"from_design", 0, 0},
                             "the device of " + folder + " is one of the model " + result.device.name +
                                 ", and the design has the model " + own.model.name,
                             "name the design from which the folder comes");
        result.matched = match_drawing(file_, result.device);
        file_ = result.matched.file;
        designed_ = std::move(result);
    }

    std::string text_, name_;
    DeviceFile file_;
    Layout layout_;
    bool is_wafer_ = false;
    std::vector<RuleFinding> findings_;
    std::optional<DesignedDevice> designed_;
};

py::list rule_findings(const HeldLayout& self) {
    py::list list;
    for (const RuleFinding& one : self.findings()) {
        py::dict object;
        object["rule"] = one.rule;
        object["value"] = one.value;
        object["limit"] = one.limit;
        object["unit"] = one.unit;
        object["holds"] = one.holds();
        object["part"] = one.part;
        object["device"] = one.device;
        object["x"] = static_cast<double>(one.at.x) / grid_per_micrometre;
        object["y"] = static_cast<double>(one.at.y) / grid_per_micrometre;
        object["text"] = one.text();
        list.append(object);
    }
    return list;
}

/// Polygons of the top cell, or of one mask: layer, datatype, and corners in micrometres.
py::list polygons_of(const HeldLayout& self, std::optional<int> mask) {
    const LayoutLibrary library = mask ? mask_library(self.layout(), *mask) : self.layout().library;
    py::list list;
    for (const PlacedShape& shape : flattened(library, mask ? "MASK_" + std::to_string(*mask) : self.layout().top)) {
        std::vector<double> corners;
        for (const GridPoint& corner : shape.polygon) {
            corners.push_back(static_cast<double>(corner.x) / grid_per_micrometre);
            corners.push_back(static_cast<double>(corner.y) / grid_per_micrometre);
        }
        const auto count = static_cast<py::ssize_t>(corners.size() / 2);
        list.append(py::make_tuple(shape.layer.layer, shape.layer.datatype, array_of(std::move(corners), {count, 2})));
    }
    return list;
}

py::dict lumped_of(const HeldLayout& self) {
    const LumpedModel lumped = lumped_model_of(self.device().drawing, self.file());
    py::dict object;
    object["mass"] = lumped.mass;
    object["stiffness"] = lumped.stiffness;
    object["damping"] = lumped.damping;
    object["area"] = lumped.area;
    object["gap"] = lumped.gap;
    object["stop"] = lumped.stop;
    object["frequency"] = lumped.frequency();
    object["damping_ratio"] = lumped.damping_ratio();
    object["pull_in"] = lumped.pull_in();
    object["squeeze"] = lumped.squeeze;
    object["closure"] = lumped.closure;
    object["stress_per_travel"] = lumped.stress_per_travel;
    return object;
}

const char* material_name(ProcessMaterial material) {
    switch (material) {
    case ProcessMaterial::silicon:
        return "silicon";
    case ProcessMaterial::resist:
        return "resist";
    case ProcessMaterial::epoxy:
        return "epoxy";
    case ProcessMaterial::aluminium:
        break;
    }
    return "aluminium";
}

py::list steps_of(const HeldLayout& self) {
    const Layout device = draw_device_layout(self.file());
    py::list list;
    for (const ProcessStep& step : process_steps(self.file(), device, plane_through_stop(device))) {
        py::list slabs;
        for (const ProcessSlab& slab : step.slabs)
            slabs.append(
                py::make_tuple(std::string(material_name(slab.material)), slab.left, slab.right, slab.low, slab.high));
        list.append(py::make_tuple(step.text, slabs));
    }
    return list;
}

/// Wafers of devices that have been made by simulation.
struct MadeWafers {
    WaferYield found;
    Table facts, devices;
    std::string control, unit;
    std::optional<double> least, greatest;
};

std::shared_ptr<MadeWafers> made_wafers(const HeldLayout& self, const std::string& folder, std::size_t count,
                                        std::uint64_t seed, bool despite_rules, int threads, const py::object& told,
                                        const std::shared_ptr<PartExchange>& parts) {
    auto made = std::make_shared<MadeWafers>();
    attend_design(threads, told, parts, [&](const DesignReportOptions& options) {
        const Layout wafer = self.wafer();
        if (!despite_rules)
            require_rules(self.file(), rule_findings(self.file(), wafer));
        const Design own = self.design();
        const Design design = with_place(own.approach.place, [&] { return design_of_device(own, self.file()); });
        const std::optional<TripPoint> trip =
            locate_trip(design, (std::filesystem::path(folder) / "wafers.sqlite").string(), options);
        if (!trip)
            return; // `attended` throws what has interrupted
        WaferYieldSettings settings;
        settings.wafers = count;
        settings.seed = seed;
        settings.jobs = options.jobs;
        settings.elsewhere = options.elsewhere;
        settings.interrupted = options.interrupted;
        settings.progress = [&](std::size_t devices) { options.progress("device " + std::to_string(devices)); };
        made->found = with_place(design.approach.place,
                                 [&] { return wafer_yield_of(design, self.file(), wafer, *trip, settings); });
        made->facts = wafer_fact_table(made->found, design.model, design.control, count);
        made->devices = wafer_device_table(made->found, wafer, design.model, design.control);
        made->control = design.control;
        made->unit = design.model.parameter_unit(design.control);
        made->least = design.least_usable();
        made->greatest = design.greatest_usable();
    });
    return made;
}

/// Problems of devices, and how many have each.
std::vector<std::pair<std::string, std::size_t>> problems_of(const MadeWafers& self) {
    std::vector<std::pair<std::string, std::size_t>> all = self.found.yield.problems;
    for (const WaferDevice& device : self.found.devices) {
        if (device.problem.empty())
            continue;
        const auto known =
            std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.first == device.problem; });
        if (known == all.end())
            all.emplace_back(device.problem, 1);
        else
            ++known->second;
    }
    return all;
}

std::string json_of(const HeldLayout& layout, const MadeWafers& made, std::size_t count, std::uint64_t seed) {
    WaferYieldSettings settings;
    settings.wafers = count;
    settings.seed = seed;
    return wafer_report_json(layout.file().name, settings, made.facts, made.devices, GRAZE_VERSION);
}

/// What the drawn device does, beside the designed one.
py::dict drawn_of(const HeldLayout& self, const std::string& folder, int threads, const py::object& told,
                  const std::shared_ptr<PartExchange>& parts) {
    if (!self.designed())
        throw InputError(
            "the drawing is not that of a designed device",
            "draw it by layout(..., from_design=FOUND), or by the method layout() of what design() returns");
    std::optional<DrawnDesign> drawn;
    attend_design(threads, told, parts, [&](const DesignReportOptions& options) {
        drawn = drawn_design(*self.designed(), (std::filesystem::path(folder) / "drawn.sqlite").string(), options);
    });
    py::dict object;
    object["table"] = columns_of(drawn->table);
    object["csv"] = csv_text(drawn->table);
    object["met"] = drawn->met;
    object["drawing"] = write_parameter_file(solved_numbers(*self.designed()));
    object["parameters"] = write_parameter_file(drawn_parameters(*self.designed()));
    return object;
}

} // namespace

void bind_layouts(py::module_& module) {
    py::class_<HeldLayout, std::shared_ptr<HeldLayout>>(module, "Layout")
        .def(py::init([](const std::string& text, const std::string& file, const GivenTexts& given, bool wafer,
                         const std::optional<std::string>& folder) {
                 std::shared_ptr<HeldLayout> made;
                 attended([&](const std::function<bool()>&) {
                     made = std::make_shared<HeldLayout>(text, file, given, wafer, folder);
                 });
                 return made;
             }),
             py::arg("text"), py::arg("file"), py::kw_only(), py::arg("given"), py::arg("wafer"),
             py::arg("from_design"))
        .def_property_readonly("name", [](const HeldLayout& self) { return self.file().name; })
        .def_property_readonly("top", [](const HeldLayout& self) { return self.layout().top; })
        .def_property_readonly("devices",
                               [](const HeldLayout& self) {
                                   std::vector<std::string> cells;
                                   for (const DrawnDevice& one : self.layout().devices)
                                       cells.push_back(one.cell);
                                   return cells;
                               })
        .def_property_readonly("matched", [](const HeldLayout& self) { return self.designed().has_value(); })
        .def("table", [](const HeldLayout& self) { return columns_of(layout_table(self.layout(), self.file())); })
        .def_property_readonly("findings", &rule_findings)
        .def("require_ruled", &HeldLayout::require_ruled)
        .def("polygons", &polygons_of, py::arg("mask"))
        .def("lumped", &lumped_of)
        .def("parameters",
             [](const HeldLayout& self) { return std::vector<std::pair<std::string, double>>(self.parameters().set); })
        .def("parameter_text", [](const HeldLayout& self) { return write_parameter_file(self.parameters()); })
        .def("model", [](const HeldLayout& self) { return std::make_shared<HeldModel>(self.model()); })
        .def(
            "gds", [](const HeldLayout& self, std::optional<int> mask) { return py::bytes(self.gds(mask)); },
            py::arg("mask"))
        .def("markers", [](const HeldLayout& self) { return rule_markers(self.findings(), self.layout().top, writer); })
        .def("recipe", [](const HeldLayout& self,
                          const std::vector<std::string>& options) { return recipe_text(self.file(), options); })
        .def("steps", &steps_of)
        .def("verilog_a", [](const HeldLayout& self) { return verilog_a_text(self.model(), self.file().name, writer); })
        .def("wafers", &made_wafers, py::arg("folder"), py::arg("count"), py::kw_only(), py::arg("seed"),
             py::arg("despite_rules"), py::arg("threads"), py::arg("told"),
             py::arg("parts") = std::shared_ptr<PartExchange>())
        .def("wafer_json", &json_of, py::arg("made"), py::arg("count"), py::arg("seed"))
        .def_property_readonly("wafer_radius", [](const HeldLayout& self) { return self.file().wafer.diameter / 2; })
        .def("drawn", &drawn_of, py::arg("folder"), py::kw_only(), py::arg("threads"), py::arg("told"),
             py::arg("parts") = std::shared_ptr<PartExchange>());
    py::class_<MadeWafers, std::shared_ptr<MadeWafers>>(module, "MadeWafers")
        .def("facts", [](const MadeWafers& self) { return columns_of(self.facts); })
        .def("devices", [](const MadeWafers& self) { return columns_of(self.devices); })
        .def("facts_csv", [](const MadeWafers& self) { return csv_text(self.facts); })
        .def("devices_csv", [](const MadeWafers& self) { return csv_text(self.devices); })
        .def_readonly("control", &MadeWafers::control)
        .def_readonly("unit", &MadeWafers::unit)
        .def_readonly("least", &MadeWafers::least)
        .def_readonly("greatest", &MadeWafers::greatest)
        .def_property_readonly("failed", [](const MadeWafers& self) { return self.found.yield.failed; })
        .def_property_readonly("problems", &problems_of)
        .def_property_readonly("linear_deviation", [](const MadeWafers& self) { return self.found.linear_deviation; });
    module.def("mask_layers", [] {
        py::list list;
        for (const MaskLayer layer : all_layers())
            list.append(py::make_tuple(layer.layer, layer.datatype, std::string(layer_text(layer))));
        return list;
    });
}

} // namespace graze::python
