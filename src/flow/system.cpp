#include "graze/flow/system.hpp"

#include "flow/section_function.hpp"
#include "graze/symbolic/transform.hpp"
#include "symbolic/subgraph.hpp"

#include <algorithm>

namespace graze {

/// Compiles in a copy of the model, whose graph may grow and is thrown away at the end.
class SystemCompiler {
public:
    explicit SystemCompiler(const Model& model)
        : model_(model), states_(model_.state_symbols()), parameters_(model_.parameter_symbols()),
          inputs_(model_.inputs()) {}

    void compile(System::Parts& parts) {
        compile_maps(parts);
        compile_transitions(parts);
        compile_surfaces(parts);
        std::vector<Expression> periods, initial;
        for (const State& state : model_.states) {
            periods.push_back(state.period ? *state.period : model_.graph->number(0));
            initial.push_back(state.initial);
        }
        periods = model_.expand(periods);
        parts.periods = compile(parameters_, periods);
        parts.period_gradients = compile(parameters_, jacobian(periods, parameters_));
        parts.initial = function_of_parameters(initial);
    }
    std::vector<System::CompiledMode> compile_modes();
    /// The tapes of modes that are compiled already, anew for what is observed as well.
    void observe(std::vector<System::CompiledMode>& modes, std::span<const Expression> observed);

    Function function_of(std::span<const Expression> outputs) { return compile(inputs_, model_.expand(outputs)); }
    Function function_of_parameters(std::span<const Expression> outputs) {
        return compile(parameters_, model_.expand(outputs));
    }
    Function with_gradient(const Expression& expression) {
        std::vector<Expression> outputs{model_.expand(expression)};
        const std::vector<Expression> gradient = jacobian(outputs, inputs_);
        outputs.insert(outputs.end(), gradient.begin(), gradient.end());
        return compile(inputs_, outputs);
    }
    /// Of all functions compiled.
    std::size_t workspace() const { return workspace_; }

private:
    void compile_maps(System::Parts& parts);
    void compile_transitions(System::Parts& parts);
    void compile_surfaces(System::Parts& parts);
    void compile_tape(System::CompiledMode& compiled, const std::vector<Expression>& rates,
                      const std::vector<Expression>& outputs);
    std::vector<Expression> watched_functions(const System::CompiledMode& compiled);
    System::CompiledJump map_of(const std::vector<Expression>& map);
    std::vector<Expression> roots_in(std::span<const Expression> expanded);
    Function compile(std::span<const Expression> inputs, std::span<const Expression> outputs);

    Model model_;
    std::vector<Expression> states_, parameters_, inputs_;
    std::size_t workspace_ = 0;
};

System::System(const Model& model) {
    auto parts = std::make_shared<Parts>();
    parts->model = model;
    parts->model.validate();
    parts->states = model.states.size();
    parts->parameters = parts->model.parameter_symbols().size();
    SystemCompiler compiler(parts->model);
    compiler.compile(*parts);
    modes_ = std::make_shared<const std::vector<CompiledMode>>(compiler.compile_modes());
    workspace_ = compiler.workspace();
    parts->model.freeze();
    parts_ = std::move(parts);
}

/// The same system with these modes, whose tapes are compiled anew.
System System::with_tapes(std::vector<CompiledMode> modes, std::span<const Expression> observed) const {
    System result = *this;
    SystemCompiler compiler(model());
    compiler.observe(modes, observed);
    result.modes_ = std::make_shared<const std::vector<CompiledMode>>(std::move(modes));
    result.observed_ = observed.size();
    result.workspace_ = std::max(workspace_, compiler.workspace());
    return result;
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

Function SystemCompiler::compile(std::span<const Expression> inputs, std::span<const Expression> outputs) {
    model_.require_known(inputs, outputs);
    Function function(inputs, outputs);
    workspace_ = std::max(workspace_, function.workspace());
    return function;
}

/// What stands under each root or power in some expressions, followed by the exponent.
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
    return model_.expand(functions);
}

std::vector<System::CompiledMode> SystemCompiler::compile_modes() {
    std::vector<System::CompiledMode> modes;
    for (std::size_t m = 0; m < model_.modes.size(); ++m) {
        const Mode& mode = model_.modes[m];
        System::CompiledMode compiled;
        for (const std::size_t event : mode.watched) {
            const Transition* transition = model_.find_transition(m, event);
            if (!transition)
                continue; // a section that leads nowhere: the motion passes through
            compiled.watched.push_back(event);
            compiled.transitions.push_back(static_cast<std::size_t>(transition - model_.transitions.data()));
        }
        const std::vector<Expression> rates = model_.expand(mode.rates), outputs = watched_functions(compiled);
        compiled.rates = compile(inputs_, rates);
        compiled.events = compile(inputs_, outputs);
        compiled.event_gradients = compile(inputs_, jacobian(outputs, states_));
        compiled.roots = compile(inputs_, roots_in(rates));
        compile_tape(compiled, rates, outputs);
        modes.push_back(std::move(compiled));
    }
    return modes;
}

void SystemCompiler::observe(std::vector<System::CompiledMode>& modes, std::span<const Expression> observed) {
    for (std::size_t m = 0; m < modes.size(); ++m) {
        std::vector<Expression> outputs = watched_functions(modes[m]);
        const std::vector<Expression> more = model_.expand(observed);
        outputs.insert(outputs.end(), more.begin(), more.end());
        compile_tape(modes[m], model_.expand(model_.modes[m].rates), outputs);
    }
}

void SystemCompiler::compile_tape(System::CompiledMode& compiled, const std::vector<Expression>& rates,
                                  const std::vector<Expression>& outputs) {
    std::vector<Expression> all = rates;
    all.insert(all.end(), outputs.begin(), outputs.end());
    compiled.evidence = compile(inputs_, all); // where unknown symbols are found
    compiled.tape = graze::compile_tape(states_, parameters_, rates, outputs);
    compiled.polynomial = std::all_of(compiled.tape.degrees.begin(), compiled.tape.degrees.end(),
                                      [](std::uint32_t degree) { return degree != Tape::unbounded; });
    compiled.has_roots = std::any_of(compiled.tape.code.begin(), compiled.tape.code.end(), [](const auto& one) {
        return one.operation == SeriesOperation::sqrt || one.operation == SeriesOperation::power_constant;
    });
}

System::CompiledJump SystemCompiler::map_of(const std::vector<Expression>& given) {
    System::CompiledJump compiled;
    const auto map = given.empty() ? states_ : model_.expand(given); // the identity may be left empty
    compiled.identity = std::equal(map.begin(), map.end(), states_.begin(), states_.end());
    compiled.map = compile(inputs_, map);
    compiled.jacobian = compile(inputs_, jacobian(map, inputs_));
    return compiled;
}

void SystemCompiler::compile_maps(System::Parts& parts) {
    for (const Jump& jump : model_.jumps)
        parts.jumps.push_back(map_of(jump.map));
    for (const Symmetry& symmetry : model_.symmetries)
        parts.symmetries.push_back(map_of(symmetry.map));
}

void SystemCompiler::compile_transitions(System::Parts& parts) {
    for (const Transition& transition : model_.transitions) {
        System::CompiledTransition compiled;
        compiled.jump = transition.jump;
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
