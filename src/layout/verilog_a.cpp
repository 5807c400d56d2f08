#include "graze/layout/verilog_a.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/physical_unit.hpp"
#include "graze/base/with_place.hpp"
#include "graze/layout/lumped_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace graze {

namespace {

struct ModuleParameter {
    const char* name;
    const char* unit;
    const char* range; ///< range in Verilog-A
    const char* text;
    double least, most;
    bool may_be_least; ///< whether the least value itself is allowed
};

constexpr ModuleParameter permittivity{"epsilon", "F/m",    "(0:inf)", "permittivity between the electrodes",
                                       0,         infinity, false};
constexpr std::array circuit_parameters{
    ModuleParameter{"m", "kg", "(0:inf)", "mass, with what moves of its springs", 0, infinity, false},
    ModuleParameter{"f0", "Hz", "(0:inf)", "natural frequency", 0, infinity, false},
    ModuleParameter{"zeta", "", "[0:inf)", "damping ratio", 0, infinity, true},
    ModuleParameter{"area", "m^2", "(0:inf)", "of the capacitor, with its fringe", 0, infinity, false},
    ModuleParameter{"d", "m", "(0:inf)", "gap of the electrodes at rest", 0, infinity, false},
    ModuleParameter{"stop", "m", "(0:inf)", "way to the stops", 0, infinity, false},
    ModuleParameter{"e", "", "[0:1]", "coefficient of restitution of the stops", 0, 1, true},
};

/// Value of a parameter in SI units.
double value_of(const Model& model, const ModuleParameter& one) {
    const auto place = model.find_independent_parameter(one.name);
    if (!place)
        throw InputError(fmt::format("the model {} has no parameter '{}'", model.name, one.name),
                         "name a model of a switch with m, f0, zeta, area, d, stop and e, as mems-switch-device");
    const std::string unit = model.parameter_unit(one.name);
    const auto convert = [&] {
        return converted(model.parameter_values()[place->place()], physical_unit(unit), physical_unit(one.unit));
    };
    const double value =
        with_place({}, convert, fmt::format("'{}' of the model {} has the unit '{}': ", one.name, model.name, unit));
    if (!(value > one.least || (one.may_be_least && value == one.least)) || !(value <= one.most && value < infinity))
        throw InputError(fmt::format("'{}' of the model {} is {:.6g} {}", one.name, model.name, value, one.unit),
                         fmt::format("give a value within {}", one.range));
    return value;
}

/// The suffix avoids all keywords of the language.
std::string module_name(const std::string& name) {
    std::string result = name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) ? "_" : "";
    for (const char letter : name)
        result += std::isalnum(static_cast<unsigned char>(letter)) ? letter : '_';
    return result + "_va";
}

constexpr const char* equations = R"(
    real w0, k, c, damping_of_stop, k_stop, c_stop, q, v, voltage, left, attraction, suspension, contact;

    analog begin
        w0 = 6.283185307179586*f0;
        k = m*w0*w0;
        c = 2*zeta*m*w0;
        damping_of_stop = (e > 0) ? -ln(e)/sqrt(9.869604401089358 + ln(e)*ln(e)) : 1;
        k_stop = m*hardness*w0*hardness*w0;
        c_stop = 2*damping_of_stop*m*hardness*w0;

        q = 1e-6*V(position);
        v = 1e-3*V(velocity);
        voltage = V(fixed, moving);
        left = (d - q > closed) ? d - q : closed;
        attraction = epsilon*area*voltage*voltage/(2*left*left);
        suspension = -c*v - k*q;
        contact = 0;
        if (q < -stop)
            contact = -k_stop*(q + stop) - c_stop*v;
        else if (q > d - closed)
            contact = -k_stop*(q - d + closed) - c_stop*v;

        I(position) <+ ddt(V(position)) - 1e3*V(velocity);
        I(velocity) <+ ddt(V(velocity)) - 1e3*(attraction + suspension + contact)/m;
        I(fixed, moving) <+ ddt(epsilon*area*voltage/left);
        $bound_step(0.01/f0);
    end
endmodule
)";

} // namespace

bool has_verilog_a(const Model& model) {
    return std::all_of(circuit_parameters.begin(), circuit_parameters.end(), [&](const ModuleParameter& one) {
        return model.find_independent_parameter(one.name).has_value();
    });
}

std::string verilog_a_text(const Model& model, const std::string& name, const std::string& generator) {
    const std::string module = module_name(name);
    std::string text = fmt::format(
        R"(// {0}: an electrostatic switch as one mass on a spring, with stops. Written by {1}.
// Verilog-A of the Verilog-AMS Language Reference Manual 2.4, without events; inner unknowns are electrical nodes.
`include "disciplines.vams"

module {2}(fixed, moving);
    inout fixed, moving;
    electrical fixed, moving;      // the electrodes: a voltage between them attracts
    electrical position, velocity; // 1 V is 1 um towards the fixed electrode, and 1 mm/s

)",
        name, generator, module);
    const auto declare = [&](const char* what, const std::string& value, const char* range,
                             const std::string& meaning) {
        text += fmt::format("    parameter real {} = {} from {}; // {}\n", what, value, range, meaning);
    };
    const auto declare_value = [&](const ModuleParameter& one, double value) {
        declare(one.name, fmt::format("{}", value), one.range,
                *one.unit ? fmt::format("{}, {}", one.unit, one.text) : one.text);
    };
    for (const ModuleParameter& one : circuit_parameters)
        declare_value(one, value_of(model, one));
    declare_value(permittivity, model.find_independent_parameter(permittivity.name) ? value_of(model, permittivity)
                                                                                    : vacuum_permittivity);
    declare("hardness", "100", "[1:inf)", "natural frequency on a stop, by f0");
    declare("closed", "0.05*d", "(0:inf)", "m, gap at which the electrodes rest on one another");
    return text + equations;
}

} // namespace graze
