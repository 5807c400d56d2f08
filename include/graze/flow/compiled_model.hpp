#pragma once

#include "graze/model/model.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/tape/tape.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// A model made ready for integration: a tape for each mode, functions for jumps, conditions and derivatives.
/// Immutable, so that threads may share one. Parameters are its inputs, not part of it.
///
/// Functions take the states followed by the independent parameters as inputs.
class CompiledModel {
public:
    /// @param observed expressions whose Taylor series are wanted along the flow besides those of watched events
    ///                 (in terms of the model's symbols); the same in every mode
    /// @throws InputError when the model is not valid (Model::validate)
    explicit CompiledModel(const Model& model, std::span<const Expression> observed = {});

    struct CompiledMode {
        Tape tape;                ///< outputs: the watched events in their order, then the observed expressions
        Function rates;           ///< the vector field alone
        Function events;          ///< the watched event functions alone
        Function evidence;        ///< rates, watched event functions, observed expressions: by which series are judged
        Function event_gradients; ///< and their derivatives with respect to the states, row by row
        std::vector<std::size_t> watched;
        std::vector<std::size_t> transitions; ///< of each watched event
        bool polynomial = false;              ///< all series end by themselves: whatever their length, steps are exact
        bool has_roots = false;               ///< sqrt or powers that are not whole, which have two branches at zero
        Function roots;                       ///< of those in the rates: what stands under one, and the exponent
    };
    struct CompiledJump {
        bool identity = false;
        Function map;
        Function jacobian; ///< row by row: states x (states + parameters)
    };
    struct CompiledAlternative {
        Function conditions; ///< one output per condition
        std::vector<bool> strict;
        std::optional<std::size_t> mode;
    };
    struct CompiledTransition {
        std::size_t jump;
        std::vector<CompiledAlternative> next;
    };

    const Model& model() const { return model_; }
    std::size_t states() const { return model_.states.size(); }
    std::size_t parameters() const { return parameters_; }
    std::size_t observed() const { return observed_; }
    const CompiledMode& mode(std::size_t index) const { return modes_[index]; }
    const CompiledJump& jump(std::size_t index) const { return jumps_[index]; }
    const CompiledTransition& transition(std::size_t index) const { return transitions_[index]; }
    /// Periods of the cyclic states (0 for others), from the parameters alone.
    const Function& periods() const { return periods_; }
    /// Initial state, from the parameters alone.
    const Function& initial() const { return initial_; }
    /// Largest workspace of all functions.
    std::size_t workspace() const { return workspace_; }

private:
    void compile_modes(std::span<const Expression> observed);
    void compile_jumps();
    void compile_transitions();
    Function function_of(std::span<const Expression> outputs);
    std::vector<Expression> roots_in(std::span<const Expression> expressions) const;
    std::vector<Expression> derivatives(std::span<const Expression> functions,
                                        std::span<const Expression> variables) const;

    Model model_;
    std::size_t parameters_ = 0, observed_ = 0, workspace_ = 0;
    std::vector<Expression> inputs_; ///< states, then independent parameters
    std::vector<CompiledMode> modes_;
    std::vector<CompiledJump> jumps_;
    std::vector<CompiledTransition> transitions_;
    Function periods_, initial_;
};

} // namespace graze
