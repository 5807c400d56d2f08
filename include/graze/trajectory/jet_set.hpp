#pragma once

#include "graze/flow/mode_jets.hpp"
#include "graze/trajectory/simulation.hpp"

namespace graze {

/// Jets for the modes of a simulation, on which its trajectories run.
class JetSet : public ModeJets {
public:
    JetSet(const Simulation& simulation, LaneKind kind, InstructionSet set = best_instruction_set())
        : ModeJets(simulation.system(), simulation.order(), kind, set), simulation_(simulation) {}
    const Simulation& simulation() const { return simulation_; }

private:
    Simulation simulation_;
};

} // namespace graze
