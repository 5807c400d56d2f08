#include "graze/flow/mode_jets.hpp"

namespace graze {

ModeJets::ModeJets(const System& system, int order, LaneKind kind, InstructionSet set)
    : system_(system), order_(order), kind_(kind), set_(set),
      width_(kind == LaneKind::single     ? 1
             : kind == LaneKind::ensemble ? lanes_of(kind, set)
                                          : 1 + lanes_of(kind, set)),
      jets_(system.model().modes.size()), next_jets_(jets_.size()) {}

Jet& ModeJets::make(Jets& jets, std::size_t mode) {
    auto& jet = jets[mode];
    jet = make_jet(system_.mode(mode).tape, order_, kind_, set_);
    if (!parameters_.empty())
        jet->set_parameters(parameters_);
    return *jet;
}

void ModeJets::set_parameters(std::span<const double> parameters) {
    require_size(parameters.size(), system_.parameters() * static_cast<std::size_t>(width_), "parameters of jets");
    parameters_.assign(parameters.begin(), parameters.end());
    for (const Jets* jets : {&jets_, &next_jets_})
        for (const auto& jet : *jets)
            if (jet)
                jet->set_parameters(parameters_);
}

void ModeJets::set_parameters(std::size_t mode, std::span<const double> parameters) {
    (*this)(mode).set_parameters(parameters);
    next(mode).set_parameters(parameters);
}

} // namespace graze
