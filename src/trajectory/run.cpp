#include "graze/trajectory/trajectory.hpp"

#include <stdexcept>

namespace graze {

JetSet::JetSet(const Simulation& simulation, LaneKind kind, InstructionSet set)
    : simulation_(&simulation), kind_(kind), set_(set), width_(kind == LaneKind::single     ? 1
                                                               : kind == LaneKind::ensemble ? lanes_of(kind, set)
                                                                                            : 1 + lanes_of(kind, set)),
      jets_(simulation.model().modes.size()) {}

Jet& JetSet::operator()(std::size_t mode) {
    auto& jet = jets_[mode];
    if (!jet) {
        jet = make_jet(simulation_->compiled().mode(mode).tape, simulation_->order(), kind_, set_);
        if (!parameters_.empty())
            jet->set_parameters(parameters_);
    }
    return *jet;
}

void JetSet::set_parameters(std::span<const double> parameters) {
    parameters_.assign(parameters.begin(), parameters.end());
    for (auto& jet : jets_)
        if (jet)
            jet->set_parameters(parameters_);
}

void run(Trajectory& trajectory, JetSet& jets) {
    if (&trajectory.simulation() != &jets.simulation())
        throw std::invalid_argument("a trajectory of one simulation cannot run on the jets of another");
    if (jets.width() != 1)
        throw std::invalid_argument("one trajectory cannot run on jets of several lanes");
    jets.set_parameters(trajectory.parameters());
    Outlook outlook(trajectory.simulation(), 1);
    while (!trajectory.finished()) {
        Jet& jet = jets(trajectory.mode());
        jet.compute(trajectory.state());
        outlook.lengths()[0] = trajectory.previous_step();
        outlook.find_steps(jet);
        outlook.lengths()[0] = trajectory.propose(jet, outlook.length(0));
        outlook.look(jet, trajectory.mode());
        trajectory.advance(outlook);
    }
}

} // namespace graze
