#include "graze/flow/system.hpp"

#include "flow/lie_derivative.hpp"
#include "flow/section_function.hpp"
#include "flow/uniformised_system.hpp"
#include "flow/variations.hpp"
#include "graze/base/input_error.hpp"
#include "graze/symbolic/linearisation.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/contact_modes.hpp"
#include "model/model_expand.hpp"
#include "model/model_expressions.hpp"
#include "symbolic/subgraph.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <utility>

namespace graze {

/// Compiles in a copy of the model, whose graph may grow and is discarded afterwards.
class SystemCompiler {
public:
    explicit SystemCompiler(const Model& model)
        : model_(model), expander_(model_), states_(model_.state_symbols()), parameters_(model_.parameter_symbols()),
          inputs_(model_.inputs()) {}

    void compile(System::Parts& parts) {
        compile_maps(parts);
        compile_transitions(parts);
        compile_contacts(parts);
        compile_surfaces(parts);
        std::vector<Expression> periods, initial;
        for (const State& state : model_.states) {
            periods.push_back(state.period ? *state.period : model_.graph->number(0));
            initial.push_back(state.initial);
        }
        periods = expander_.expand(periods);
        parts.periods = compile(parameters_, periods);
        parts.period_gradients = compile_derivatives(parameters_, periods, parameters_);
        parts.initial = function_of_parameters(initial);
    }
    std::vector<System::CompiledMode> compile_modes();
    /// Recompiles the tapes of compiled modes with observed expressions.
    void observe(std::vector<System::CompiledMode>& modes, std::span<const Expression> observed);
    LinearMode linearise(const System& system, std::size_t mode, std::span<const Expression> observed);
    std::vector<Expression> expanded(std::span<const Expression> expressions) { return expander_.expand(expressions); }

    Function function_of(std::span<const Expression> outputs) { return compile(inputs_, expander_.expand(outputs)); }
    Function function_of_parameters(std::span<const Expression> outputs) {
        return compile(parameters_, expander_.expand(outputs));
    }
    Function with_gradient(const Expression& expression) {
        const Expression value = expander_.expand(expression);
        std::vector<Function::Output> outputs{{0, value}};
        for (JacobianEntry& entry : sparse_jacobian({&value, 1}, inputs_))
            outputs.push_back({1 + entry.column, std::move(entry.value)});
        return compile(inputs_, 1 + inputs_.size(), outputs, Function::Others::zero);
    }
    /// Largest workspace of all functions compiled.
    std::size_t workspace() const { return workspace_; }
    /// Operations of all functions and tapes compiled.
    std::size_t operations() const { return operations_; }

private:
    void compile_maps(System::Parts& parts);
    void compile_transitions(System::Parts& parts);
    void compile_contacts(System::Parts& parts);
    Function contact_values(std::size_t base);
    void compile_surfaces(System::Parts& parts);
    void compile_tape(System::CompiledMode& compiled, const std::vector<Expression>& rates,
                      std::vector<Expression> outputs);
    std::vector<Expression> add_arguments(const std::vector<Expression>& rates, std::vector<Expression>& outputs);
    std::vector<Expression> watched_functions(const System::CompiledMode& compiled);
    std::vector<Expression> with_observed(std::vector<Expression> outputs, std::span<const Expression> observed);
    System::CompiledJump map_of(const StateMap& map);
    std::vector<Expression> roots_in(std::span<const Expression> expanded);
    Function compile(const SymbolIndex& inputs, std::span<const Expression> outputs);
    Function compile(const SymbolIndex& inputs, std::size_t outputs, std::span<const Function::Output> given,
                     Function::Others others);
    Function compile_derivatives(const SymbolIndex& inputs, std::span<const Expression> functions,
                                 const SymbolIndex& symbols);
    System::CompiledGradient gradient_of(const Expression& function);
    Function counted(Function function);
    template <class... Arguments>
    Function checked(const SymbolIndex& inputs, std::span<const Expression> values, Arguments&&... arguments);

    Model model_;
    Expander expander_;
    SymbolIndex states_, parameters_, inputs_;
    std::shared_ptr<const std::vector<Expression>> identity_; ///< see changes_of
    std::size_t workspace_ = 0, operations_ = 0;
};

/// The variational equations of each mode, compiled when first needed.
struct System::LinearModes {
    struct Item {
        std::once_flag compiled;
        std::optional<LinearMode> mode;
    };
    explicit LinearModes(std::size_t modes) : items(modes) {}
    std::vector<Item> items;
};

/// The same in variables in which radicands may vanish.
struct System::Uniformised {
    std::once_flag compiled;
    std::optional<UniformisedSystem> system;
};

namespace {

void apply(const SystemOptions& options, Tape& tape) {
    if (!options.machine_code)
        tape.native_codes = nullptr;
}

} // namespace

System::System(const Model& model, SystemOptions options) {
    auto parts = std::make_shared<Parts>();
    parts->model = model;
    parts->options = options;
    parts->model.validate();
    parts->states = model.states.size();
    parts->parameters = parts->model.parameter_symbols().size();
    SystemCompiler compiler(parts->model);
    compiler.compile(*parts);
    std::vector<CompiledMode> modes = compiler.compile_modes();
    for (CompiledMode& mode : modes)
        apply(options, mode.tape);
    modes_ = std::make_shared<const std::vector<CompiledMode>>(std::move(modes));
    linear_ = std::make_shared<LinearModes>(modes_->size());
    uniformised_ = std::make_shared<Uniformised>();
    variations_ = std::make_shared<Variations>();
    workspace_ = compiler.workspace();
    operations_ = compiler.operations();
    parts->model.freeze();
    parts_ = std::move(parts);
}

/// Returns the same system with these modes, whose tapes are recompiled.
System System::with_tapes(std::vector<CompiledMode> modes, std::span<const Expression> observed) const {
    System result = *this;
    SystemCompiler compiler(model());
    compiler.observe(modes, observed);
    for (CompiledMode& mode : modes)
        apply(options(), mode.tape);
    result.modes_ = std::make_shared<const std::vector<CompiledMode>>(std::move(modes));
    result.linear_ = std::make_shared<LinearModes>(result.modes_->size());
    result.observed_ = compiler.expanded(observed);
    result.workspace_ = std::max(workspace_, compiler.workspace());
    result.operations_ += compiler.operations();
    return result;
}

const LinearMode& System::linear(std::size_t mode) const {
    require_index(mode, modes_->size(), "mode");
    LinearModes::Item& item = linear_->items[mode];
    std::call_once(item.compiled, [&] {
        item.mode = SystemCompiler(model()).linearise(*this, mode, observed_);
        apply(options(), item.mode->tape);
    });
    return *item.mode;
}

const UniformisedSystem& System::uniformised() const {
    std::call_once(uniformised_->compiled, [&] { uniformised_->system.emplace(*this); });
    return *uniformised_->system;
}

System System::observing(std::span<const Expression> expressions) const {
    return with_tapes(*modes_, expressions);
}

System System::without_events() const {
    auto modes = *modes_;
    const Function nothing = function_of({});
    for (CompiledMode& mode : modes) {
        mode.watched.clear();
        mode.transitions.clear();
        mode.events = mode.event_gradients = nothing;
        mode.gradients.clear();
    }
    return with_tapes(std::move(modes), {});
}

Function System::function_of(std::span<const Expression> expressions) const {
    return model().function_of(expressions);
}

Function System::function_of_parameters(std::span<const Expression> expressions) const {
    return model().function_of_parameters(expressions);
}

Function System::with_gradient(const Expression& expression) const {
    return SystemCompiler(model()).with_gradient(expression);
}

Function SystemCompiler::counted(Function function) {
    workspace_ = std::max(workspace_, function.workspace());
    operations_ += function.operations();
    return function;
}

/// A function reports unknown symbols itself; only then are they searched for a message, since that takes time.
template <class... Arguments>
Function SystemCompiler::checked(const SymbolIndex& inputs, std::span<const Expression> values,
                                 Arguments&&... arguments) {
    try {
        return counted({inputs, std::forward<Arguments>(arguments)...});
    } catch (const InputError&) {
        model_.require_known(inputs.symbols(), values);
        throw;
    }
}

Function SystemCompiler::compile(const SymbolIndex& inputs, std::span<const Expression> outputs) {
    return checked(inputs, outputs, outputs);
}

Function SystemCompiler::compile(const SymbolIndex& inputs, std::size_t outputs,
                                 std::span<const Function::Output> given, Function::Others others) {
    std::vector<Expression> values;
    for (const Function::Output& output : given)
        values.push_back(output.value);
    return checked(inputs, values, outputs, given, others);
}

/// Compiles derivatives row by row: functions x symbols.
Function SystemCompiler::compile_derivatives(const SymbolIndex& inputs, std::span<const Expression> functions,
                                             const SymbolIndex& symbols) {
    std::vector<Function::Output> outputs;
    for (JacobianEntry& entry : sparse_jacobian(functions, symbols))
        outputs.push_back({entry.row * symbols.size() + entry.column, std::move(entry.value)});
    return compile(inputs, functions.size() * symbols.size(), outputs, Function::Others::zero);
}

System::CompiledGradient SystemCompiler::gradient_of(const Expression& function) {
    System::CompiledGradient gradient;
    std::vector<Expression> values;
    for (JacobianEntry& entry : sparse_jacobian({&function, 1}, states_)) {
        gradient.states.push_back(entry.column);
        values.push_back(std::move(entry.value));
    }
    gradient.values = compile(inputs_, values);
    return gradient;
}

/// Returns the radicand or base of each root or power in some expressions, followed by its exponent.
std::vector<Expression> SystemCompiler::roots_in(std::span<const Expression> expanded) {
    const Subgraph part = subgraph_of(expanded);
    std::vector<Expression> roots;
    for (const Subgraph::Item& item : part.items) {
        const Operation operation = part.node(item).operation;
        if (operation != Operation::sqrt && operation != Operation::power)
            continue;
        roots.push_back(part.expression(part.items[item.left]));
        roots.push_back(operation == Operation::sqrt ? model_.graph->number(0.5)
                                                     : part.expression(part.items[item.right]));
    }
    return roots;
}

std::vector<Expression> SystemCompiler::watched_functions(const System::CompiledMode& compiled) {
    std::vector<Expression> functions;
    for (const std::size_t event : compiled.watched)
        functions.push_back(model_.events[event].function);
    return expander_.expand(functions);
}

/// Returns the outputs of a tape in their order.
std::vector<Expression> SystemCompiler::with_observed(std::vector<Expression> outputs,
                                                      std::span<const Expression> observed) {
    const std::vector<Expression> more = expander_.expand(observed);
    outputs.insert(outputs.end(), more.begin(), more.end());
    return outputs;
}

std::vector<System::CompiledMode> SystemCompiler::compile_modes() {
    std::vector<System::CompiledMode> modes;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> transitions;
    for (std::size_t i = 0; i < model_.transitions.size(); ++i)
        transitions.emplace(std::pair(model_.transitions[i].mode, model_.transitions[i].event), i);
    for (std::size_t m = 0; m < model_.modes.size(); ++m) {
        const Mode& mode = model_.modes[m];
        System::CompiledMode compiled;
        for (const std::size_t event : mode.watched) {
            const auto transition = transitions.find({m, event});
            if (transition == transitions.end())
                continue; // a section without a transition: the motion passes through
            compiled.watched.push_back(event);
            compiled.transitions.push_back(transition->second);
        }
        const std::vector<Expression> rates = expander_.expand(mode.rates), outputs = watched_functions(compiled);
        const std::vector<Expression> roots = roots_in(rates);
        const std::vector<Expression> extended =
            roots.empty() ? rates : extended_rates(rates, ends_of_mode(model_, m), states_);
        compiled.ends_at_root = extended != rates;
        compiled.rates = compile(inputs_, extended);
        compiled.events = compile(inputs_, outputs);
        compiled.event_gradients = compile_derivatives(inputs_, outputs, states_);
        for (const Expression& function : outputs)
            compiled.gradients.push_back(gradient_of(function));
        compiled.roots = compile(inputs_, roots);
        compile_tape(compiled, rates, outputs);
        modes.push_back(std::move(compiled));
    }
    return modes;
}

void SystemCompiler::observe(std::vector<System::CompiledMode>& modes, std::span<const Expression> observed) {
    for (std::size_t m = 0; m < modes.size(); ++m) {
        compile_tape(modes[m], expander_.expand(model_.modes[m].rates),
                     with_observed(watched_functions(modes[m]), observed));
    }
}

LinearMode SystemCompiler::linearise(const System& system, std::size_t mode, std::span<const Expression> observed) {
    const std::vector<Expression> rates = expander_.expand(model_.modes[mode].rates),
                                  events = watched_functions(system.mode(mode));
    const std::size_t states = states_.size();
    LinearMode linear;
    std::vector<DeferredExpression> deferred;
    const auto add = [&](std::vector<TangentEntry>& entries, std::size_t row, std::size_t source, Expression value,
                         std::uint32_t group) {
        const bool by_parameter = source >= states && source < inputs_.size();
        entries.push_back({row, source, deferred.size()});
        deferred.push_back({std::move(value), by_parameter ? LinearMode::by_parameter(source - states) : group});
    };
    Linearisation linearisation = graze::linearise(rates, inputs_, states);
    linear.equations = {states, parameters_.size(), linearisation.intermediates, {}};
    for (LinearEntry& entry : linearisation.entries)
        add(linear.equations.entries, entry.row, entry.source, std::move(entry.coefficient), LinearMode::by_states);
    for (JacobianEntry& entry : sparse_jacobian(events, inputs_))
        add(linear.events, entry.row, entry.column, std::move(entry.value), LinearMode::of_events);
    std::vector<Expression> outputs = with_observed(events, observed);
    add_arguments(rates, outputs);
    linear.tape = graze::compile_tape(states_.symbols(), parameters_.symbols(), rates, outputs, deferred);
    return linear;
}

/// Adds the arguments at which tables are looked up to the outputs of a tape. @return the lookups
std::vector<Expression> SystemCompiler::add_arguments(const std::vector<Expression>& rates,
                                                      std::vector<Expression>& outputs) {
    if (model_.graph->tables().empty())
        return {};
    std::vector<Expression> all = rates, lookups;
    all.insert(all.end(), outputs.begin(), outputs.end());
    const Subgraph part = subgraph_of(all);
    std::set<std::pair<std::size_t, NodeIndex>> known; // tables and arguments
    for (const Subgraph::Item& item : part.items) {
        const Node& node = part.node(item);
        if (node.operation != Operation::lookup || !known.emplace(Graph::lookup_of(node).table, node.left).second)
            continue;
        lookups.push_back(part.expression(item));
        outputs.push_back(part.expression(part.items[item.left]));
    }
    return lookups;
}

void SystemCompiler::compile_tape(System::CompiledMode& compiled, const std::vector<Expression>& rates,
                                  std::vector<Expression> outputs) {
    const std::vector<Expression> lookups = add_arguments(rates, outputs);
    compiled.tables.clear();
    for (const Expression& lookup : lookups)
        compiled.tables.push_back(lookup.graph()->tables()[Graph::lookup_of(lookup.node()).table]);
    compiled.table_arguments = compile(inputs_, std::span(outputs).last(lookups.size()));
    std::vector<Expression> all = rates;
    all.insert(all.end(), outputs.begin(), outputs.end());
    compiled.evidence = compile(inputs_, all); // reports unknown symbols
    compiled.tape = graze::compile_tape(states_.symbols(), parameters_.symbols(), rates, outputs);
    operations_ += compiled.tape.code.size();
    compiled.polynomial = std::all_of(compiled.tape.degrees.begin(), compiled.tape.degrees.end(),
                                      [](std::uint32_t degree) { return degree != Tape::unbounded; });
    compiled.has_roots = std::any_of(compiled.tape.code.begin(), compiled.tape.code.end(), [](const auto& one) {
        return one.operation == SeriesOperation::sqrt || one.operation == SeriesOperation::power_constant;
    });
}

System::CompiledJump SystemCompiler::map_of(const StateMap& map) {
    System::CompiledJump compiled;
    std::vector<Function::Output> images;
    std::vector<Expression> changed;
    // An expression may expand to the state itself.
    for (const StateMap::Change& change : changes_of(map, states_.symbols(), identity_))
        if (const Expression image = expander_.expand(change.image); !(image == states_.symbols()[change.state])) {
            compiled.changed.push_back(change.state);
            images.push_back({change.state, image});
            changed.push_back(image);
        }
    compiled.identity = changed.empty();
    compiled.map = compile(inputs_, states_.size(), images, Function::Others::inputs);
    std::vector<Expression> values;
    for (JacobianEntry& entry : sparse_jacobian(changed, inputs_)) {
        compiled.entries.push_back({compiled.changed[entry.row], entry.column});
        values.push_back(std::move(entry.value));
    }
    compiled.jacobian = compile(inputs_, values);
    return compiled;
}

void SystemCompiler::compile_maps(System::Parts& parts) {
    for (const Jump& jump : model_.jumps)
        parts.jumps.push_back(map_of(jump.map));
    for (const Symmetry& symmetry : model_.symmetries)
        parts.symmetries.push_back(map_of(symmetry.map));
    for (const auto* maps : {&parts.jumps, &parts.symmetries})
        for (const System::CompiledJump& map : *maps)
            parts.jacobian_entries = std::max(parts.jacobian_entries, map.entries.size());
}

void SystemCompiler::compile_transitions(System::Parts& parts) {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> last;
    for (const Transition& transition : model_.transitions) {
        System::CompiledTransition compiled;
        compiled.jump = transition.jump;
        compiled.also = transition.also;
        std::ranges::sort(compiled.also);
        std::vector<Expression> before;
        for (const Condition& condition : transition.when) {
            before.push_back(condition.function);
            compiled.strict.push_back(condition.strict);
        }
        compiled.when = function_of(before);
        const auto [known, added] =
            last.emplace(std::pair(transition.mode, transition.event), parts.transitions.size());
        if (!added) {
            System::CompiledTransition& previous = parts.transitions[known->second];
            previous.following = parts.transitions.size();
            previous.one_of_many = compiled.one_of_many = true;
            known->second = parts.transitions.size();
        }
        for (const Alternative& alternative : transition.next) {
            std::vector<Expression> conditions;
            System::CompiledAlternative way;
            for (const Condition& condition : alternative.when) {
                conditions.push_back(condition.function);
                way.strict.push_back(condition.strict);
            }
            way.conditions = function_of(conditions);
            way.mode = alternative.mode;
            compiled.next.push_back(std::move(way));
        }
        parts.transitions.push_back(std::move(compiled));
    }
}

/// Contacts that hit one another come to rest together, for which their mechanics is needed; see `JointRest`.
void SystemCompiler::compile_contacts(System::Parts& parts) {
    parts.contact_modes.resize(model_.modes.size());
    const auto rubs = [](const UnilateralContact& one) { return one.friction.has_value(); };
    if (model_.contacts.size() < 2 || model_.contact_settings.law != ImpactLaw::sequence ||
        std::ranges::any_of(model_.contacts, rubs))
        return;
    std::vector<std::size_t> events;
    for (const UnilateralContact& contact : model_.contacts)
        if (const auto event = model_.find_event(contact.name))
            events.push_back(*event);
    if (events.size() < model_.contacts.size())
        return; // not completed
    for (const std::size_t base : modes_with_contacts(model_)) {
        for (std::size_t m = 0; m < model_.modes.size(); ++m) {
            System::ContactsOfMode here{parts.contacts.size(), std::vector<bool>(events.size(), false)};
            std::string name = model_.modes[base].name;
            for (std::size_t i = 0; i < events.size(); ++i) {
                here.closed[i] = std::ranges::any_of(
                    model_.modes[m].slides_on, [&](const SlidingSurface& along) { return along.surface == events[i]; });
                if (here.closed[i])
                    name += contact_words(model_.contacts[i].name, ContactState::closed);
            }
            if (m == base || (model_.modes[m].derived && model_.modes[m].name == name))
                parts.contact_modes[m] = std::move(here);
        }
        parts.contacts.push_back({base, events, model_.contact_settings.velocities, contact_values(base)});
    }
}

Function SystemCompiler::contact_values(std::size_t base) {
    const std::vector<Expression> field = expander_.expand(model_.modes[base].rates),
                                  mass = expander_.expand(model_.contact_settings.mass);
    std::vector<Expression> all, restitutions, velocities;
    for (const UnilateralContact& contact : model_.contacts) {
        all.push_back(contact.gap);
        restitutions.push_back(contact.restitution);
    }
    for (const std::size_t state : model_.contact_settings.velocities)
        velocities.push_back(model_.symbol(model_.states[state].name));
    const std::vector<Expression> gaps = expander_.expand(all);
    const std::vector<Expression> rates = lie_derivatives(model_, gaps, field),
                                  accelerations = lie_derivatives(model_, rates, field);
    std::vector<std::vector<Expression>> slopes(rates.size()), responses;
    for (std::size_t i = 0; i < rates.size(); ++i) {
        for (const Expression& velocity : velocities)
            slopes[i].push_back(differentiate(rates[i], velocity));
        responses.push_back(accelerations_by(mass, slopes[i]));
    }
    all = gaps;
    for (const std::vector<Expression>& some : {rates, accelerations, expander_.expand(restitutions)})
        all.insert(all.end(), some.begin(), some.end());
    for (const std::vector<Expression>& slope : slopes)
        for (const std::vector<Expression>& response : responses) {
            all.push_back(model_.graph->number(0));
            for (std::size_t k = 0; k < slope.size(); ++k)
                all.back() = all.back() + slope[k] * response[k];
        }
    for (const std::vector<Expression>& response : responses)
        all.insert(all.end(), response.begin(), response.end());
    return compile(inputs_, all);
}

void SystemCompiler::compile_surfaces(System::Parts& parts) {
    for (const Event& event : model_.events)
        parts.events.push_back(with_gradient(event.function));
    for (const Section& section : model_.sections) {
        auto& compiled = parts.sections.emplace_back();
        compiled.push_back(with_gradient(section_function(model_, section, std::nullopt)));
        for (std::size_t symmetry = 0; symmetry < model_.symmetries.size(); ++symmetry)
            compiled.push_back(with_gradient(section_function(model_, section, symmetry)));
    }
}

} // namespace graze
