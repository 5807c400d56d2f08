#include "graze/orbit/solve.hpp"
#include "graze/sweep/point_search.hpp"
#include "graze/symbolic/input_error.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "orbit/arc_flow.hpp"
#include "orbit/certify.hpp"
#include "orbit/close_at_section.hpp"
#include "orbit/shooting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace graze {

namespace {

/// Writes down the contacts of a motion.
class SegmentRecorder : public Observer {
public:
    SegmentRecorder(const CompiledModel& model, FollowedMotion& motion) : model_(&model), motion_(&motion) {}

    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::touch)
            return;
        if (contact.kind == ContactKind::sticking) {
            motion_->problem = fmt::format("contacts at '{}' accumulate at time {:.9g}",
                                           model_->model().events[contact.event].name, contact.time);
            return;
        }
        if (is_harmless(*model_, contact.transition))
            return;
        motion_->segments.push_back({contact.mode_before, SegmentEnd::event, contact.transition});
        motion_->durations.push_back(contact.time - last_);
        motion_->starts.emplace_back(contact.after.begin(), contact.after.end());
        last_ = contact.time;
    }
    bool stop() override { return !motion_->problem.empty(); }

private:
    const CompiledModel* model_;
    FollowedMotion* motion_;
    double last_ = 0;
};

/// The largest difference of two states, in units of how far each state goes along the orbit.
double distance(std::span<const double> a, std::span<const double> b, const Shooting& shooting) {
    double result = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (shooting.model().states[i].drifting)
            continue;
        double difference = a[i] - b[i];
        if (const double period = shooting.periods()[i]; period > 0)
            difference -= std::round(difference / period) * period;
        result = std::max(result, std::abs(difference) / shooting.scales()[static_cast<Eigen::Index>(i)]);
    }
    return result;
}

bool is_smooth(const Orbit& orbit) {
    return std::all_of(orbit.signature.begin(), orbit.signature.end(),
                       [](const Segment& segment) { return segment.end == SegmentEnd::section; });
}

/// Ends an orbit without contacts after half its time, which is within its middle segment; the state there is appended
/// to its starts. @return whether that makes sense
bool cut_in_half(const Model& model, Orbit& orbit, const Symmetry& symmetry) {
    const std::size_t mode = orbit.signature[0].mode, count = orbit.segments() / 2 + 1;
    if (orbit.segments() % 2 == 0 || symmetry.modes[mode] != mode)
        return false;
    double left = 0.5 * orbit.round();
    orbit.signature.resize(count);
    orbit.starts.resize(count);
    orbit.durations.resize(count);
    for (std::size_t k = 0; k + 1 < count; ++k)
        left -= orbit.durations[k];
    orbit.durations.back() = left;
    const Simulation simulation(model);
    ArcFlow flow(simulation, {});
    flow.set_parameters(orbit.parameters);
    std::vector<double> state = orbit.starts.back();
    if (!(left > 0) || flow.run(mode, state, left) != ArcFlow::Ending::done)
        return false;
    orbit.starts.push_back(std::move(state));
    return true;
}

/// One period of a motion that has been followed for more than two and a half. It begins after the contact which the
/// longest time without contacts follows, so that round-off does not decide whether the last contact belongs to it.
void cut_out(const FollowedMotion& motion, double duration, Orbit& orbit) {
    std::vector<double> times;
    double time = 0;
    for (const double each : motion.durations)
        times.push_back(time += each);
    std::size_t first = 0;
    double gap = -1;
    for (std::size_t k = 0; k + 1 < times.size() && (k == 0 || times[k] < times[0] + duration); ++k)
        if (times[k + 1] - times[k] > gap) {
            gap = times[k + 1] - times[k];
            first = k;
        }
    for (std::size_t k = first + 1; k < times.size() && times[k] < times[first] + duration + 0.5 * gap; ++k) {
        orbit.signature.push_back(motion.segments[k]);
        orbit.starts.push_back(motion.starts[k]);
        orbit.durations.push_back(motion.durations[k]);
    }
}

} // namespace

FollowedMotion follow_motion(const Simulation& simulation, std::span<const double> parameters,
                             std::span<const double> state, std::size_t mode, double time) {
    FollowedMotion motion;
    motion.starts.emplace_back(state.begin(), state.end());
    SegmentRecorder recorder(simulation.compiled(), motion);
    Trajectory trajectory(simulation, parameters, recorder);
    trajectory.start(state, mode, 0, time);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    const Outcome& outcome = trajectory.outcome();
    if (motion.problem.empty() && outcome.ending != Ending::end_time && outcome.ending != Ending::stopped)
        motion.problem = fmt::format("the motion ends at time {:.9g}: {}{}{}", outcome.time, name_of(outcome.ending),
                                     outcome.detail.empty() ? "" : ", ", outcome.detail);
    return motion;
}

namespace {

/// Whether the second half of an orbit's segments is the image of the first.
bool repeats_as_image(const Orbit& orbit, const Symmetry& symmetry, const Function& map, const Shooting& shooting,
                      double tolerance) {
    const std::size_t half = orbit.segments() / 2;
    if (orbit.segments() % 2 != 0)
        return false;
    for (std::size_t k = 0; k < half; ++k) {
        std::vector<double> state = orbit.starts[k + half];
        state.insert(state.end(), orbit.parameters.begin(), orbit.parameters.end());
        if (symmetry.modes[orbit.signature[k].mode] != orbit.signature[k + half].mode ||
            orbit.signature[k].end != orbit.signature[k + half].end ||
            (orbit.signature[k].end == SegmentEnd::section &&
             orbit.signature[k].index != orbit.signature[k + half].index) ||
            std::abs(orbit.durations[k] - orbit.durations[k + half]) > tolerance * orbit.period() ||
            distance(map(state), orbit.starts[k], shooting) > tolerance)
            return false;
    }
    return true;
}

} // namespace

std::optional<Orbit> half_orbit(const Model& model, const Orbit& orbit, double tolerance) {
    if (model.symmetries.empty() || orbit.symmetry)
        return std::nullopt;
    const Simulation simulation(model);
    const Shooting shooting(simulation, orbit, {});
    for (std::size_t index = 0; index < model.symmetries.size(); ++index) {
        const Symmetry& symmetry = model.symmetries[index];
        const Function map = symmetry_map(model, index);
        Orbit half = orbit;
        half.symmetry = index;
        if (repeats_as_image(orbit, symmetry, map, shooting, tolerance)) {
            half.signature.resize(orbit.segments() / 2);
            half.starts.resize(orbit.segments() / 2);
            half.durations.resize(orbit.segments() / 2);
            return half;
        }
        if (is_smooth(orbit) && cut_in_half(model, half, symmetry)) {
            std::vector<double> state = half.starts.back();
            state.insert(state.end(), orbit.parameters.begin(), orbit.parameters.end());
            if (distance(map(state), orbit.starts[0], shooting) < tolerance) {
                half.starts.pop_back();
                return half;
            }
        }
    }
    return std::nullopt;
}

OrbitSolution find_orbit(const Model& model, const AttractorOptions& settle, const OrbitOptions& options,
                         const SimulationOptions& simulation) {
    const auto factory = attractor_searches(model, settle, {}, {}, simulation);
    const auto search = factory->make();
    search->begin(model.parameter_values(), model.initial_state(), model.initial_mode);
    JetSet jets(factory->simulation(), LaneKind::single);
    do
        run(search->trajectory(), jets);
    while (search->proceed());
    const PointResult& result = search->result();
    if (result.label != Label::periodic)
        throw InputError(fmt::format("the motion does not settle on a periodic orbit: it is {}", name_of(result.label)),
                         "start elsewhere, allow more cycles or longer periods, or give the orbit's states");
    FollowedMotion motion = follow_motion(factory->simulation(), model.parameter_values(), result.state, result.mode,
                                          2.6 * result.duration);
    if (!motion.problem.empty())
        throw InputError("the orbit has no signature: " + motion.problem,
                         "choose parameters at which contacts do not accumulate");
    Orbit orbit;
    orbit.parameters = model.parameter_values();
    if (motion.segments.empty()) {
        const auto closed = close_at_section(model, orbit.parameters, result.state, result.mode, result.duration,
                                             settle.section, std::nullopt);
        if (!closed)
            throw InputError("the orbit passes none of the model's sections", "declare one that it passes");
        orbit = *closed;
    } else {
        cut_out(motion, result.duration, orbit);
    }
    if (const auto half = half_orbit(model, orbit))
        orbit = *half;
    return solve_orbit(model, orbit, options);
}

} // namespace graze
