#include "graze/trajectory/jet_set.hpp"

namespace graze {

JetSet::JetSet(const Simulation& simulation, LaneKind kind, InstructionSet set)
    : simulation_(simulation), kind_(kind), set_(set), width_(kind == LaneKind::single     ? 1
                                                              : kind == LaneKind::ensemble ? lanes_of(kind, set)
                                                                                           : 1 + lanes_of(kind, set)),
      jets_(simulation.model().modes.size()), next_jets_(jets_.size()) {}

Jet& JetSet::make(Jets& jets, std::size_t mode) {
    auto& jet = jets[mode];
    jet = make_jet(simulation_.system().mode(mode).tape, simulation_.order(), kind_, set_);
    if (!parameters_.empty())
        jet->set_parameters(parameters_);
    return *jet;
}

void JetSet::set_parameters(std::span<const double> parameters) {
    parameters_.assign(parameters.begin(), parameters.end());
    for (const Jets* jets : {&jets_, &next_jets_})
        for (const auto& jet : *jets)
            if (jet)
                jet->set_parameters(parameters_);
}

void JetSet::set_parameters(std::size_t mode, std::span<const double> parameters) {
    (*this)(mode).set_parameters(parameters);
    next(mode).set_parameters(parameters);
}

} // namespace graze
