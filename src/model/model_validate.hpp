#pragma once

#include "graze/model/model.hpp"
#include "model/model_places.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Returns "did you mean 'x'?", or the list of known names when none is near.
std::string name_remedy(std::string_view name, const std::vector<std::string>& known);

/// Checks the names of parameters, states and definitions. @throws InputError
void validate_names(const Model& model, const Places& places);
/// Checks what completing slides and frictions relies on: names, sizes, indices, definitions. @throws InputError
void validate_declarations(const Model& model, const Places& places);
/// Model::validate, with places in the model file.
void validate_model(const Model& model, const Places& places);
/// Model::initial_state, with places in the model file.
std::vector<double> checked_initial_state(const Model& model, const Places& places);

} // namespace graze
