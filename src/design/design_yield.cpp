#include "design/design_yield.hpp"

namespace graze {

YieldSettings yield_settings_of(const Design& design, const Orbit& orbit) {
    YieldSettings settings;
    for (const DesignDimension& one : design.dimensions)
        if (one.tolerance)
            settings.tolerances.push_back(one.tolerance->at(one.parameter, orbit.parameters[one.parameter.place()]));
    settings.devices = design.yield.devices;
    settings.seed = design.yield.seed;
    settings.least = design.least_usable();
    settings.greatest = design.greatest_usable();
    return settings;
}

} // namespace graze
