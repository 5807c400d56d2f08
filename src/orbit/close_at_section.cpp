#include "orbit/close_at_section.hpp"

#include "graze/trajectory/trajectory.hpp"

#include <algorithm>
#include <utility>

namespace graze {

namespace {

/// Records the passages of one section.
class PassageRecorder : public Observer {
public:
    explicit PassageRecorder(std::size_t mode) : mode_(mode) {}
    void passage(const Passage& passage) override {
        strayed = strayed || passage.mode != mode_;
        times.push_back(passage.time);
        states.emplace_back(passage.state.begin(), passage.state.end());
    }
    std::vector<double> times;
    std::vector<std::vector<double>> states;
    bool strayed = false; ///< into another mode

private:
    std::size_t mode_;
};

/// The sections in the order in which they are tried.
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

} // namespace

std::optional<Orbit> close_at_section(const Model& model, const std::vector<double>& parameters,
                                      std::span<const double> state, std::size_t mode, double duration,
                                      const std::string& preferred, std::optional<std::size_t> symmetry) {
    // Whether the last passage is the first one again must not depend on round-off.
    constexpr double same_time = 1e-6;
    for (const std::size_t index : candidates(model, preferred)) {
        const Simulation simulation(model, {section_probe(model, model.sections[index].name)});
        PassageRecorder recorder(mode);
        Trajectory trajectory(simulation, parameters, recorder);
        trajectory.start(state, mode, 0, (2 + same_time) * duration);
        JetSet jets(simulation, LaneKind::single);
        run(trajectory, jets);
        if (recorder.times.empty() || recorder.strayed)
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
