#pragma once

#include "graze/flow/system.hpp"
#include "graze/tape/jet.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// Jets for the modes of a system, made when first needed. Each mode has two, which are used in turn: checking the end
/// of a step computes the beginning of the next one in the other jet.
class ModeJets {
public:
    /// @param order of the series
    ModeJets(const System& system, int order, LaneKind kind, InstructionSet set = best_instruction_set());
    /// Adds the variational equations to the jets (see System::linear). Jets made before are destroyed, and computed
    /// series lost. Has no effect if called again.
    void add_tangents();
    bool has_tangents() const { return has_tangents_; }
    /// Returns the jet of a mode, which exists until this object is destroyed or `add_tangents` is called; `computed`
    /// exchanges the two jets of a mode. @throws InputError, here and below, when there is no such mode
    Jet& operator()(std::size_t mode) { return made(jets_, mode); }
    /// Returns the jet of a mode computed from states. If the states are those at the end of the last step, the jet
    /// from `next` continues from there.
    Jet& computed(std::size_t mode, std::span<const double> states) {
        require_index(mode, jets_.size(), "mode");
        if (next_jets_[mode])
            jets_[mode].swap(next_jets_[mode]);
        Jet& jet = (*this)(mode);
        jet.compute(states);
        return jet;
    }
    /// Returns the jet for the next step, to be begun at the end of the present one.
    Jet& next(std::size_t mode) { return made(next_jets_, mode); }
    /// Sets parameters [parameter * width + lane] for all modes, including jets made later.
    void set_parameters(std::span<const double> parameters);
    /// The same for the jets of one mode only.
    void set_parameters(std::size_t mode, std::span<const double> parameters);
    int width() const { return width_; }
    int order() const { return order_; }

private:
    using Jets = std::vector<std::unique_ptr<Jet>>;
    Jet& made(Jets& jets, std::size_t mode) {
        require_index(mode, jets.size(), "mode");
        return jets[mode] ? *jets[mode] : make(jets, mode);
    }
    Jet& make(Jets& jets, std::size_t mode);

    System system_;
    int order_;
    LaneKind kind_;
    InstructionSet set_;
    int width_;
    bool has_tangents_ = false;
    std::vector<double> parameters_;
    Jets jets_, next_jets_;
};

} // namespace graze
