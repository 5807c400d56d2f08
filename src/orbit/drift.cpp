#include "orbit/drift.hpp"

#include "orbit/shooting.hpp"

#include <algorithm>

namespace graze {

void join_drifts(const Simulation& simulation, Orbit& orbit) {
    const auto& states = simulation.model().states;
    if (orbit.segments() < 2 ||
        std::none_of(states.begin(), states.end(), [](const State& one) { return one.drifting; }))
        return;
    Shooting shooting(simulation, orbit, {});
    OrbitEvaluation at = shooting.evaluation();
    if (!shooting.evaluate(shooting.unknowns_of(orbit), at))
        return;
    // The motion does not depend on drifting states, so all segments are integrated before any start is shifted.
    std::vector<double> shift(states.size(), 0.0);
    for (std::size_t s = 0; s + 1 < orbit.segments(); ++s)
        for (std::size_t i = 0; i < states.size(); ++i) {
            if (!states[i].drifting)
                continue;
            const double end = at.pieces[shooting.layout().last_piece(s)].after[i] + shift[i];
            shift[i] = end - orbit.starts[s + 1][i];
            orbit.starts[s + 1][i] = end;
        }
}

} // namespace graze
