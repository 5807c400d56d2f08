#include "branch/equilibrium_monitors.hpp"

#include "base/concatenated.hpp"
#include "base/special_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

EquilibriumMonitors::EquilibriumMonitors(const System& system, std::vector<Monitor> monitors)
    : monitors_(std::move(monitors)) {
    for (const Monitor& monitor : monitors_) {
        std::vector<Function>& own = functions_.emplace_back();
        if (monitor.kind == Monitor::Kind::duration || monitor.kind == Monitor::Kind::multiplier)
            continue;
        const std::size_t count = std::max(monitor.in_modes.size(), std::size_t{1});
        for (std::size_t mode = 0; mode < count; ++mode)
            own.push_back(system.with_gradient(monitor.expression_in(mode)));
    }
}

std::vector<double> EquilibriumMonitors::operator()(const Orbit& orbit) const {
    const std::vector<double> inputs = concatenated(orbit.starts[0], orbit.parameters);
    std::vector<double> values;
    for (std::size_t m = 0; m < monitors_.size(); ++m) {
        const Monitor::Kind kind = monitors_[m].kind;
        const double value = kind == Monitor::Kind::duration     ? 0
                             : kind == Monitor::Kind::multiplier ? not_a_number
                                                                 : function(m, orbit.signature[0].mode)(inputs)[0];
        values.push_back(kind == Monitor::Kind::norm ? std::abs(value) : value);
    }
    return values;
}

} // namespace graze
