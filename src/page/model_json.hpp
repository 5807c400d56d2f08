#pragma once

#include "graze/model/model.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace graze {

/// A model with all that the page shows and changes of it: parameters, states, modes, quantities, and its drawing with
/// the limits of the scene at its present parameters; null if it has none.
/// @param text of its file; empty: as graze writes it
nlohmann::json model_json(const Model& model, const std::string& text = {});

} // namespace graze
