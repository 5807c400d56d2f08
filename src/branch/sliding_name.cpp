#include "branch/sliding_name.hpp"

#include "base/concatenated.hpp"
#include "flow/lie_derivative.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace graze {

namespace {

constexpr char adding[] = "adding-sliding";

/// Returns whether a slide has made this mode.
bool is_of_slide(const Model& model, std::size_t mode) {
    return model.modes[mode].derived && find_named(model.slides, model.modes[mode].name).has_value();
}

/// Returns the sliding mode to which a surface leads, and the condition for it; nothing for other events.
const Alternative* way_into_sliding(const Model& model, std::size_t mode, std::size_t event) {
    const Transition* const transition = model.find_transition(mode, event);
    if (transition == nullptr || !transition->derived || is_of_slide(model, mode))
        return nullptr;
    const auto found = std::ranges::find_if(transition->next, [&](const Alternative& one) {
        return one.mode && is_of_slide(model, *one.mode) && one.when.size() == 1;
    });
    return found == transition->next.end() ? nullptr : &*found;
}

/// Returns the state of an orbit within a segment; a vanishing one may have a negative duration.
std::vector<double> state_within(const System& system, const Orbit& orbit, std::size_t segment, double time) {
    if (!(time > 0))
        return orbit.starts[segment];
    const Simulation simulation(system.without_events());
    Trajectory trajectory(simulation, orbit.parameters);
    trajectory.start(orbit.starts[segment], orbit.signature[segment].mode, 0, time);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    return {trajectory.state().begin(), trajectory.state().end()};
}

double value_of(const System& system, const Expression& function, const std::vector<double>& state,
                const Orbit& orbit) {
    return system.function_of({&function, 1})(concatenated(state, orbit.parameters)).front();
}

/// Where the other side pushes back at a touch of the surface, orbits beyond slide there.
std::string name_of_touch(const System& system, const SpecialPoint& special) {
    const Model& model = system.model();
    const Orbit& orbit = special.solution.orbit;
    const std::size_t mode = orbit.signature[special.segment].mode;
    if (is_of_slide(model, mode)) {
        const auto& exits = model.modes[mode].slides_on.front().exits;
        return std::ranges::find(exits, special.event) != exits.end() ? adding : "";
    }
    const Alternative* const sliding = way_into_sliding(model, mode, special.event);
    if (sliding == nullptr)
        return "";
    const std::vector<double> state = state_within(system, orbit, special.segment, special.time);
    return value_of(system, sliding->when.front().function, state, orbit) > 0 ? "grazing-sliding" : "";
}

/// An orbit meets the surface at the edge of where it slides: either sliding would end at once, or go on.
std::string name_of_edge(const System& system, const SpecialPoint& special) {
    const Orbit& orbit = special.solution.orbit;
    const Segment& segment = orbit.signature[special.segment];
    if (segment.end != SegmentEnd::event)
        return "";
    Model model = system.model(); // its graph grows
    const Alternative* const sliding = way_into_sliding(model, segment.mode, model.transitions[segment.index].event);
    if (sliding == nullptr)
        return "";
    const std::vector<Expression> push{model.expand(sliding->when.front().function)},
        field = model.expand(model.modes[*sliding->mode].rates);
    const std::vector<double>& state = orbit.starts[(special.segment + 1) % orbit.starts.size()];
    return value_of(system, lie_derivatives(model, push, field).front(), state, orbit) < 0 ? "crossing-sliding"
                                                                                           : "switching-sliding";
}

/// A sliding segment of no duration: the orbit then touches the surface, or crosses it, without sliding. An excursion
/// of no duration to the other side: the orbit then slides at once, or goes on sliding.
std::string name_of_vanishing(const System& system, const SpecialPoint& special) {
    const auto& signature = special.solution.orbit.signature;
    const std::size_t count = signature.size(), mode = signature[special.segment].mode,
                      before = signature[(special.segment + count - 1) % count].mode,
                      after = signature[(special.segment + 1) % count].mode;
    if (is_of_slide(system.model(), mode))
        return before == after ? "grazing-sliding" : "crossing-sliding";
    if (before == after && is_of_slide(system.model(), before))
        return adding;
    const bool slides_after = is_of_slide(system.model(), after) && !is_of_slide(system.model(), before);
    return slides_after && before != mode ? "switching-sliding" : "";
}

} // namespace

std::string sliding_name(const System& system, const SpecialPoint& special) {
    constexpr double almost_nothing = 1e-6; // share of the period: the touch of a vanishing arc is a consequence
    const Orbit& orbit = special.solution.orbit;
    const bool vanishes = std::abs(orbit.durations[special.segment]) < almost_nothing * orbit.period();
    // What follows the last segment of a half orbit is an image of its first.
    const bool at_image = orbit.symmetry && (special.segment == 0 || special.segment + 1 == orbit.segments());
    const bool alone = special.type == PointType::grazing && !vanishes;
    if (system.model().slides.empty() || (at_image && !alone))
        return "";
    switch (special.type) {
    case PointType::grazing:
        return vanishes ? name_of_vanishing(system, special) : name_of_touch(system, special);
    case PointType::guard:
        return name_of_edge(system, special);
    case PointType::vanishing:
        return name_of_vanishing(system, special);
    default:
        return "";
    }
}

bool is_adding_sliding(const System& system, const SpecialPoint& special) {
    return sliding_name(system, special) == adding;
}

} // namespace graze
