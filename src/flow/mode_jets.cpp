#include "graze/flow/mode_jets.hpp"

#include <utility>

namespace graze {

ModeJets::ModeJets(const System& system, int order, LaneKind kind, InstructionSet set)
    : system_(system), order_(order), kind_(kind), set_(set), width_(lanes_of(kind, set)),
      jets_(system.model().modes.size()), next_jets_(jets_.size()) {}

Jet& ModeJets::make(Jets& jets, std::size_t mode) {
    auto& jet = jets[mode];
    const Tape& tape = has_tangents_ ? system_.linear(mode).tape : system_.mode(mode).tape;
    jet = make_jet(tape, order_, kind_, set_);
    if (!parameters_.empty())
        jet->set_parameters(parameters_);
    return *jet;
}

void ModeJets::add_tangents() {
    if (std::exchange(has_tangents_, true))
        return;
    for (Jets* jets : {&jets_, &next_jets_})
        for (auto& jet : *jets)
            jet.reset();
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
