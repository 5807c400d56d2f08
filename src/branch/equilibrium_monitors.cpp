#include "branch/equilibrium_monitors.hpp"

#include "base/concatenated.hpp"
#include "base/special_numbers.hpp"

#include <cmath>
#include <utility>

namespace graze {

EquilibriumMonitors::EquilibriumMonitors(const System& system, std::vector<Monitor> monitors)
    : system_(system), monitors_(std::move(monitors)) {
    for (const Monitor& monitor : monitors_) {
        const bool has_value = monitor.kind != Monitor::Kind::duration && monitor.kind != Monitor::Kind::multiplier;
        functions_.push_back(has_value ? system.with_gradient(monitor.expression) : Function());
    }
}

std::vector<double> EquilibriumMonitors::operator()(const Orbit& orbit) const {
    const std::vector<double> inputs = concatenated(orbit.starts[0], orbit.parameters);
    std::vector<double> values;
    for (std::size_t m = 0; m < monitors_.size(); ++m) {
        const Monitor::Kind kind = monitors_[m].kind;
        const double value = kind == Monitor::Kind::duration     ? 0
                             : kind == Monitor::Kind::multiplier ? not_a_number
                             : monitors_[m].in_modes.empty()
                                 ? functions_[m](inputs)[0]
                                 : system_.with_gradient(monitors_[m].in_modes.at(orbit.signature[0].mode))(inputs)[0];
        values.push_back(kind == Monitor::Kind::norm ? std::abs(value) : value);
    }
    return values;
}

} // namespace graze
