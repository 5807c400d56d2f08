#pragma once

#include "graze/flow/system.hpp"
#include "graze/tape/jet.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// Jets for the modes of a system, made when first needed: two of each, in turn that of a step and that of the
/// next, of which looking at the step's end makes the beginning.
class ModeJets {
public:
    /// @param order of the series
    ModeJets(const System& system, int order, LaneKind kind, InstructionSet set = best_instruction_set());
    /// From now on jets can be followed by derivatives (see System::linear): what has been computed is forgotten, and
    /// jets that have been handed out are gone. Again, it does nothing.
    void add_tangents();
    bool has_tangents() const { return has_tangents_; }
    /// The jet of a mode. Jets are there as long as this, or until `add_tangents`; `computed` exchanges a mode's two.
    /// @throws InputError, here and below, when there is no such mode
    Jet& operator()(std::size_t mode) { return made(jets_, mode); }
    /// The jet of a mode, computed from states, which becomes the present one: the next one has begun there if the
    /// states are those at the end of the last step.
    Jet& computed(std::size_t mode, std::span<const double> states) {
        require_index(mode, jets_.size(), "mode");
        if (next_jets_[mode])
            jets_[mode].swap(next_jets_[mode]);
        Jet& jet = (*this)(mode);
        jet.compute(states);
        return jet;
    }
    /// That of the next step, to be begun where the step ends.
    Jet& next(std::size_t mode) { return made(next_jets_, mode); }
    /// Parameters [parameter * width + lane] for all modes, also those made later.
    void set_parameters(std::span<const double> parameters);
    /// The same for the jets of one mode alone.
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
