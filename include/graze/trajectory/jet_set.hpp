#pragma once

#include "graze/flow/mode_jets.hpp"
#include "graze/trajectory/simulation.hpp"

namespace graze {

/// The jets of a simulation's modes, with the order of its options.
class JetSet : public ModeJets {
public:
    JetSet(const Simulation& simulation, LaneKind kind, InstructionSet set = best_instruction_set())
        : ModeJets(simulation.system(), simulation.order(), kind, set), simulation_(simulation) {}
    const Simulation& simulation() const { return simulation_; }

private:
    Simulation simulation_;
};

} // namespace graze
