#pragma once

#include "graze/model/model.hpp"

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

/// All expressions of a model, conditions included, in the order of the file. Those that jumps share come once, as the
/// first one's.
std::vector<ModelExpression> model_expressions(const Model& model);
/// The same without their paths, which are many times as long to make.
enum class ExpressionRole {
    general,       ///< may contain anything
    in_parameters, ///< may contain parameters only
};
std::vector<Expression> expressions_of(const Model& model, ExpressionRole role);

/// What a jump changes: states with their images, by rising state.
/// @param states symbols; @param identity the last map of which nothing changes, to be handed on from call to call
using StateChanges = std::vector<StateMap::Change>;
StateChanges changes_of(const StateMap& map, std::span<const Expression> states,
                        std::shared_ptr<const std::vector<Expression>>& identity);

/// Visits every expression that a model holds, to be changed, empty ones too.
void visit_expressions(Model& model, const std::function<void(Expression&)>& visit);

} // namespace graze
