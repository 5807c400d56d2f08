#include "orbit/cut.hpp"

#include "graze/trajectory/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

bool is_event(const Segment& segment) {
    return ends_by_transition(segment);
}

/// Merges each segment that no event ends with the following ones, up to the next event.
UncutOrbit joined_at(const Orbit& orbit, const OrbitDirection& direction, std::size_t first) {
    UncutOrbit result{orbit, direction};
    Orbit& whole = result.orbit;
    OrbitDirection& gain = result.direction;
    whole.signature.clear();
    whole.starts.clear();
    whole.durations.clear();
    gain.starts.clear();
    gain.durations.clear();
    bool continues = false;
    for (std::size_t i = 0; i < orbit.segments(); ++i) {
        const std::size_t s = (first + i) % orbit.segments();
        if (!continues) {
            whole.signature.push_back(orbit.signature[s]);
            whole.starts.push_back(orbit.starts[s]);
            whole.durations.push_back(0);
            gain.starts.push_back(direction.starts[s]);
            gain.durations.push_back(0);
        }
        whole.signature.back() = orbit.signature[s];
        whole.durations.back() += orbit.durations[s];
        gain.durations.back() += direction.durations[s];
        continues = !is_event(orbit.signature[s]);
    }
    return result;
}

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
std::vector<std::size_t> sections_to_cut(const Model& model, const std::string& preferred) {
    std::vector<std::size_t> result;
    for (const auto& [phase, named] : {std::pair(true, true), {true, false}, {false, true}, {false, false}})
        for (std::size_t s = 0; s < model.sections.size(); ++s)
            if (model.sections[s].state.has_value() == phase && (model.sections[s].name == preferred) == named)
                result.push_back(s);
    return result;
}

/// Passages whose times differ by less than this share of the period are the same one, whatever round-off does.
constexpr double same_time = 1e-6;

} // namespace

std::vector<double> passing_rates(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const Eigen::Index states = index(equations.layout().states());
    std::vector<double> rates;
    for (std::size_t s = 0; s < equations.signature().size(); ++s) {
        const OrbitEvaluation::Piece& piece = at.pieces[equations.layout().last_piece(s)];
        const SegmentEnd end = equations.signature()[s].end;
        rates.push_back(end == SegmentEnd::section ? equations.rate_at_end(at, s) / equations.typical_rate(at, s)
                        : end == SegmentEnd::cut   ? std::copysign(1, piece.condition.head(states).dot(piece.field))
                                                   : 1);
    }
    return rates;
}

std::optional<std::size_t> touched_section(const std::vector<double>& rates) {
    constexpr double hardly = 1e-2; // share of the typical rate
    for (std::size_t s = 0; s < rates.size(); ++s)
        if (!(std::abs(rates[s]) > hardly))
            return s;
    return std::nullopt;
}

std::optional<std::size_t> reversed_section(const std::vector<double>& before, const std::vector<double>& rates) {
    for (std::size_t s = 0; s < std::min(before.size(), rates.size()); ++s)
        if (before[s] * rates[s] < 0)
            return s;
    return std::nullopt;
}

bool cuts_are_oblique(const OrbitEquations& equations, const OrbitEvaluation& at) {
    constexpr double oblique = 0.7; // cosine of the angle to the normal, in scaled states
    const Eigen::VectorXd scales = at.scales.head(index(equations.layout().states()));
    for (std::size_t s = 0; s < equations.signature().size(); ++s) {
        if (equations.signature()[s].end != SegmentEnd::cut)
            continue;
        const OrbitEvaluation::Piece& piece = at.pieces[equations.layout().last_piece(s)];
        const Eigen::VectorXd normal = piece.condition.head(scales.size()).cwiseProduct(scales);
        Eigen::VectorXd motion = piece.field.cwiseQuotient(scales);
        for (Eigen::Index i = 0; i < motion.size(); ++i) // the position of a drifting state is arbitrary
            if (equations.model().states[static_cast<std::size_t>(i)].drifting)
                motion[i] = 0;
        if (std::abs(normal.dot(motion)) < oblique * normal.norm() * motion.norm())
            return true;
    }
    return false;
}

std::optional<UncutOrbit> without_sections(const Model& model, const Orbit& orbit, const OrbitDirection& direction) {
    const Signature& signature = orbit.signature;
    if (is_homoclinic(signature) || orbit.cycle)
        return std::nullopt;
    const auto last = std::find_if(signature.rbegin(), signature.rend(), is_event);
    if (last == signature.rend()) {
        UncutOrbit result{orbit, direction};
        for (Segment& segment : result.orbit.signature)
            segment = {segment.mode, SegmentEnd::cut, 0};
        return result;
    }
    // If segments after the last event continue to the first event, the orbit begins with them.
    const auto first = static_cast<std::size_t>(signature.rend() - last) % signature.size();
    const bool drifts = std::ranges::any_of(model.states, [](const State& one) { return one.drifting; });
    if (first != 0 && (orbit.symmetry || drifts))
        return std::nullopt;
    return joined_at(orbit, direction, first);
}

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
    for (const std::size_t index : sections_to_cut(model, preferred)) {
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
