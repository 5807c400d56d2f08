#pragma once

#include "graze/base/require.hpp"
#include "graze/model/model.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/piece_table.hpp"
#include "graze/tape/tape.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace graze {

class UniformisedSystem;

/// The first variational equations of a mode, compiled with its tape: derivatives of rates and watched events with
/// respect to states and parameters.
struct LinearMode {
    /// The mode's tape, equal bit for bit, with the coefficients of the equations as deferred expressions.
    Tape tape;
    TangentEquations equations;
    /// Derivatives of the watched events' functions: rows are events in the order of the mode.
    std::vector<TangentEntry> events;

    /// Groups of deferred expressions: coefficients of states, derivatives of events, and coefficients of each
    /// parameter.
    static constexpr std::uint32_t by_states = 0, of_events = 1;
    static constexpr std::uint32_t by_parameter(std::size_t parameter) {
        return 2 + static_cast<std::uint32_t>(parameter);
    }
};

/// Options of `System`.
struct SystemOptions {
    /// Whether long runs of single trajectories may compute by machine code made from the model's tapes: the same
    /// results, bit for bit, in less time. See `MachineCode`.
    bool machine_code = true;
};

/// A model, frozen and compiled: a tape for each mode, functions for jumps, conditions and derivatives. All
/// computations share one system, from any number of threads; copies are handles to the same object. Parameters are
/// inputs, not part of the system.
///
/// Functions take the states followed by the independent parameters as inputs.
class System {
public:
    /// Compiles a copy of the model: later changes of the model have no effect. Several threads may compile one model
    /// at once. Compiling takes from a fraction of a millisecond to a second: compile once what is used often.
    /// @throws InputError when the model is not valid (Model::validate)
    explicit System(const Model& model, SystemOptions options = {});

    /// The derivatives of a function with respect to states that are not identically zero.
    struct CompiledGradient {
        std::vector<std::size_t> states; ///< with respect to which the derivatives are taken, rising
        Function values;
    };
    struct CompiledMode {
        /// Outputs: the watched events in their order, then the observed expressions, then the arguments of tables.
        Tape tape;
        /// The vector field alone. Powers whose argument is the function of an event of the mode are 0 beyond the
        /// event.
        Function rates;
        Function events;          ///< the watched event functions alone
        Function evidence;        ///< rates, watched event functions, observed expressions: values for StepCheck
        Function event_gradients; ///< derivatives of the watched event functions with respect to the states, row by row
        std::vector<CompiledGradient> gradients; ///< the same, separately for each watched event
        std::vector<std::size_t> watched;
        std::vector<std::size_t> transitions; ///< transition of each watched event
        bool polynomial = false;              ///< all series are finite: steps of any length are exact
        bool ends_at_root = false;            ///< the argument of a root or power is the function of an event
        bool has_roots = false;               ///< the rates contain sqrt or non-integer powers, which branch at zero
        std::vector<std::shared_ptr<const PieceTable>> tables; ///< that rates and outputs look up
        Function table_arguments;                              ///< of each of them
        Function roots; ///< for each of these: its radicand (base), and the exponent
    };
    /// A map of states. Stored for the states that it changes; all others stay, with the derivatives of the identity.
    struct CompiledJump {
        struct Entry {
            std::size_t row = 0;    ///< a state that is changed
            std::size_t column = 0; ///< a state, or the number of states plus an independent parameter
        };
        bool identity = false;
        Function map;                     ///< image of all states
        std::vector<std::size_t> changed; ///< states, rising
        std::vector<Entry> entries;       ///< derivatives that are not identically zero, row by row
        Function jacobian;                ///< values of the entries
    };
    struct CompiledAlternative {
        Function conditions; ///< one output per condition
        std::vector<bool> strict;
        std::optional<std::size_t> mode;
    };
    struct CompiledTransition {
        std::size_t jump;
        Function when; ///< conditions before the jump
        std::vector<bool> strict;
        std::vector<std::size_t> also;        ///< events that must happen at the same time, rising
        std::optional<std::size_t> following; ///< next transition of the same mode and event
        bool one_of_many = false;             ///< there are several of this mode and event
        std::vector<CompiledAlternative> next;
    };

    /// The contacts of a model in one of its written modes, if they have no friction and impacts follow one another.
    struct CompiledContacts {
        std::size_t base = 0;                ///< the written mode, in which all are open
        std::vector<std::size_t> events;     ///< at which each of n contacts closes
        std::vector<std::size_t> velocities; ///< states that impulses change
        /// Of each contact: its gap, the rate of this, its acceleration without contact forces, and the coefficient of
        /// restitution, n numbers each; then, row by row, the change of each rate by a unit impulse in each contact;
        /// then for each contact the change of the velocities by a unit impulse.
        Function values;
    };
    /// What a mode has of them.
    struct ContactsOfMode {
        std::size_t contacts = 0; ///< see `contacts`
        std::vector<bool> closed; ///< which of them are
    };

    /// Returns the same system, with tapes that also compute series of further expressions along the flow, in every
    /// mode.
    /// @param expressions in the model's symbols, of any graph
    /// @throws InputError for a symbol that the model does not have
    System observing(std::span<const Expression> expressions) const;

    /// Returns the same system without events: the smooth motion of each mode.
    System without_events() const;

    // @throws InputError, here and below, for an index that is out of range

    /// Returns the compiled model. Its graph cannot grow: for new expressions, copy it.
    const Model& model() const { return parts_->model; }
    const SystemOptions& options() const { return parts_->options; }
    std::size_t states() const { return parts_->states; }
    std::size_t parameters() const { return parts_->parameters; }
    std::size_t observed() const { return observed_.size(); }
    const CompiledMode& mode(std::size_t index) const { return item_at(*modes_, index, "mode"); }
    /// Returns the first variational equations of a mode. They are compiled at the first call; thread-safe.
    const LinearMode& linear(std::size_t mode) const;
    /// Returns the modes in variables in which motions are analytic where the argument of a root or power vanishes.
    /// They are compiled at the first call; thread-safe.
    const UniformisedSystem& uniformised() const;
    const CompiledJump& jump(std::size_t index) const { return item_at(parts_->jumps, index, "jump"); }
    const CompiledTransition& transition(std::size_t index) const {
        return item_at(parts_->transitions, index, "transition");
    }
    /// Returns what a mode has of contacts without friction of which at least two can be closed, whose impacts follow
    /// one another; null if it has none.
    const ContactsOfMode* contacts_of(std::size_t mode) const {
        const auto& one = item_at(parts_->contact_modes, mode, "mode");
        return one ? &*one : nullptr;
    }
    const CompiledContacts& contacts(std::size_t index) const { return item_at(parts_->contacts, index, "contacts"); }
    /// Returns a symmetry's map of states.
    const CompiledJump& symmetry(std::size_t index) const { return item_at(parts_->symmetries, index, "symmetry"); }
    /// Returns an event's function: value, then derivatives with respect to states and parameters.
    const Function& event(std::size_t index) const { return item_at(parts_->events, index, "event"); }
    /// Returns a section's function in the same form; for a phase section, the state less its value. With a symmetry,
    /// it is the function of the image of the state.
    const Function& section(std::size_t index, std::optional<std::size_t> symmetry = std::nullopt) const {
        if (symmetry)
            require_index(*symmetry, parts_->symmetries.size(), "symmetry");
        return item_at(parts_->sections, index, "section")[symmetry ? 1 + *symmetry : 0];
    }
    /// Returns the periods of the cyclic states (0 for others), as a function of the parameters.
    const Function& periods() const { return parts_->periods; }
    /// Returns their derivatives, row by row: states x parameters.
    const Function& period_gradients() const { return parts_->period_gradients; }
    /// Returns the initial state as a function of the parameters; not yet reduced to the periods.
    const Function& initial() const { return parts_->initial; }
    /// Compiles another function of states and parameters. @param expressions in the model's symbols, of any graph
    /// @throws InputError for a symbol that the model does not have
    Function function_of(std::span<const Expression> expressions) const;
    /// The same for a function of the parameters only.
    Function function_of_parameters(std::span<const Expression> expressions) const;
    /// The same for one expression: value, then derivatives with respect to states and parameters.
    Function with_gradient(const Expression& expression) const;
    /// Returns the largest workspace of the system's own functions.
    std::size_t workspace() const { return workspace_; }
    /// Returns the largest number of entries of the Jacobian of a jump or symmetry.
    std::size_t jacobian_entries() const { return parts_->jacobian_entries; }
    /// Returns the number of operations of all functions and tapes: memory and compile time are proportional to it.
    std::size_t operations() const { return operations_; }

private:
    friend class SystemCompiler;
    friend class VariationalSystem;
    System with_tapes(std::vector<CompiledMode> modes, std::span<const Expression> observed) const;
    struct Parts {
        Model model;
        SystemOptions options;
        std::size_t states = 0, parameters = 0, jacobian_entries = 0;
        std::vector<CompiledJump> jumps, symmetries;
        std::vector<CompiledTransition> transitions;
        std::vector<CompiledContacts> contacts;
        std::vector<std::optional<ContactsOfMode>> contact_modes; ///< of each mode
        std::vector<Function> events;
        std::vector<std::vector<Function>> sections; ///< for each section: its function, then that under each symmetry
        Function periods, period_gradients, initial;
    };
    std::shared_ptr<const Parts> parts_;
    struct LinearModes;
    struct Uniformised;
    struct Variations; ///< see VariationalSystem
    std::shared_ptr<const std::vector<CompiledMode>> modes_;
    std::shared_ptr<LinearModes> linear_;      ///< variational equations of these modes
    std::shared_ptr<Uniformised> uniformised_; ///< of the model, whatever is observed
    std::shared_ptr<Variations> variations_;   ///< of the model, whatever is observed
    std::vector<Expression> observed_;         ///< observed expressions, in a frozen graph
    std::size_t workspace_ = 0, operations_ = 0;
};

} // namespace graze
