#pragma once

#include "graze/orbit/orbit.hpp"
#include "orbit/accumulation.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace graze {

/// The smooth motions of which a segment consists, one after another, all in its mode: a single one, or the flights
/// between the contacts of a chatter sequence that are resolved and, as one, all that are left.
struct SegmentArcs {
    std::vector<std::vector<double>> starts;
    std::vector<double> durations;
    std::vector<double> end; ///< state at the accumulation of contacts; empty for other segments
    std::string problem;     ///< why the contacts do not accumulate; empty if they do
};

/// Finds the arcs of segments of orbits.
class SegmentArcsFinder {
public:
    explicit SegmentArcsFinder(const Simulation& simulation) : simulation_(simulation) {}
    SegmentArcs operator()(const Orbit& orbit, std::size_t segment);

private:
    Simulation simulation_;
    std::map<std::size_t, Accumulation> accumulations_; ///< by transition
};

} // namespace graze
