#include "graze/branch/impacting_curve.hpp"

#include "branch/grazing_switch.hpp"
#include "graze/base/input_error.hpp"
#include "graze/branch/curve_start.hpp"
#include "graze/grazing/cycle_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Returns the curve types whose sum of projections vanishes at a touch.
std::vector<PointType> vanishing_sums(const System& system, const SpecialPoint& touch, PointType flips) {
    constexpr double zero = 1e-7; // share of the period; located points are far more accurate
    const CycleMap map =
        cycle_map(system, touch.solution.orbit, {touch.segment, touch.event, touch.time, touch.at_end});
    if (!map.exists() || map.contact.order != MapOrder::square_root)
        return {};
    std::vector<PointType> types;
    for (const int sign : {1, -1})
        if (std::abs(map.sum_of_projections(sign)) < zero * map.time)
            types.push_back(sign > 0 ? PointType::fold : flips);
    return types;
}

} // namespace

std::vector<PointType> impacting_curves_at(const System& system, const SpecialPoint& point) {
    const PointType flips = point.solution.orbit.symmetry ? PointType::asymmetry : PointType::flip;
    if (point.type == PointType::fold_degenerate)
        return {PointType::fold};
    if (point.type == PointType::flip_degenerate)
        return {flips};
    if (point.type == PointType::sensitivity)
        return vanishing_sums(system, as_type(point, PointType::grazing), flips);
    return {};
}

SpecialPoint on_impacting_curve(const System& system, const SpecialPoint& point, PointType type,
                                const BranchSettings& settings) {
    const std::vector<PointType> known = impacting_curves_at(system, point);
    if (std::find(known.begin(), known.end(), type) == known.end())
        throw InputError(fmt::format("no curve of points of type {} ({}) of orbits with a contact more ends at the "
                                     "point of type {} ({})",
                                     short_name(type), name_of(type), short_name(point.type), name_of(point.type)),
                         "choose a point of type DF, DP or VS on a curve of touches");
    const SpecialPoint touch = as_type(point, PointType::grazing);
    SpecialPoint result = touch;
    result.type = type;
    result.detail = "where a contact has no speed";
    result.solution = {};
    result.solution.orbit = with_contact_of_no_speed(system, touch, settings);
    return result;
}

} // namespace graze
