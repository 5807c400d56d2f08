#include "picture/section_passages.hpp"

#include "base/special_numbers.hpp"
#include "graze/model/model.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr double same_time = 1e-9; ///< passages within this share of a period are one

SimulationOptions options_of_orbits() {
    SimulationOptions options;
    options.tolerance = 1e-10;    // much less than a picture shows
    options.step_limit = 100'000; // segments take some hundreds of steps, but a file may have any duration
    return options;
}

class PassageTimes : public Observer {
public:
    void passage(const Passage& passage) override {
        times.push_back(passage.time);
        states.emplace_back(passage.state.begin(), passage.state.end());
    }
    std::vector<double> times;
    std::vector<std::vector<double>> states;
};

} // namespace

SectionPassages::SectionPassages(const Model& model, const std::string& section, const NamedValue& value)
    : system_(model), section_(model.find_section(section).value_or(model.sections.size())),
      simulation_(system_.without_events(), {section_probe(model, section)}, {}, options_of_orbits()),
      jets_(simulation_, LaneKind::single), arcs_of_(Simulation(system_, {}, {}, options_of_orbits())),
      evaluate_(model, {value}) {}

std::vector<double> SectionPassages::of(const Orbit& orbit) {
    const Orbit whole = whole_orbit(system_, orbit);
    evaluate_.set_parameters(whole.parameters);
    std::vector<double> values;
    const double near = same_time * std::abs(whole.period());
    for (std::size_t s = 0; s < whole.segments(); ++s)
        follow(whole, s, near, values);
    return values;
}

/// Adds the passage at the start of a segment, if it is one, and those within the segment.
void SectionPassages::follow(const Orbit& orbit, std::size_t segment, double near, std::vector<double>& values) {
    const Segment& one = orbit.signature[segment];
    const Segment& before = orbit.signature[(segment + orbit.segments() - 1) % orbit.segments()];
    if (ends_at_section(before))
        values.push_back(value_at(orbit.starts[segment]));
    const double duration = orbit.durations[segment];
    if (!(duration > 0) || !std::isfinite(duration))
        return;
    PassageTimes passages;
    const SegmentArcs arcs = arcs_of_(orbit, segment);
    std::vector<double> begins; // of the arcs in which the passages lie
    double begin = 0;
    for (std::size_t i = 0; i < arcs.starts.size(); ++i) {
        Trajectory trajectory(simulation_, orbit.parameters, borrowed(passages));
        trajectory.start(arcs.starts[i], one.mode, 0, arcs.durations[i]);
        run(trajectory, jets_);
        begins.resize(passages.times.size(), begin);
        begin += arcs.durations[i];
    }
    for (std::size_t i = 0; i < passages.times.size(); ++i) {
        const double time = begins[i] + passages.times[i];
        if (!(ends_at_section(before) && time < near) && !(ends_at_section(one) && time > duration - near))
            values.push_back(value_at(passages.states[i]));
    }
}

bool SectionPassages::ends_at_section(const Segment& segment) const {
    return segment.end == SegmentEnd::section && segment.index == section_;
}

void align_passages(std::vector<double>& values, const std::vector<double>& adjacent) {
    const std::size_t common = std::min(values.size(), adjacent.size());
    std::size_t best = 0;
    double least = infinity;
    for (std::size_t turn = 0; turn < values.size(); ++turn) {
        double distance = 0;
        for (std::size_t i = 0; i < common; ++i)
            distance += std::abs(values[(i + turn) % values.size()] - adjacent[i]);
        if (distance < least) {
            least = distance;
            best = turn;
        }
    }
    std::rotate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(best), values.end());
}

} // namespace graze
