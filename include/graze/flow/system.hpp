#pragma once

#include "graze/base/require.hpp"
#include "graze/flow/linear_mode.hpp"
#include "graze/model/model.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/tape/tape.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// A model that is frozen and compiled: a tape for each mode, functions for jumps, conditions and derivatives. What
/// computes shares one, from any number of threads; copies are handles of the same. Parameters are its inputs, not part
/// of it.
///
/// Functions take the states followed by the independent parameters as inputs.
class System {
public:
    /// Compiles a copy of the model: what happens to the model later has no effect. Threads may compile one model at
    /// once. That takes from a fraction of a millisecond to a second: compile once what is used often.
    /// @throws InputError when the model is not valid (Model::validate)
    explicit System(const Model& model);

    /// The derivatives of a function with respect to states that are not zero throughout.
    struct CompiledGradient {
        std::vector<std::size_t> states; ///< by which they are, rising
        Function values;
    };
    struct CompiledMode {
        Tape tape;                ///< outputs: the watched events in their order, then the observed expressions
        Function rates;           ///< the vector field alone
        Function events;          ///< the watched event functions alone
        Function evidence;        ///< rates, watched event functions, observed expressions: by which series are judged
        Function event_gradients; ///< and their derivatives with respect to the states, row by row
        std::vector<CompiledGradient> gradients; ///< the same, of each watched event by itself
        std::vector<std::size_t> watched;
        std::vector<std::size_t> transitions; ///< of each watched event
        bool polynomial = false;              ///< all series end by themselves: whatever their length, steps are exact
        bool has_roots = false;               ///< sqrt or powers that are not whole, which have two branches at zero
        Function roots;                       ///< of those in the rates: what stands under one, and the exponent
    };
    /// A map of states. In terms of the states that it changes: all others stay, and have derivatives of the identity.
    struct CompiledJump {
        struct Entry {
            std::size_t row = 0;    ///< a state that is changed
            std::size_t column = 0; ///< a state, or the number of states plus an independent parameter
        };
        bool identity = false;
        Function map;                     ///< of all states
        std::vector<std::size_t> changed; ///< states, rising
        std::vector<Entry> entries;       ///< derivatives that are not zero throughout, row by row
        Function jacobian;                ///< their values
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

    /// The same system whose tapes also give series of further expressions along the flow, in every mode.
    /// @param expressions in the model's symbols, of any graph
    /// @throws InputError for a symbol that the model does not have
    System observing(std::span<const Expression> expressions) const;

    /// The smooth motion of the modes alone, in which no event happens.
    System without_events() const;

    // @throws InputError, here and below, for an index that is out of range

    /// The model that was compiled. It cannot grow: for new expressions, copy it.
    const Model& model() const { return parts_->model; }
    std::size_t states() const { return parts_->states; }
    std::size_t parameters() const { return parts_->parameters; }
    std::size_t observed() const { return observed_.size(); }
    const CompiledMode& mode(std::size_t index) const { return at((*modes_), index, "mode"); }
    /// The first variational equations of a mode: compiled when first asked for, by whichever thread it is.
    const LinearMode& linear(std::size_t mode) const;
    const CompiledJump& jump(std::size_t index) const { return at(parts_->jumps, index, "jump"); }
    const CompiledTransition& transition(std::size_t index) const {
        return at(parts_->transitions, index, "transition");
    }
    /// A symmetry's map of states.
    const CompiledJump& symmetry(std::size_t index) const { return at(parts_->symmetries, index, "symmetry"); }
    /// An event's function: value, then derivatives with respect to states and parameters.
    const Function& event(std::size_t index) const { return at(parts_->events, index, "event"); }
    /// A section's function likewise; of a phase section, the state less the value. Of the image of the state under a
    /// symmetry, if one is given.
    const Function& section(std::size_t index, std::optional<std::size_t> symmetry = std::nullopt) const {
        if (symmetry)
            require_index(*symmetry, parts_->symmetries.size(), "symmetry");
        return at(parts_->sections, index, "section")[symmetry ? 1 + *symmetry : 0];
    }
    /// Periods of the cyclic states (0 for others), from the parameters alone.
    const Function& periods() const { return parts_->periods; }
    /// Their derivatives, row by row: states x parameters.
    const Function& period_gradients() const { return parts_->period_gradients; }
    /// Initial state, from the parameters alone; not yet within the periods.
    const Function& initial() const { return parts_->initial; }
    /// Compiles one more function of states and parameters. @param expressions in the model's symbols, of any graph
    /// @throws InputError for a symbol that the model does not have
    Function function_of(std::span<const Expression> expressions) const;
    /// The same of the parameters alone.
    Function function_of_parameters(std::span<const Expression> expressions) const;
    /// The same of one expression: value, then derivatives with respect to states and parameters.
    Function with_gradient(const Expression& expression) const;
    /// Largest workspace of the system's own functions.
    std::size_t workspace() const { return workspace_; }
    /// Largest number of entries of the jacobian of a jump or symmetry.
    std::size_t jacobian_entries() const { return parts_->jacobian_entries; }
    /// Operations of all functions and tapes together: by what memory and the time to compile go.
    std::size_t operations() const { return operations_; }

private:
    friend class SystemCompiler;
    template <class Item>
    static const Item& at(const std::vector<Item>& items, std::size_t index, const char* what) {
        require_index(index, items.size(), what);
        return items[index];
    }
    System with_tapes(std::vector<CompiledMode> modes, std::span<const Expression> observed) const;
    struct Parts {
        Model model;
        std::size_t states = 0, parameters = 0, jacobian_entries = 0;
        std::vector<CompiledJump> jumps, symmetries;
        std::vector<CompiledTransition> transitions;
        std::vector<Function> events;
        std::vector<std::vector<Function>> sections; ///< of each: as it is, then under each symmetry
        Function periods, period_gradients, initial;
    };
    std::shared_ptr<const Parts> parts_;
    struct LinearModes;
    std::shared_ptr<const std::vector<CompiledMode>> modes_;
    std::shared_ptr<LinearModes> linear_; ///< of these modes
    std::vector<Expression> observed_;    ///< in a graph that does not grow
    std::size_t workspace_ = 0, operations_ = 0;
};

} // namespace graze
