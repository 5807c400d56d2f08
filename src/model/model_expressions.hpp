#pragma once

#include "graze/model/model.hpp"

#include <functional>
#include <string>
#include <vector>

namespace graze {

/// One expression of a model, with its path (such as "modes.flight.rates.x").
struct ModelExpression {
    std::string path;
    Expression expression;
    bool in_parameters = false; ///< may contain parameters only
};

/// All expressions of a model, conditions included, in the order of the file.
std::vector<ModelExpression> model_expressions(const Model& model);

/// Visits every expression that a model holds, to be changed, empty ones too.
void visit_expressions(Model& model, const std::function<void(Expression&)>& visit);

} // namespace graze
