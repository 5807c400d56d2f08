#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/orbit/solve.hpp"
#include "graze/sweep/point_search.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "orbit/certify.hpp"
#include "orbit/cut.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

/// Records the segments of a motion.
class SegmentRecorder : public Observer {
public:
    SegmentRecorder(const System& model, FollowedMotion& motion) : model_(&model), motion_(&motion) {}

    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::touch)
            return;
        if (contact.kind == ContactKind::sticking) {
            motion_->problem = fmt::format("contacts at '{}' accumulate at time {:.9g}",
                                           model_->model().events[contact.event].name, contact.time);
            return;
        }
        if (is_identity_transition(*model_, contact.transition))
            return;
        motion_->segments.push_back({contact.mode_before, SegmentEnd::event, contact.transition});
        motion_->durations.push_back(contact.time - last_);
        motion_->starts.emplace_back(contact.after.begin(), contact.after.end());
        last_ = contact.time;
    }
    bool stop() override { return !motion_->problem.empty(); }

private:
    const System* model_;
    FollowedMotion* motion_;
    double last_ = 0;
};

/// Extracts one period from a motion that was followed for more than two and a half. The period begins after the
/// contact that is followed by the longest time without contacts, so that round-off does not decide whether the last
/// contact belongs to it.
void extract_period(const FollowedMotion& motion, double duration, Orbit& orbit) {
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
    require_finite(time, "the time for which a motion is followed");
    FollowedMotion motion;
    motion.starts.emplace_back(state.begin(), state.end());
    SegmentRecorder recorder(simulation.system(), motion);
    Trajectory trajectory(simulation, parameters, borrowed(recorder));
    trajectory.start(state, mode, 0, time);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    motion.final_state.assign(trajectory.state().begin(), trajectory.state().end());
    motion.final_mode = trajectory.mode();
    const Outcome& outcome = trajectory.outcome();
    if (motion.problem.empty() && outcome.ending != Ending::end_time && outcome.ending != Ending::stopped)
        motion.problem = fmt::format("the motion ends at time {:.9g}: {}{}{}", outcome.time, name_of(outcome.ending),
                                     outcome.detail.empty() ? "" : ", ", outcome.detail);
    return motion;
}

OrbitSolution find_orbit(const System& system, const AttractorOptions& settle, const OrbitOptions& options,
                         const SimulationOptions& simulation) {
    return *find_orbit(system, settle, options, simulation, [] { return false; });
}

std::optional<OrbitSolution> find_orbit(const System& system, const AttractorOptions& settle,
                                        const OrbitOptions& options, const SimulationOptions& simulation,
                                        const std::function<bool()>& interrupted) {
    const Model& model = system.model();
    const auto factory = attractor_searches(system, settle, {}, {}, simulation);
    const auto search = factory->make();
    search->begin(model.parameter_values(), model.initial_state(), model.initial_mode);
    JetSet jets(factory->simulation(), LaneKind::single);
    do {
        if (interrupted())
            return std::nullopt;
        run(search->trajectory(), jets);
    } while (search->proceed());
    const PointResult& result = search->result();
    // With a clock section an equilibrium returns like any orbit.
    const bool returns = result.label == Label::equilibrium && result.period > 0;
    const auto no_orbit = [&] {
        return InputError(fmt::format("the motion does not settle on a periodic orbit: it is {}{}{}",
                                      name_of(result.label), result.outcome.detail.empty() ? "" : ", ",
                                      result.outcome.detail),
                          "start elsewhere, allow more cycles or longer periods, or give the orbit's states");
    };
    if (result.label != Label::periodic && !returns)
        throw no_orbit();
    FollowedMotion motion = follow_motion(factory->simulation(), model.parameter_values(), result.state, result.mode,
                                          2.6 * result.duration);
    if (!motion.problem.empty())
        throw InputError("the orbit has no signature: " + motion.problem,
                         "choose parameters at which contacts do not accumulate");
    // Near an equilibrium, contacts of the motion may be due to round-off: they belong to no orbit.
    if (returns && !motion.segments.empty())
        throw no_orbit();
    Orbit orbit;
    orbit.parameters = model.parameter_values();
    if (motion.segments.empty()) {
        const auto closed = close_at_section(system, orbit.parameters, result.state, result.mode, result.duration,
                                             settle.section, std::nullopt);
        if (!closed)
            throw InputError("the orbit passes none of the model's sections", "declare one that it passes");
        orbit = *closed;
    } else {
        extract_period(motion, result.duration, orbit);
    }
    if (const auto half = half_orbit(system, orbit))
        return solve_orbit(system, *half, options);
    OrbitSolution solution = solve_orbit(system, orbit, options);
    // A transient may have hidden the symmetry of the orbit, so it is tested again after refinement.
    const auto half = solution.outcome == OrbitOutcome::converged ? half_orbit(system, solution.orbit) : std::nullopt;
    return half ? solve_orbit(system, *half, options) : solution;
}

} // namespace graze
