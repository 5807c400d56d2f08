#include "graze/flow/variational_system.hpp"

#include "flow/modes_with_tangents.hpp"
#include "flow/section_function.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>

namespace graze {

namespace {

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
    std::vector<Expression> states_, known_, variables_, vector_;
    std::vector<Component> along_; ///< the vector
    std::size_t workspace_ = 0;
};

VariationalCompiler::VariationalCompiler(const System& system, std::span<const ParameterId> free)
    : model_(system.model()), states_(model_.state_symbols()), known_(model_.inputs()), variables_(states_) {
    const std::vector<Expression> parameters = model_.parameter_symbols();
    for (const ParameterId parameter : free)
        variables_.push_back(parameters[parameter.place()]);
    for (const Expression& variable : variables_) {
        vector_.push_back(new_symbol(model_, "along_" + std::to_string(vector_.size())));
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
    return modes_with_tangents(model_, rows, std::span(&along_, 1));
}

} // namespace

VariationalSystem::VariationalSystem(const System& system, std::vector<ParameterId> free) {
    std::set<ParameterId> seen;
    for (const ParameterId parameter : free) {
        require_index(parameter.place(), system.parameters(), "independent parameter");
        if (!seen.insert(parameter).second)
            throw InputError(
                fmt::format("parameter '{}' is free twice", system.model().independent_parameters()[parameter.place()]),
                "name each free parameter once");
    }
    VariationalCompiler compiler(system, free);
    Parts parts{system, compiler.modes(), std::move(free), {}, {}, {}, {}, 0};
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
    parts_ = std::make_shared<const Parts>(std::move(parts));
}

const Function& VariationalSystem::event(std::size_t index) const {
    require_index(index, parts_->events.size(), "event");
    return parts_->events[index];
}

const Function& VariationalSystem::section(std::size_t index, std::optional<std::size_t> symmetry) const {
    require_index(index, parts_->sections.size(), "section");
    if (symmetry)
        require_index(*symmetry, parts_->symmetries.size(), "symmetry");
    return parts_->sections[index][symmetry ? 1 + *symmetry : 0];
}

const Function& VariationalSystem::jump(std::size_t index) const {
    require_index(index, parts_->jumps.size(), "jump");
    return parts_->jumps[index];
}

const Function& VariationalSystem::symmetry(std::size_t index) const {
    require_index(index, parts_->symmetries.size(), "symmetry");
    return parts_->symmetries[index];
}

Function VariationalSystem::function_of(std::span<const Expression> expressions) const {
    return VariationalCompiler(system(), free()).function_of(expressions);
}

} // namespace graze
