#pragma once

#include "graze/orbit/orbit.hpp"
#include "graze/results/quantity_evaluator.hpp"
#include "graze/trajectory/jet_set.hpp"
#include "graze/trajectory/simulation.hpp"
#include "orbit/segment_arcs.hpp"

#include <string>
#include <vector>

namespace graze {

/// A value of orbits where they pass a section, as samples of motions have it.
class SectionPassages {
public:
    /// @throws InputError when the model has no such section
    SectionPassages(const Model& model, const std::string& section, const NamedValue& value);

    /// The value at each passage of one period, in the order of time. Events within segments are ignored, so that
    /// unphysical orbits have passages too; segments of negative durations have none.
    std::vector<double> of(const Orbit& orbit);

private:
    void follow(const Orbit& orbit, std::size_t segment, double near, std::vector<double>& values);
    double value_at(std::span<const double> state) { return evaluate_(state)[0]; }
    bool ends_at_section(const Segment& segment) const;

    System system_;
    std::size_t section_;
    Simulation simulation_;
    JetSet jets_;
    SegmentArcsFinder arcs_of_;
    QuantityEvaluator evaluate_;
};

/// Turns the order of passages round, so that each is near the one of an adjacent orbit in its place.
void align_passages(std::vector<double>& values, const std::vector<double>& adjacent);

} // namespace graze
