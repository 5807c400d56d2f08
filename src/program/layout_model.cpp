#include "program/layout_outputs.hpp"

#include "graze/base/input_error.hpp"
#include "graze/layout/lumped_model.hpp"
#include "graze/layout/rule_markers.hpp"
#include "graze/layout/verilog_a.hpp"
#include "program/output_file.hpp"

#include <fmt/format.h>

namespace graze {

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
    if (!markers.empty()) // before require_rules throws: the markers show where rules are broken
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
