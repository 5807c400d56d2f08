#include "graze/branch/curve_start.hpp"

#include "branch/missed_points.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>

namespace graze {

namespace {

/// Tolerance of multipliers: a double one is known only to the square root of its uncertainty.
constexpr double nearness = 1e-3;

std::size_t multipliers_near(const SpecialPoint& point, double wanted) {
    const auto& all = multipliers_followed(point.solution);
    return static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [&](auto one) { return std::abs(one - wanted) < nearness; }));
}

bool begins_with_pair_on_circle(const SpecialPoint& point) {
    const auto& all = multipliers_followed(point.solution);
    return multipliers_near(point, 1) >= 2 || multipliers_near(point, -1) >= 2 ||
           std::any_of(all.begin(), all.end(),
                       [](auto one) { return one.imag() > nearness && std::abs(std::abs(one) - 1) < nearness; });
}

/// Returns the touch inside an arc, which points of other types on curves of touches have too; empty if there is none.
std::optional<OrbitMinimum> touch_of(const SpecialPoint& point) {
    constexpr double zero = 1e-9; // share of the function's size along the arc
    std::optional<OrbitMinimum> lowest;
    for (const OrbitMinimum& one : point.solution.certificate.minima)
        if (std::abs(one.value) <= zero * one.size && (!lowest || std::abs(one.value) < std::abs(lowest->value)))
            lowest = one;
    return lowest;
}

/// The same for equilibria. A double eigenvalue 0 is known only to the square root of its uncertainty.
bool equilibrium_satisfies(const SpecialPoint& point, PointType type) {
    constexpr double share = 1e-5; // of the largest eigenvalue
    double largest = 0;
    for (const auto one : point.solution.eigenvalues)
        largest = std::max(largest, std::abs(one));
    const auto any = [&](const auto& has) { return std::ranges::any_of(point.solution.eigenvalues, has); };
    if (type == PointType::fold)
        return point.type == PointType::takens_bogdanov ||
               any([&](auto one) { return std::abs(one) <= share * largest; });
    return type == PointType::hopf &&
           (point.type == PointType::takens_bogdanov ||
            any([&](auto one) { return one.imag() > share * largest && std::abs(one.real()) <= share * largest; }));
}

bool satisfies(const SpecialPoint& point, PointType type) {
    if (is_homoclinic(point.solution.orbit.signature))
        return type == PointType::homoclinic;
    if (point.type == type || point.solution.orbit.cycle) // of which the multipliers are not its own
        return point.type == type;
    if (is_rest(point.solution.orbit.signature))
        return equilibrium_satisfies(point, type);
    const bool half = point.solution.orbit.symmetry.has_value();
    switch (type) {
    case PointType::fold:
        return multipliers_near(point, 1) >= 1;
    case PointType::flip:
        return !half && multipliers_near(point, -1) >= 1;
    case PointType::asymmetry:
        return half && multipliers_near(point, -1) >= 1;
    case PointType::torus:
        return begins_with_pair_on_circle(point);
    case PointType::grazing:
        return point.type == PointType::double_grazing || touch_of(point);
    default:
        return false; // other conditions are known for points of their own type only
    }
}

std::string quoted(const std::vector<PointType>& types) {
    std::vector<std::string> names;
    for (const PointType type : types)
        names.push_back(fmt::format("\"{}\"", short_name(type)));
    return fmt::format("{}", fmt::join(names, ", "));
}

} // namespace

std::string multipliers_in_words(const SpecialPoint& point) {
    const bool homoclinic = is_homoclinic(point.solution.orbit.signature),
               rests = is_rest(point.solution.orbit.signature);
    const auto& all = rests || homoclinic ? point.solution.eigenvalues : multipliers_followed(point.solution);
    if (all.empty() && number_of_multipliers(point.solution) > 0)
        return fmt::format("all its multipliers lie within {:.3g}", point.solution.others_within);
    if (all.empty())
        return "its multipliers are not defined, as where a contact has no speed";
    std::vector<std::string> texts;
    for (const std::complex<double> one : all)
        texts.push_back(one.imag() == 0 ? fmt::format("{:.6g}", one.real())
                                        : fmt::format("{:.6g}{:+.6g}i", one.real(), one.imag()));
    return fmt::format("{} are {}",
                       homoclinic                   ? "the eigenvalues of its saddle"
                       : rests                      ? "its eigenvalues"
                       : point.solution.orbit.cycle ? "the multipliers of its cycle"
                                                    : "its multipliers",
                       fmt::join(texts, ", "));
}

std::vector<PointType> curves_at(const SpecialPoint& point) {
    std::vector<PointType> types;
    for (const PointKind& kind : point_kinds())
        if (kind.may_be_kept && satisfies(point, kind.type))
            types.push_back(kind.type);
    return types;
}

SpecialPoint as_type(const SpecialPoint& point, PointType type) {
    const std::vector<PointType> known = curves_at(point);
    if (std::find(known.begin(), known.end(), type) == known.end()) {
        std::vector<std::string_view> kept;
        for (const PointKind& kind : point_kinds())
            if (kind.may_be_kept)
                kept.push_back(kind.short_name);
        const std::string has = kind_of(type).limits && type != PointType::grazing
                                    ? "that is known of points of its own type only"
                                    : multipliers_in_words(point);
        throw InputError(fmt::format("the point of type {} ({}) is no {}: {}", short_name(point.type),
                                     name_of(point.type), name_of(type), has),
                         known.empty()
                             ? fmt::format("no curve begins there: choose a point of type {}", fmt::join(kept, ", "))
                             : fmt::format("curves that begin there are {}", quoted(known)));
    }
    if (const auto touch = touch_of(point); type == PointType::grazing && !is_grazing(point.type) && touch)
        return grazing_at(point, {touch->segment, touch->event, touch->time, false});
    SpecialPoint result = point;
    result.type = type;
    return result;
}

} // namespace graze
