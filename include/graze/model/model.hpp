#pragma once

#include "graze/model/drawing.hpp"
#include "graze/model/parameter_id.hpp"
#include "graze/model/sliding.hpp"
#include "graze/model/state_map.hpp"
#include "graze/model/unilateral_contact.hpp"
#include "graze/symbolic/expression.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/parser.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

struct Parameter {
    std::string name{}, unit{}, text{};
    std::optional<double> value{};          ///< of an independent parameter
    std::optional<Expression> expression{}; ///< of a dependent one, in terms of other parameters
};

struct State {
    std::string name{}, unit{}, text{};
    Expression initial{};               ///< in terms of parameters
    std::optional<Expression> period{}; ///< of a cyclic state, in terms of parameters; its value is kept in [0, period)
    bool drifting = false;              ///< orbits are periodic up to a translation of this state
    /// Found by graze in models with conserved quantities: the drifting state with which this one is translated, as the
    /// place of a foot with that of a runner.
    std::optional<std::size_t> drifts_with{};
};

struct Definition {
    std::string name{}, text{};
    Expression value{}; ///< in terms of states, parameters and other definitions
};

struct Mode {
    std::string name{}, text{};
    std::vector<Expression> rates{};         ///< time derivative of each state
    std::vector<std::size_t> watched{};      ///< events; simultaneous ones are handled in this order
    std::vector<Expression> ends{};          ///< functions that are zero where it ends, besides those of `watched`
    bool derived = false;                    ///< here and below: made by `Model::complete` from a declaration
    std::vector<SlidingSurface> slides_on{}; ///< of a derived mode: the surfaces along which it moves
};

/// A barrier is positive on the admissible side and must not be crossed; a section may have either sign. Both occur
/// when their function falls through zero.
enum class EventKind { barrier, section };

struct Event {
    std::string name{}, text{};
    Expression function{};
    EventKind kind = EventKind::barrier;
    bool derived = false;
};

struct Jump {
    std::string name{}, text{};
    StateMap map{}; ///< each state after the jump, in terms of the states before
    bool derived = false;
};

/// One possible continuation of a transition, taken when all its conditions hold in the state after the jump.
struct Alternative {
    std::vector<Condition> when{};
    std::string when_text{};           ///< as the user wrote it; empty when unconditional
    std::optional<std::size_t> mode{}; ///< next mode; none: the trajectory ends
};

/// The continuation at an accumulation of contacts: infinitely many in a finite time (Budd and Dux 1994).
struct Sticking {
    std::size_t jump; ///< applied at the time of accumulation
    std::size_t mode;
};

struct Transition {
    std::string label{}; ///< name in signatures, such as J1; by default "mode:event"
    std::size_t mode = 0, event = 0, jump = 0;
    std::vector<Alternative> next{}; ///< the first alternative whose conditions hold is taken
    std::optional<Sticking> chatter{};
    bool derived = false;
    std::string otherwise{}; ///< of a derived one: why the motion ends when no condition holds, and what to do
    bool paradox = false;    ///< of a derived one: such an end is Painlevé's paradox
    /// Further events that must happen at the same time. Of the transitions of a mode and event, those of the most
    /// events at once come first.
    std::vector<std::size_t> also{};
    std::vector<Condition> when{}; ///< in the state before the jump: the first transition whose conditions hold is made
    std::string when_text{};
};

enum class Direction { falling, rising, both };

/// A surface at which states are recorded without disturbing the motion: a zero of `function`, or a value of
/// a cyclic state.
struct Section {
    std::string name{}, text{};
    Expression function{};                 ///< empty for a phase section
    std::optional<std::size_t> state{};    ///< cyclic state of a phase section
    Expression value{};                    ///< value of that state, in terms of parameters
    Direction direction = Direction::both; ///< of the crossings of `function`; a phase section follows its phase
};

/// A map of states that maps solutions to solutions.
struct Symmetry {
    std::string name{}, text{};
    std::vector<Expression> map{};
    std::vector<std::size_t> modes{}; ///< image of each mode
};

struct Quantity {
    std::string name{}, unit{}, text{};
    Expression value{}; ///< in terms of states, parameters and definitions
};

/// A function of the state that no motion changes, such as an energy.
struct ConservedQuantity {
    /// Its expression in one mode, where that is not `value`.
    struct InMode {
        std::string mode{};
        Expression value{};
    };
    std::string name{}, unit{}, text{};
    Expression value{}; ///< in terms of states, parameters and definitions; empty when each mode has its own
    std::vector<InMode> modes{};
};

/// Returns the index of the item of this name, if there is one.
template <typename Item>
std::optional<std::size_t> find_named(const std::vector<Item>& items, std::string_view name) {
    const auto found = std::ranges::find(items, name, &Item::name);
    return found == items.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - items.begin()));
}

/// What `Model::complete` has replaced, as it was: for writing a model as it was declared.
struct DeclaredParts {
    std::vector<Mode> modes{}; ///< those without rates are the ones to be made
    std::vector<Event> events{};
    std::vector<Jump> jumps{};
    std::vector<Transition> transitions{};
    std::vector<Symmetry> symmetries{};
    std::vector<Slide> slides{};
    std::vector<std::vector<std::size_t>> modes_of_shapes{};
    std::size_t initial_mode = 0;
};

/// The parts of a model. All expressions belong to its graph.
struct ModelItems {
    std::shared_ptr<Graph> graph;
    std::string name, text, source;
    std::string time_unit;
    std::vector<Parameter> parameters;
    std::vector<State> states;
    std::vector<Definition> definitions;
    std::vector<Mode> modes;
    std::vector<Event> events;
    std::vector<Jump> jumps;
    std::vector<Transition> transitions;
    std::vector<Section> sections;
    std::vector<Symmetry> symmetries;
    std::vector<Quantity> quantities;
    std::vector<ConservedQuantity> conserved;
    std::vector<Slide> slides;
    std::vector<Friction> frictions;
    std::vector<UnilateralContact> contacts;
    ContactSettings contact_settings;
    std::optional<ModelDrawing> drawing;
    std::size_t initial_mode = 0;
    /// If not empty, the initial mode is that of the first whose conditions hold in the initial state.
    std::vector<Alternative> initial_modes;
    std::shared_ptr<const DeclaredParts> declared; ///< of a completed model with slides, frictions or contacts
};

/// A hybrid dynamical system, ready to be compiled. Expressions are in terms of the symbols of states, parameters and
/// definitions; `expand` reduces them to states and independent parameters. Jump 0 is always the identity. A copy has
/// its own graph, so that each thread can work on a copy. A compiled System does not depend on the model.
struct Model : ModelItems {
    Model();
    Model(const Model& other);
    Model(Model&&) noexcept = default;
    Model& operator=(const Model& other);
    Model& operator=(Model&&) noexcept = default;
    ~Model() = default;

    Expression number(double value) const { return graph->number(value); }
    Expression symbol(std::string_view item) const { return graph->symbol(item); }
    std::vector<Expression> state_symbols() const;
    /// Returns symbols of the independent parameters, in the order of `parameters`.
    std::vector<Expression> parameter_symbols() const;
    /// Returns the inputs of all compiled functions: the states, then the independent parameters.
    std::vector<Expression> inputs() const;
    /// Returns the values of the independent parameters, in the order of `parameters`.
    std::vector<double> parameter_values() const;
    /// Replaces definitions and dependent parameters by their expressions. Appends to the graph; expressions of other
    /// graphs are adopted, their symbols matched by name.
    /// @throws InputError when definitions or dependent parameters are circular
    Expression expand(const Expression& expression);
    std::vector<Expression> expand(std::span<const Expression> expressions);
    /// @throws InputError, with the nearest name, when the expressions contain other symbols than `inputs`
    void require_known(std::span<const Expression> inputs, std::span<const Expression> expressions) const;
    /// Forbids the graph to grow. Graphs of copies can grow.
    void freeze();

    /// Returns the names of the independent parameters, in the order of `parameters`.
    std::vector<std::string> independent_parameters() const;
    /// Returns the independent parameter of this name, if there is one.
    std::optional<ParameterId> find_independent_parameter(std::string_view item) const;
    /// Returns it. @throws InputError for a dependent parameter, and for an unknown name (with the nearest)
    ParameterId independent_parameter(std::string_view item) const;

    /// Return the index of the named item.
    std::optional<std::size_t> find_parameter(std::string_view item) const { return find_named(parameters, item); }
    std::optional<std::size_t> find_state(std::string_view item) const { return find_named(states, item); }
    std::optional<std::size_t> find_mode(std::string_view item) const { return find_named(modes, item); }
    std::optional<std::size_t> find_event(std::string_view item) const { return find_named(events, item); }
    std::optional<std::size_t> find_jump(std::string_view item) const { return find_named(jumps, item); }
    std::optional<std::size_t> find_section(std::string_view item) const { return find_named(sections, item); }
    std::optional<std::size_t> find_quantity(std::string_view item) const { return find_named(quantities, item); }
    /// Returns the unit of the parameter of this name; empty if there is none.
    std::string parameter_unit(std::string_view name) const;
    /// Returns the first transition of an event in a mode. Null when there is none; valid until transitions are added
    /// or removed.
    const Transition* find_transition(std::size_t mode, std::size_t event) const;

    /// Sets an independent parameter.
    /// @throws InputError for an unknown name (with the nearest), a dependent parameter, or a value that is not finite
    void set_parameter(std::string_view item, double value);
    /// Sets the initial value of a state; an initial mode with friction follows its velocity.
    /// @throws InputError as above
    void set_initial(std::string_view item, double value);
    /// @throws InputError for an unknown name (with the nearest)
    void set_initial_mode(std::string_view item);
    /// Returns the initial state at the present parameters, cyclic states within their period.
    /// @throws InputError when a value is not finite or a period not positive
    std::vector<double> initial_state() const;

    /// Compiles expressions in the model's symbols, of any graph, to a function of states and independent parameters.
    /// @throws InputError for a symbol that the model does not have
    Function function_of(std::span<const Expression> expressions) const;
    /// Compiles expressions in parameters only to a function of the independent parameters.
    Function function_of_parameters(std::span<const Expression> expressions) const;
    /// Returns values of expressions in parameters at the present values; not finite outside an operation's domain.
    std::vector<double> values_of(std::span<const Expression> expressions) const;
    /// Returns the period of each state at the present parameters; 0 if the state is not cyclic.
    std::vector<double> periods() const;

    /// Makes the modes, events, jumps and transitions that slides, frictions and contacts stand for. To be called once,
    /// when all parts are there; `read_model` does it. Without these, or after the first call, nothing changes.
    /// @throws InputError for a declaration that cannot be completed
    void complete();
    /// Checks everything on which a compiled model relies: sizes, indices, names, symbols, circular definitions,
    /// finite parameters, periods positive. @throws InputError naming the first thing wrong
    void validate() const;
};

} // namespace graze
