#include "program/layout_model.hpp"

#include "graze/base/input_error.hpp"
#include "graze/layout/lumped_model.hpp"
#include "graze/layout/rule_markers.hpp"
#include "graze/layout/verilog_a.hpp"
#include "program/output_file.hpp"

#include <fmt/format.h>

namespace graze {

void add_lumped_rows(Table& table, const DeviceFile& file, const DrawnDevice& device) {
    const LumpedModel lumped = lumped_model_of(device.drawing, file);
    const auto add = [&](const char* what, double value, const char* unit) {
        table.add(device.cell);
        table.add(what);
        table.add(value);
        table.add(unit);
    };
    constexpr double micro = 1e-6, nano = 1e-9, mega = 1e6;
    add("model: mass", lumped.mass / nano, "ug");
    add("model: stiffness", lumped.stiffness, "N/m");
    add("model: stiffness, were the mass rigid", lumped.rigid_mass, "N/m");
    add("model: stiffness, were all but beams rigid", lumped.stiff_trusses, "N/m");
    add("model: natural frequency", lumped.frequency(), "Hz");
    add("model: damping ratio", lumped.damping_ratio(), "");
    add("model: damping by the electrodes' gas", lumped.electrode_film / micro, "uN s/m");
    add("model: damping by the stops' gas", lumped.stop_films / micro, "uN s/m");
    add("model: damping by the chamber's gas", lumped.chamber_film / micro, "uN s/m");
    add("model: squeeze number", lumped.squeeze, "");
    add("model: area with fringe", lumped.area / (micro * micro), "um^2");
    add("model: gap of the electrodes", lumped.gap / micro, "um");
    add("model: way to the stops", lumped.stop / micro, "um");
    add("model: snap-through at rest", lumped.pull_in(), "V");
    add("model: stress at the stops", lumped.stress_per_travel * lumped.stop / mega, "MPa");
    add("model: stress at closed electrodes", lumped.stress_per_travel * lumped.closure / mega, "MPa");
}

void write_device_parameters(const DeviceFile& file, const DrawnDevice& device, const std::string& path) {
    ParameterFile parameters = parameters_of(lumped_model_of(device.drawing, file), model_of(file));
    parameters.text = fmt::format("The device of the design {}, after the etch.", file.name);
    write_file(path, write_parameter_file(parameters));
}

void write_verilog_a(const DeviceFile& file, const DrawnDevice& device, const std::string& path) {
    Model model = model_of(file);
    for (const auto& [name, value] : parameters_of(lumped_model_of(device.drawing, file), model).set)
        model.set_parameter(name, value);
    write_file(path, verilog_a_text(model, file.name, "graze " GRAZE_VERSION));
}

bool check_rules(const DeviceFile& file, const Layout& layout, bool despite, const std::string& markers,
                 const Console& console) {
    const std::vector<RuleFinding> findings = rule_findings(file, layout);
    if (!markers.empty()) // before they are refused: markers tell where
        write_file(markers, rule_markers(findings, layout.top, "graze " GRAZE_VERSION));
    if (!despite)
        require_rules(file, findings);
    bool all = true;
    for (const RuleFinding& one : findings)
        if (!one.holds()) {
            all = false;
            console.err << fmt::format("graze: rule {}\n", one.text());
        }
    return all;
}

} // namespace graze
