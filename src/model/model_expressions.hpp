#pragma once

#include "graze/model/model.hpp"
#include "graze/symbolic/parser.hpp"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// One expression of a model, with its path (such as "modes.flight.rates.x").
struct ModelExpression {
    std::string path;
    Expression expression;
    bool in_parameters = false; ///< may contain parameters only
};

/// Returns all expressions of a model, conditions included, in the order of the file. An image shared by several jumps
/// is listed once, for the first jump.
std::vector<ModelExpression> model_expressions(const Model& model);
/// Returns the same expressions without their paths, which take much longer to make.
enum class ExpressionRole {
    general,       ///< may contain anything
    in_parameters, ///< may contain parameters only
};
std::vector<Expression> expressions_of(const Model& model, ExpressionRole role);

/// Returns the states that a jump changes, with their images, by rising state.
/// @param states symbols; @param identity caches the last shared map found to be the identity; pass it to each call
using StateChanges = std::vector<StateMap::Change>;
StateChanges changes_of(const StateMap& map, std::span<const Expression> states,
                        std::shared_ptr<const std::vector<Expression>>& identity);

/// Returns the symbols that expressions of a model may have in them: parameters, states, definitions.
/// @param graph the model's own, or another one, to which its names are then added
Scope scope_of(const Model& model, Graph& graph);
Scope scope_of(const Model& model);

/// Passes every expression of a model, empty ones included, to `visit` for modification.
void visit_expressions(Model& model, const std::function<void(Expression&)>& visit);

} // namespace graze
