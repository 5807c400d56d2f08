#include "graze/flow/variational_system.hpp"

#include "flow/section_function.hpp"
#include "flow/uniformised_system.hpp"
#include "flow/variations.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/unused_symbol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <numeric>
#include <set>
#include <string>

namespace graze {

namespace {

/// Returns the modes of a model without events, extended by derivatives of the states as further states: x' = f, w' =
/// the derivative of f along w. States: first those of the model, then, column by column, the derivatives of `rows`.
/// @param rows states whose derivatives are computed
/// @param columns for each column, the vector along which it is the derivative: first the components of the rows, in
/// their order, then others, which become parameters
System modes_with_tangents(Model& model, SystemOptions options, std::span<const std::size_t> rows,
                           std::span<const std::vector<Component>> columns) {
    Model grown;
    grown.graph = model.graph;
    grown.name = model.name;
    const auto add_state = [&](const Expression& symbol) {
        grown.states.push_back({.name = symbol.name(), .initial = model.number(0)});
    };
    for (const Expression& state : model.state_symbols())
        add_state(state);
    const std::vector<double> values = model.parameter_values();
    for (const Expression& parameter : model.parameter_symbols())
        grown.parameters.push_back({.name = parameter.name(), .value = values[grown.parameters.size()]});
    for (const std::vector<Component>& column : columns)
        for (std::size_t k = 0; k < column.size(); ++k)
            if (const Expression& component = column[k].second; k < rows.size())
                add_state(component);
            else
                grown.parameters.push_back({.name = component.name(), .value = 0.0});
    for (const Mode& mode : model.modes) {
        std::vector<Expression> rates = model.expand(mode.rates), moving;
        for (const std::size_t row : rows)
            moving.push_back(rates[row]);
        for (const std::vector<Component>& column : columns) {
            const std::vector<Expression> along = differentiate_along(moving, column);
            rates.insert(rates.end(), along.begin(), along.end());
        }
        grown.modes.push_back(
            {.name = mode.name, .rates = std::move(rates), .ends = ends_of_mode(model, grown.modes.size())});
    }
    return System(grown, options);
}

/// Differentiates in a copy of a system's model, whose graph may grow and is discarded afterwards.
class VariationalCompiler {
public:
    VariationalCompiler(const System& system, std::span<const ParameterId> free);

    /// Returns the modes of a separate model, in which the tangent is part of the state.
    System modes();
    /// Compiles values, derivatives and second derivatives of functions in the model's symbols.
    Function function_of(std::span<const Expression> functions);
    Function function_of(const Expression& function) { return function_of(std::span(&function, 1)); }
    /// The same for a map of states; an empty map is the identity.
    Function map_of(const std::vector<Expression>& map) { return function_of(map.empty() ? states_ : map); }

    Model& model() { return model_; }
    /// Largest workspace of all functions compiled.
    std::size_t workspace() const { return workspace_; }

private:
    Model model_;
    SystemOptions options_;
    std::vector<Expression> states_, known_, variables_, vector_;
    std::vector<Component> along_; ///< the vector
    std::size_t workspace_ = 0;
};

VariationalCompiler::VariationalCompiler(const System& system, std::span<const ParameterId> free)
    : model_(system.model()), options_(system.options()), states_(model_.state_symbols()), known_(model_.inputs()),
      variables_(states_) {
    const std::vector<Expression> parameters = model_.parameter_symbols();
    for (const ParameterId parameter : free)
        variables_.push_back(parameters[parameter.place()]);
    for (const Expression& variable : variables_) {
        vector_.push_back(unused_symbol(model_, "along_" + std::to_string(vector_.size())));
        along_.emplace_back(variable, vector_.back());
    }
}

Function VariationalCompiler::function_of(std::span<const Expression> functions) {
    const std::vector<Expression> values = model_.expand(functions);
    model_.require_known(known_, values);
    std::vector<Function::Output> outputs;
    for (std::size_t i = 0; i < values.size(); ++i)
        outputs.push_back({i, values[i]});
    std::size_t place = values.size();
    const SymbolIndex variables(variables_);
    for (const auto& rows : {values, differentiate_along(values, along_)}) {
        for (JacobianEntry& entry : sparse_jacobian(rows, variables))
            outputs.push_back({place + entry.row * variables.size() + entry.column, std::move(entry.value)});
        place += rows.size() * variables.size();
    }
    std::vector<Expression> inputs = known_;
    inputs.insert(inputs.end(), vector_.begin(), vector_.end());
    Function function(SymbolIndex(inputs), place, outputs, Function::Others::zero);
    workspace_ = std::max(workspace_, function.workspace());
    return function;
}

System VariationalCompiler::modes() {
    std::vector<std::size_t> rows(states_.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    return modes_with_tangents(model_, options_, rows, std::span(&along_, 1));
}

} // namespace

VariationalSystem::VariationalSystem(const System& system, std::vector<ParameterId> free) : system_(system) {
    std::set<ParameterId> seen;
    for (const ParameterId parameter : free) {
        require_index(parameter.place(), system.parameters(), "independent parameter");
        if (!seen.insert(parameter).second)
            throw InputError(
                fmt::format("parameter '{}' is free twice", system.model().independent_parameters()[parameter.place()]),
                "name each free parameter once");
    }
    System::Variations& variations = *system.variations_;
    const std::scoped_lock lock(variations.filling);
    std::shared_ptr<const Parts>& parts = variations.of[free];
    if (!parts)
        parts = std::make_shared<const Parts>(compiled(system, free));
    parts_ = parts;
}

VariationalSystem::Parts VariationalSystem::compiled(const System& system, const std::vector<ParameterId>& free) {
    VariationalCompiler compiler(system, free);
    Parts parts{compiler.modes(), free, {}, {}, {}, {}, 0};
    Model& model = compiler.model();
    for (const Event& event : model.events)
        parts.events.push_back(compiler.function_of(event.function));
    for (const Jump& jump : model.jumps)
        parts.jumps.push_back(compiler.map_of(jump.map));
    for (const Symmetry& symmetry : model.symmetries)
        parts.symmetries.push_back(compiler.map_of(symmetry.map));
    for (const Section& section : model.sections) {
        auto& functions = parts.sections.emplace_back();
        functions.push_back(compiler.function_of(section_function(model, section, std::nullopt)));
        for (std::size_t symmetry = 0; symmetry < model.symmetries.size(); ++symmetry)
            functions.push_back(compiler.function_of(section_function(model, section, symmetry)));
    }
    parts.workspace = compiler.workspace();
    return parts;
}

Function VariationalSystem::function_of(std::span<const Expression> expressions) const {
    return VariationalCompiler(system(), free()).function_of(expressions);
}

} // namespace graze
