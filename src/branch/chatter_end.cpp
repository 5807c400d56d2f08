#include "branch/chatter_end.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/branch/chatter_limit.hpp"
#include "orbit/accumulation.hpp"
#include "orbit/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Share of the period below which a segment is about to vanish.
constexpr double almost_nothing = 0.05;

/// Returns the orbit that begins with another of its segments.
Orbit begun_with(const Orbit& orbit, std::size_t segment) {
    Orbit result = orbit;
    const auto first = static_cast<std::ptrdiff_t>(segment);
    std::rotate(result.signature.begin(), result.signature.begin() + first, result.signature.end());
    std::rotate(result.starts.begin(), result.starts.begin() + first, result.starts.end());
    std::rotate(result.durations.begin(), result.durations.begin() + first, result.durations.end());
    return result;
}

/// Returns the value at 0 of the polynomial through points (Neville).
double extrapolated(const std::vector<double>& at, std::vector<double> values) {
    for (std::size_t order = 1; order < at.size(); ++order)
        for (std::size_t i = 0; i + order < at.size(); ++i)
            values[i] = (at[i + order] * values[i] - at[i] * values[i + 1]) / (at[i + order] - at[i]);
    return values.front();
}

} // namespace

void ChatterEnd::note(const BranchPoint& point) {
    constexpr std::size_t most = 1000;
    const Orbit& orbit = point.solution.orbit;
    const bool chatters =
        std::ranges::any_of(orbit.signature, [](const Segment& one) { return one.end == SegmentEnd::chatter; });
    if (!chatters || orbit.signature != last_.solution.orbit.signature || seen_.size() >= most)
        seen_.clear();
    if (!chatters || !point.solution.certificate.admissible)
        return;
    last_ = point;
    seen_.push_back({point.parameter, orbit.durations, orbit});
}

bool ChatterEnd::is_at_onset(const Orbit& orbit) {
    constexpr double shortest = 1e-5; // share of the period
    for (std::size_t s = 0; s < orbit.segments(); ++s)
        if (orbit.signature[s].end == SegmentEnd::chatter &&
            orbit.durations[(s + 1) % orbit.segments()] < shortest * orbit.return_time())
            return true;
    return false;
}

/// Returns the last orbit that was seen whose segment is longer than that of the last one by a factor.
const ChatterEnd::Seen* ChatterEnd::longer(std::size_t segment, double factor) const {
    const auto found = std::find_if(seen_.rbegin(), seen_.rend(), [&](const Seen& one) {
        return one.durations[segment] >= factor * seen_.back().durations[segment];
    });
    return found == seen_.rend() ? nullptr : &*found;
}

/// True when a parameter lies about as far ahead of the last orbit as an earlier one lies behind it.
bool ChatterEnd::is_ahead(double parameter, const Seen& before) const {
    constexpr double farthest = 4, behind = 0.1; // the last orbits may have passed the end by their errors
    const double done = last_.parameter - before.parameter, left = parameter - last_.parameter;
    return std::abs(left) <= farthest * std::abs(done) && left * done >= -behind * done * done;
}

/// Returns the last orbit as a point at another parameter, which is not located.
SpecialPoint ChatterEnd::extrapolated_to(PointType type, double parameter, const BranchState& state) const {
    SpecialPoint point = special_of_type(type, last_);
    point.located = false;
    point.parameter = parameter;
    point.solution.orbit.parameters[state.settings().parameter.place()] = parameter;
    return point;
}

std::optional<SpecialPoint> ChatterEnd::find(BranchState& state) const {
    if (seen_.empty() || state.settings().kept || !state.settings().free.empty())
        return std::nullopt;
    const Orbit& orbit = last_.solution.orbit;
    for (std::size_t s = 0; s < orbit.segments(); ++s) {
        if (orbit.signature[s].end != SegmentEnd::chatter)
            continue;
        const std::size_t rest = (s + 1) % orbit.segments();
        auto end = orbit.durations[rest] < almost_nothing * orbit.return_time() ? onset(state, s) : std::nullopt;
        if (!end && orbit.durations[s] < almost_nothing * orbit.return_time())
            end = vanishing(state, s);
        if (!end)
            end = lost_contact(state, s);
        if (end)
            return end;
    }
    return std::nullopt;
}

/// The onset of chatter, from the motion at the limit itself.
std::optional<SpecialPoint> ChatterEnd::onset(BranchState& state, std::size_t segment) const {
    const Orbit& orbit = last_.solution.orbit;
    const std::size_t rest = (segment + 1) % orbit.segments();
    const Seen* const before = longer(rest, 2);
    if (!before || (orbit.symmetry && rest != 0))
        return std::nullopt;
    const std::size_t event = state.model().transitions[orbit.signature[segment].index].event;
    const ChatterLimit limit = chatter_limit_near(state.system(), begun_with(orbit, rest), event,
                                                  state.settings().parameter, state.settings().orbit.tolerance);
    if (!limit.direct || !is_ahead(limit.direct->first, *before))
        return extrapolated_onset(state, segment, *before);
    SpecialPoint point = special_of_type(PointType::chatter, last_);
    const auto [value, error] = *limit.direct;
    point.parameter = value;
    point.bracket = {value - error, value + error};
    point.detail =
        fmt::format("+- {:.1e}; e = {:.6g}, ratio {:.6g}", error, limit.contacts.restitution, limit.contacts.ratio);
    point.segment = segment;
    point.event = event;
    point.solution = {};
    point.solution.orbit = limit.orbit;
    point.solution.outcome = OrbitOutcome::converged;
    point.solution.residual = limit.gap;
    point.tangent = {};
    return point;
}

/// The onset from the orbits before it, where its own motion has too many contacts to be followed. In the self-similar
/// sequence of contacts at the onset times before the end shrink by a factor with each contact, and distances of the
/// parameter by another one: they are a power of the rest's duration, up to a periodic function of its logarithm.
std::optional<SpecialPoint> ChatterEnd::extrapolated_onset(BranchState& state, std::size_t segment,
                                                           const Seen& before) const {
    constexpr double shortest = 1e-3; // share of the period
    const Orbit& orbit = last_.solution.orbit;
    const std::size_t rest = (segment + 1) % orbit.segments();
    const double longer_by = before.durations[rest] / orbit.durations[rest];
    const Simulation simulation(state.system(), {}, {}, integration(state.settings().orbit.tolerance));
    const Accumulation accumulation(simulation.system(), orbit.signature[segment].index, {});
    const ChatterContacts contacts =
        follow_chatter(simulation, accumulation, orbit.parameters, orbit.starts[segment], orbit.durations[segment]);
    Accumulation::Remainder left;
    if (!(orbit.durations[rest] < shortest * orbit.return_time()) || !contacts.problem.empty() ||
        !accumulation.evaluate(contacts.starts.back(), orbit.parameters, left) || !(left.ratio > 0 && left.ratio < 1))
        return std::nullopt;
    const SelfSimilarContacts similar = self_similar_contacts(left.ratio);
    const double power = std::log(similar.ratio) / std::log(similar.times);
    const double ahead = (last_.parameter - before.parameter) / (std::pow(longer_by, power) - 1);
    SpecialPoint point = extrapolated_to(PointType::chatter, last_.parameter + ahead, state);
    point.bracket = std::minmax(last_.parameter, last_.parameter + 2 * ahead);
    point.segment = segment;
    point.event = accumulation.event();
    point.detail = fmt::format("+- {:.1e}, from the orbits before it; e = {:.6g}, ratio {:.6g}", std::abs(ahead),
                               left.ratio, similar.ratio);
    point.solution.orbit = begun_with(point.solution.orbit, rest);
    point.tangent = {};
    return point;
}

/// The grazing at which a contact of the sequence loses its speed, while later ones keep theirs, or at which the whole
/// sequence does, since the motion returns to the surface without speed: the parameter differs
/// from that of the grazing by the square of the speed.
std::optional<SpecialPoint> ChatterEnd::lost_contact(BranchState& state, std::size_t segment) const {
    constexpr double slow = 0.05, slower = 0.5; // shares of the speed of a later contact
    constexpr std::size_t examined = 40;
    const std::size_t transition = last_.solution.orbit.signature[segment].index;
    const Simulation simulation(state.system(), {}, {}, integration(state.settings().orbit.tolerance));
    const Accumulation accumulation(simulation.system(), transition, {});
    struct Slow {
        double speed = 0, share = 1, time = 0;
    };
    const auto slowest = [&](const Orbit& orbit) {
        const ChatterContacts contacts =
            follow_chatter(simulation, accumulation, orbit.parameters, orbit.starts[segment], orbit.durations[segment]);
        Slow result;
        double later = 0;
        for (std::size_t i = contacts.durations.size(); i > 0; --i) {
            const double speed = accumulation.heights(contacts.starts[i], orbit.parameters)[1];
            if (speed < slower * later && speed / later < result.share) {
                result = {speed, speed / later, 0};
                for (std::size_t k = 0; k < i; ++k)
                    result.time += contacts.durations[k];
            }
            later = std::max(later, speed);
        }
        // A sequence that begins at once, without a flight before it, begins with this speed.
        Accumulation::Remainder left;
        if (contacts.problem.empty() && accumulation.evaluate(contacts.starts.back(), orbit.parameters, left)) {
            const double speed = accumulation.heights(contacts.starts[1], orbit.parameters)[1],
                         usual = 0.5 * (1 - left.ratio) * left.deceleration * orbit.durations[segment];
            if (speed < result.share * usual)
                result = {speed, speed / usual, contacts.durations.front()};
        }
        return result;
    };
    const Slow here = slowest(last_.solution.orbit);
    if (!(here.share < slow))
        return std::nullopt;
    for (std::size_t back = 1; back < std::min(examined, seen_.size()); ++back) {
        const Seen& before = seen_[seen_.size() - 1 - back];
        const Slow there = slowest(before.orbit);
        if (!(there.share < 1 && there.speed > 2 * here.speed))
            continue;
        const double now = here.speed * here.speed, then = there.speed * there.speed;
        const double value = last_.parameter + now * (last_.parameter - before.parameter) / (then - now);
        if (!is_ahead(value, before))
            return std::nullopt;
        SpecialPoint point = extrapolated_to(PointType::grazing, value, state);
        // As far as the end would be if the parameter was linear in the speed.
        const double farthest = 1 + there.speed / here.speed;
        point.bracket = std::minmax(last_.parameter, last_.parameter + farthest * (value - last_.parameter));
        point.segment = segment;
        point.event = accumulation.event();
        point.time = here.time;
        point.detail = fmt::format("{}, no approach speed", state.model().events[point.event].name);
        return point;
    }
    return std::nullopt;
}

/// The point at which the motion no longer leaves the surface, from the orbits before it: the parameter is a smooth
/// function of the duration of the sequence.
std::optional<SpecialPoint> ChatterEnd::vanishing(BranchState& state, std::size_t segment) const {
    constexpr std::size_t used = 6;
    constexpr double apart = 1.2; // ratio of the durations of two orbits that are used
    std::vector<double> durations, parameters;
    for (auto one = seen_.rbegin(); one != seen_.rend() && durations.size() < used; ++one)
        if (durations.empty() || one->durations[segment] > apart * durations.back()) {
            durations.push_back(one->durations[segment]);
            parameters.push_back(one->parameter);
        }
    if (durations.size() < used)
        return std::nullopt;
    const double value = extrapolated(durations, parameters);
    durations.pop_back();
    parameters.pop_back();
    constexpr double caution = 4; // durations near the end are known to few digits
    const double error = caution * std::abs(value - extrapolated(durations, parameters));
    const Seen* const before = longer(segment, 2);
    if (!before || !is_ahead(value, *before) || !(error <= std::abs(value - before->parameter)))
        return std::nullopt;
    SpecialPoint point = extrapolated_to(PointType::vanishing, value, state);
    point.bracket = {std::min(value - error, last_.parameter), std::max(value + error, last_.parameter)};
    point.segment = segment;
    point.event = state.model().transitions[last_.solution.orbit.signature[segment].index].event;
    point.detail = fmt::format("segment {} +- {:.1e}: the motion no longer leaves the surface", segment + 1, error);
    return point;
}

} // namespace graze
