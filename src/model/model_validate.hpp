#pragma once

#include "graze/model/model.hpp"
#include "model/model_places.hpp"

#include <string>
#include <string_view>
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

/// "did you mean 'x'?", or what there is when nothing is near.
std::string name_remedy(std::string_view name, const std::vector<std::string>& known);

/// Checks the names of parameters, states and definitions. @throws InputError
void validate_names(const Model& model, const Places& places);
/// Model::validate, with places.
void validate_model(const Model& model, const Places& places);
/// Model::initial_state, with places.
std::vector<double> checked_initial_state(const Model& model, const Places& places);

} // namespace graze
