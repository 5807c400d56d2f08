#pragma once

#include "graze/tape/jet.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// Jets for the modes of a simulation, made when first needed.
class JetSet {
public:
    JetSet(const Simulation& simulation, LaneKind kind, InstructionSet set = best_instruction_set());
    /// The jet of a mode.
    Jet& operator()(std::size_t mode) { return made(jets_, mode, simulation_->order()); }
    /// The jet of a mode, computed from states: from what is known of them where they are those at the end of the last
    /// step.
    Jet& computed(std::size_t mode, std::span<const double> states) {
        Jet& jet = (*this)(mode);
        if (!end_jets_[mode] || !jet.compute_from(*end_jets_[mode], states))
            jet.compute(states);
        return jet;
    }
    /// One of order 1 for values alone: rates and outputs where a step of the other ends.
    Jet& end_jet(std::size_t mode) { return made(end_jets_, mode, 1); }
    /// Parameters [parameter * width + lane] for all modes, also those made later.
    void set_parameters(std::span<const double> parameters);
    int width() const { return width_; }
    const Simulation& simulation() const { return *simulation_; }

private:
    using Jets = std::vector<std::unique_ptr<Jet>>;
    Jet& made(Jets& jets, std::size_t mode, int order);

    const Simulation* simulation_;
    LaneKind kind_;
    InstructionSet set_;
    int width_;
    std::vector<double> parameters_;
    Jets jets_, end_jets_;
};

} // namespace graze
