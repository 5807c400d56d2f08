#pragma once

#include "graze/model/model.hpp"
#include "model/model_places.hpp"

namespace graze {

/// Checks the drawing of a model. @throws InputError
void validate_drawing(const Model& model, const Places& places);
/// Returns the expressions in states of all shapes, in a graph of their own.
std::vector<Expression> drawn_expressions(const Model& model);

} // namespace graze
