#include "branch/touched_once.hpp"

#include "grazing/return_map.hpp"
#include "orbit/certify.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr double touching = 1e-6;      // share of the function's size; touches are located far more accurately
constexpr double slow_approach = 1e-4; // share of the typical rate

/// True when a segment ends with a contact of nearly zero speed, or near an extremum of another watched function.
bool may_touch_at_ends(const Shooting& equations, const OrbitEvaluation& at, const Certificate& certificate) {
    for (std::size_t s = 0; s < equations.signature().size(); ++s) {
        const Segment& segment = equations.signature()[s];
        if (segment.end == SegmentEnd::event && !is_identity_transition(equations.system(), segment.index) &&
            !(std::abs(certificate.approach_speeds[s]) > touching * equations.typical_rate(at, s)))
            return true;
    }
    return std::any_of(certificate.end_values.begin(), certificate.end_values.end(), [&](const EndValue& one) {
        return !(std::abs(one.rate) > slow_approach * equations.typical_rate(at, one.segment, one.event));
    });
}

} // namespace

std::optional<CycleMap> TouchedOnce::map(Shooting& equations, const OrbitEvaluation& at, const Certificate& certificate,
                                         std::size_t event) {
    const OrbitMinimum* touch = nullptr;
    for (const OrbitMinimum& one : certificate.minima) {
        if (!(std::abs(one.value) < touching * one.size))
            continue;
        if (touch)
            return std::nullopt;
        touch = &one;
    }
    if (!touch || touch->event != event || may_touch_at_ends(equations, at, certificate))
        return std::nullopt;
    const std::size_t mode = equations.signature()[touch->segment].mode;
    auto functions = functions_.find(mode);
    if (functions == functions_.end())
        functions = functions_.emplace(mode, TouchFunctions(equations.system(), mode, event)).first;
    CycleMap map = cycle_map_of(equations, at, {touch->segment, event, touch->time, false}, functions->second, 0,
                                AskedContacts::rigid);
    if (!map.exists() || map.contact.order != MapOrder::square_root)
        return std::nullopt;
    return map;
}

} // namespace graze
