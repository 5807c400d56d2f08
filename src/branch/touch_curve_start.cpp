#include "branch/touch_curve_start.hpp"

#include "base/concatenated.hpp"
#include "branch/inserted_contact.hpp"
#include "branch/point_kind.hpp"
#include "orbit/newton.hpp"
#include "orbit/orbit_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace graze {

namespace {

constexpr double no_time = 1e-5; // share of the period: near a vanishing contact durations are not known better

/// True when the jump at the end of a segment is the identity at zero speed.
bool jump_is_identity(const System& system, const Orbit& orbit, std::size_t segment) {
    constexpr double nothing = 1e-6; // share of the size of a state or of its change per period: the remaining speed
    const Segment& one = orbit.signature[segment];
    if (one.end != SegmentEnd::event)
        return false;
    const System::CompiledJump& jump = system.jump(system.model().transitions[one.index].jump);
    if (jump.identity)
        return true;
    const std::vector<double>& state = orbit.starts[(segment + 1) % orbit.segments()];
    const std::vector<double> inputs = concatenated(state, orbit.parameters);
    const std::vector<double> after = jump.map(inputs), rates = system.mode(one.mode).rates(inputs);
    return std::all_of(jump.changed.begin(), jump.changed.end(), [&](std::size_t i) {
        double size = std::abs(rates[i]) * orbit.return_time();
        for (const std::vector<double>& start : orbit.starts)
            size = std::max(size, std::abs(start[i]));
        return std::abs(after[i] - state[i]) <= nothing * size;
    });
}

bool drifts(const Model& model) {
    return std::any_of(model.states.begin(), model.states.end(), [](const State& one) { return one.drifting; });
}

/// Merges the arcs before and after a contact of zero speed where both have the same mode and the segments between them
/// have zero duration and change no state.
/// @return true if the arcs were merged
bool join_across_contact(const System& system, Orbit& orbit, SpecialPoint& kept) {
    const std::size_t count = orbit.segments();
    const auto takes_time = [&](std::size_t s) { return std::abs(orbit.durations[s]) > no_time * orbit.return_time(); };
    std::size_t before = kept.segment;
    for (std::size_t i = 0; i < count && !takes_time(before); ++i)
        before = (before + count - 1) % count;
    std::size_t after = (before + 1) % count, way = 1;
    for (; way < count && !takes_time(after); ++way)
        after = (after + 1) % count;
    const std::size_t mode = orbit.signature[before].mode;
    const bool wraps = before + way >= count;
    if (way < 2 || !takes_time(before) || orbit.signature[after].mode != mode ||
        (wraps && (orbit.symmetry || drifts(system.model()))))
        return false;
    for (std::size_t i = 0; i < way; ++i)
        if (!jump_is_identity(system, orbit, (before + i) % count))
            return false;
    kept.event = system.model().transitions[orbit.signature[before].index].event;
    kept.time = orbit.durations[before];
    kept.at_end = false;
    Orbit joined{{}, orbit.parameters, {}, {}, orbit.symmetry};
    const auto add = [&](std::size_t s) { append(joined, orbit.signature[s], orbit.starts[s], orbit.durations[s]); };
    // Copy the other segments, starting after the merged arcs or, where it stays first, with the first segment.
    const std::size_t others = after == before ? 0 : count - way - 1;
    for (std::size_t i = 0; wraps && i < others; ++i)
        add((after + 1 + i) % count);
    for (std::size_t s = 0; !wraps && s < before; ++s)
        add(s);
    kept.segment = joined.signature.size();
    add(before);
    if (after == before) {
        joined.signature.back() = {mode, SegmentEnd::cut, 0};
    } else {
        joined.signature.back() = orbit.signature[after];
        joined.durations.back() += orbit.durations[after];
    }
    for (std::size_t s = after + 1; !wraps && s < count; ++s)
        add(s);
    orbit = std::move(joined);
    return true;
}

/// True when an orbit in one mode touches an event at its start.
bool touches_at_start(const System& system, const Orbit& orbit, ModeFlow& flow) {
    constexpr double zero = 1e-6, slow = 1e-3; // shares of the largest values and rates along the arc
    constexpr int parts = 16;
    const System::CompiledMode& mode = system.mode(orbit.signature[0].mode);
    const std::size_t states = system.states(), count = mode.watched.size();
    std::vector<double> first, greatest(2 * count, 0.0), state = orbit.starts[0];
    for (int part = 0; part < parts; ++part) {
        const std::vector<double> inputs = concatenated(state, orbit.parameters);
        std::vector<double> here = mode.events(inputs);
        const std::vector<double> gradients = mode.event_gradients(inputs), rates = mode.rates(inputs);
        for (std::size_t w = 0; w < count; ++w)
            here.push_back(std::inner_product(rates.begin(), rates.end(),
                                              gradients.begin() + static_cast<std::ptrdiff_t>(w * states), 0.0));
        for (std::size_t i = 0; i < here.size(); ++i)
            greatest[i] = std::max(greatest[i], std::abs(here[i]));
        if (part == 0)
            first = here;
        if (flow.run(orbit.signature[0].mode, state, orbit.return_time() / parts) != ModeFlow::Ending::done)
            return false;
    }
    for (std::size_t w = 0; w < count; ++w)
        if (std::abs(first[w]) < zero * greatest[w] && std::abs(first[count + w]) < slow * greatest[count + w])
            return true;
    return false;
}

/// Moves the start of an orbit without contacts away from a touch that coincides with it: the kept touch, or another,
/// as when two walls are touched.
bool move_start_off_touch(const System& system, const BranchSettings& settings, Orbit& orbit, SpecialPoint& kept) {
    constexpr double at_edge = 0.02, later = 0.25; // shares of the period; a second touch lies half a period later
    const double round = orbit.durations[0], share = kept.time / round;
    if (orbit.segments() != 1 || orbit.signature[0].end == SegmentEnd::event || !(round > 0))
        return false;
    const Simulation simulation(system, {}, {}, integration(settings.orbit.tolerance));
    ModeFlow flow = flow_of(simulation);
    flow.set_parameters(orbit.parameters);
    const bool kept_there = share < at_edge || share > 1 - at_edge;
    if (!kept_there && !touches_at_start(system, orbit, flow))
        return false;
    // Start after the kept touch only if the touch itself recurs, not its image.
    const bool before = orbit.symmetry || share >= 0.5;
    const double begin = kept_there ? later : before ? 0.5 * share : 0.5 * (1 + share);
    if (orbit.symmetry && begin > share)
        return false;
    std::vector<double> start = orbit.starts[0];
    if (flow.run(orbit.signature[0].mode, start, begin * round) != ModeFlow::Ending::done)
        return false;
    orbit.starts = {std::move(start)};
    orbit.signature[0] = {orbit.signature[0].mode, SegmentEnd::cut, 0};
    kept.time = (share - begin + (share < begin ? 1 : 0)) * round;
    return true;
}

} // namespace

CurveStart start_of_curve(const System& system, const Orbit& orbit, const BranchSettings& settings) {
    CurveStart result{orbit, settings};
    if (!settings.kept || settings.kept->type != PointType::grazing || settings.kept->segment >= orbit.segments() ||
        orbit.durations.size() != orbit.segments() || refer_to_segments(settings.monitors))
        return result;
    SpecialPoint& kept = *result.settings.kept;
    if (kept.at_end && !join_across_contact(system, result.orbit, kept))
        return result;
    move_start_off_touch(system, settings, result.orbit, kept);
    kept.solution.orbit = result.orbit;
    return result;
}

} // namespace graze
