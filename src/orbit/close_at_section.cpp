#include "orbit/close_at_section.hpp"

#include "graze/trajectory/trajectory.hpp"

#include <utility>

namespace graze {

namespace {

/// Records the passages of one section.
class PassageRecorder : public Observer {
public:
    explicit PassageRecorder(std::size_t mode) : mode_(mode) {}
    void passage(const Passage& passage) override {
        left_mode = left_mode || passage.mode != mode_;
        times.push_back(passage.time);
        states.emplace_back(passage.state.begin(), passage.state.end());
    }
    std::vector<double> times;
    std::vector<std::vector<double>> states;
    bool left_mode = false; ///< the motion has passed the section in another mode

private:
    std::size_t mode_;
};

/// Returns the sections in the order in which they are tried: phase sections first, the preferred one first among them.
std::vector<std::size_t> candidates(const Model& model, const std::string& preferred) {
    std::vector<std::size_t> result;
    const auto add = [&](bool phase, bool named) {
        for (std::size_t s = 0; s < model.sections.size(); ++s)
            if (model.sections[s].state.has_value() == phase && (model.sections[s].name == preferred) == named)
                result.push_back(s);
    };
    for (const auto& [phase, named] : {std::pair(true, true), {true, false}, {false, true}, {false, false}})
        add(phase, named);
    return result;
}

/// Passages whose times differ by less than this share of the period are the same one, whatever round-off does.
constexpr double same_time = 1e-6;

} // namespace

Orbit cut_at_section(const System& system, const Orbit& arcs, std::size_t section) {
    const Model& model = system.model();
    SimulationOptions options;
    options.tolerance = 1e-13; // the tolerance with which orbits are computed
    // Integrates the smooth motion without events, so that a touched event does not happen.
    const Simulation simulation(system.without_events(), {section_probe(model, model.sections[section].name)}, {},
                                options);
    JetSet jets(simulation, LaneKind::single);
    const std::size_t mode = arcs.signature.front().mode;
    const double period = arcs.return_time(), near = same_time * period;
    Orbit orbit;
    orbit.parameters = arcs.parameters;
    double begun = 0, before = 0; // start times of the current segment and of the current arc
    const auto cut = [&](double time, const std::vector<double>& state) {
        orbit.durations.push_back(time - begun);
        orbit.starts.push_back(state);
        begun = time;
    };
    orbit.starts.push_back(arcs.starts.front());
    for (std::size_t k = 0; k < arcs.segments(); ++k) {
        const double duration = arcs.durations[k];
        PassageRecorder recorder(mode);
        Trajectory trajectory(simulation, arcs.parameters, borrowed(recorder));
        trajectory.start(arcs.starts[k], mode, 0, duration + near);
        run(trajectory, jets);
        for (std::size_t i = 0; i < recorder.times.size(); ++i) {
            const double time = recorder.times[i];
            if (time < near) // the start of the arc, already recorded at the end of the previous one
                continue;
            const bool at_end = time > duration - near;
            if (!at_end)
                cut(before + time, recorder.states[i]);
            else if (k + 1 < arcs.segments()) // the next start is known better than the end of the arc
                cut(before + duration, arcs.starts[k + 1]);
        }
        before += duration;
    }
    orbit.durations.push_back(period - begun);
    orbit.signature.assign(orbit.starts.size(), {mode, SegmentEnd::section, section});
    return orbit;
}

std::optional<Orbit> close_at_section(const System& system, const std::vector<double>& parameters,
                                      std::span<const double> state, std::size_t mode, double duration,
                                      const std::string& preferred, std::optional<std::size_t> symmetry) {
    const Model& model = system.model();
    for (const std::size_t index : candidates(model, preferred)) {
        const Simulation simulation(system, {section_probe(model, model.sections[index].name)});
        PassageRecorder recorder(mode);
        Trajectory trajectory(simulation, parameters, borrowed(recorder));
        trajectory.start(state, mode, 0, (2 + same_time) * duration);
        JetSet jets(simulation, LaneKind::single);
        run(trajectory, jets);
        if (recorder.times.empty() || recorder.left_mode)
            continue;
        const Segment segment{mode, SegmentEnd::section, index};
        if (symmetry)
            return Orbit{{segment}, parameters, {recorder.states.front()}, {duration}, symmetry};
        Orbit orbit;
        orbit.parameters = parameters;
        const double first = recorder.times.front();
        double known = 0;
        for (std::size_t k = 0; k < recorder.times.size(); ++k) {
            if (recorder.times[k] - first > (1 - same_time) * duration)
                break;
            if (k > 0) {
                orbit.durations.push_back(recorder.times[k] - recorder.times[k - 1]);
                known += orbit.durations.back();
            }
            orbit.signature.push_back(segment);
            orbit.starts.push_back(recorder.states[k]);
        }
        orbit.durations.push_back(duration - known);
        return orbit;
    }
    return std::nullopt;
}

} // namespace graze
