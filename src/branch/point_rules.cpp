#include "branch/point_rules.hpp"

#include "orbit/half_orbit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

int rank(const SpecialPoint& point) {
    switch (point.type) {
    case PointType::grazing: {
        const Orbit& orbit = point.solution.orbit;
        const double duration = std::abs(orbit.durations[point.segment]);
        // An arc that vanishes has the contact before it to thank for that.
        constexpr double almost_nothing = 1e-4;
        if (point.at_end)
            return duration > almost_nothing * orbit.period() ? 1 : 2;
        // A minimum that comes or goes through an end of its arc does so because a contact has lost its speed.
        constexpr double at_edge = 1e-6;
        return point.time > at_edge * duration && point.time < (1 - at_edge) * duration ? 0 : 2;
    }
    case PointType::vanishing:
        return 3;
    case PointType::two_events:
        return 4;
    case PointType::guard:
        return 5;
    default:
        return -1;
    }
}

namespace {

/// By how much the parameter changes over the last step.
double length_of_step(BranchState& state) {
    const std::size_t place = state.problem().parameter_place();
    return std::abs(state.continuation().point().u[place] - state.continuation().previous().u[place]);
}

} // namespace

bool is_what_it_seems(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    const Model& model = state.model();
    const BranchSettings& settings = state.settings();
    const auto& events = model.events;
    switch (special.type) {
    case PointType::torus: {
        const auto& multipliers = special.solution.half_multipliers.empty() ? special.solution.multipliers
                                                                            : special.solution.half_multipliers;
        return special.located && std::any_of(multipliers.begin(), multipliers.end(), [](auto one) {
                   return std::abs(one.imag()) > 1e-6 && std::abs(std::abs(one) - 1) < 1e-5;
               });
    }
    case PointType::fold:
    case PointType::flip:
    case PointType::asymmetry:
    case PointType::branch_point:
        return special.located;
    case PointType::grazing:
        special.detail = fmt::format("{}{}", events[special.event].name, special.at_end ? ", no approach speed" : "");
        return true;
    case PointType::two_events: {
        // Two events of which the other one does not fall is a touch at the very end of an arc.
        const double speed = *std::max_element(special.solution.certificate.approach_speeds.begin(),
                                               special.solution.certificate.approach_speeds.end());
        if (std::abs(test.rate) < 1e-6 * std::max(speed, std::abs(test.rate) + 1e-300)) {
            special.type = PointType::grazing;
            special.time = special.solution.orbit.durations[special.segment];
        }
        special.detail = events[special.event].name;
        return true;
    }
    case PointType::bound:
    case PointType::crossing: {
        // Round-off would leave the bound on the one side or the other.
        for (const auto& bound : {settings.least, settings.greatest})
            if (bound && !test.monitor && std::abs(special.parameter - *bound) < 1e-9 * length_of_step(state))
                special.parameter = special.solution.orbit.parameters[settings.parameter] = *bound;
        const std::string name =
            test.monitor ? settings.monitors[*test.monitor].name : model.independent_parameters()[settings.parameter];
        const double value = test.monitor ? special.monitors[*test.monitor] : special.parameter;
        special.detail = fmt::format(
            "{} = {:.10g}", name,
            special.type == PointType::crossing ? settings.monitors[*test.monitor].crossings[test.crossing] : value);
        return special.located;
    }
    case PointType::vanishing:
        special.detail = fmt::format("segment {}", special.segment + 1);
        return true;
    case PointType::guard:
        special.detail = fmt::format("after {}", end_name(model, special.solution.orbit.signature[special.segment]));
        return true;
    default:
        return true;
    }
}

bool is_degenerate(BranchState& state, const Orbit& orbit, double same) {
    const Model& model = state.model();
    if (orbit.symmetry)
        return false;
    if (half_of(state.problem().equations(), orbit, same))
        return true;
    const std::size_t half = orbit.segments() / 2;
    if (orbit.segments() % 2 != 0)
        return false;
    for (std::size_t k = 0; k < half; ++k) {
        if (orbit.signature[k] != orbit.signature[k + half])
            return false;
        for (const std::size_t i : state.problem().evaluation().active)
            if (!model.states[i].period &&
                std::abs(orbit.starts[k][i] - orbit.starts[k + half][i]) > same * state.problem().scales()[i])
                return false;
    }
    return true;
}

bool is_degenerate(BranchState& state, const SpecialPoint& special) {
    constexpr double same = 1e-3;
    return special.type == PointType::branch_point && is_degenerate(state, special.solution.orbit, same);
}

void merge(std::vector<SpecialPoint>& found, double length) {
    constexpr double same_place = 1e-6;
    for (std::size_t i = 0; i < found.size(); ++i)
        for (std::size_t j = i + 1; j < found.size();) {
            const int a = rank(found[i]), b = rank(found[j]);
            const bool same_type = found[i].type == found[j].type;
            if (std::abs(found[i].arclength - found[j].arclength) > same_place * length ||
                ((a < 0 || b < 0) && !same_type)) {
                ++j;
                continue;
            }
            if (b < a)
                std::swap(found[i], found[j]);
            found.erase(found.begin() + static_cast<std::ptrdiff_t>(j));
        }
}

namespace {

/// Whether the equations are singular at a point of the last step, as they are where a contact vanishes by taking no
/// time: known from their determinant there, against those at the ends of the step.
bool is_singular_at(BranchState& state, const SpecialPoint& point) {
    constexpr double zero = 1e-3; // share of what it is at the ends
    Continuation& continuation = state.continuation();
    const double from = state.arclength(continuation.previous().arclength),
                 length = state.arclength(continuation.point().arclength) - from;
    const double usual =
        std::max(std::abs(continuation.previous().determinant), std::abs(continuation.point().determinant));
    ContinuationPoint there;
    return !continuation.between((point.arclength - from) / length, there) ||
           std::abs(there.determinant) < zero * usual;
}

} // namespace

void drop_crossings_of_nothing(BranchState& state, std::vector<SpecialPoint>& found, double length) {
    constexpr double near = 0.05; // share of the step: determinants are ill-conditioned there
    const std::vector<SpecialPoint> all = found;
    std::erase_if(found, [&](const SpecialPoint& one) {
        const bool crossing = one.type == PointType::branch_point || one.type == PointType::asymmetry;
        return crossing && std::any_of(all.begin(), all.end(), [&](const auto& other) {
                   const bool contact_ends =
                       other.type == PointType::vanishing || (other.type == PointType::grazing && other.at_end);
                   return contact_ends && std::abs(one.arclength - other.arclength) < near * length &&
                          is_singular_at(state, other);
               });
    });
}

void drop_folds_of_return(BranchState& state, std::vector<SpecialPoint>& found, double length) {
    constexpr double near = 0.05; // share of the step: both are located where they are ill-conditioned
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!is_degenerate(state, found[i]))
            continue;
        const double at = found[i].arclength;
        std::erase_if(found, [&](const SpecialPoint& other) {
            return other.type == PointType::fold && std::abs(other.arclength - at) < near * length;
        });
        break;
    }
}

} // namespace graze
