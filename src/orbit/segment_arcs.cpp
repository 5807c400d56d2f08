#include "orbit/segment_arcs.hpp"

#include <algorithm>

namespace graze {

SegmentArcs SegmentArcsFinder::operator()(const Orbit& orbit, std::size_t segment) {
    const Segment& one = orbit.signature[segment];
    const double duration = orbit.durations[segment];
    SegmentArcs arcs{{orbit.starts[segment]}, {duration}, {}, {}};
    if (one.end != SegmentEnd::chatter)
        return arcs;
    const auto accumulation =
        accumulations_.try_emplace(one.index, simulation_.system(), one.index, std::vector<ParameterId>());
    const Accumulation& known = accumulation.first->second;
    ChatterContacts contacts = follow_chatter(simulation_, known, orbit.parameters, orbit.starts[segment], duration);
    arcs.problem = std::move(contacts.problem);
    Accumulation::Remainder left;
    if (!arcs.problem.empty() || !known.evaluate(contacts.starts.back(), orbit.parameters, left))
        return arcs;
    arcs.starts = std::move(contacts.starts);
    arcs.durations = std::move(contacts.durations);
    arcs.durations.push_back(left.time);
    arcs.end = {left.state.begin(), left.state.end()};
    return arcs;
}

} // namespace graze
