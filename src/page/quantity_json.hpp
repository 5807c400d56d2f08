#pragma once

#include "graze/model/model.hpp"
#include "graze/results/result_file.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace graze {

/// The name of a quantity, its unit and its meaning in a few words; both may be empty.
nlohmann::json quantity_json(const std::string& name, const std::string& unit, const std::string& words);
/// The same with a value, which is null if it is not finite.
nlohmann::json quantity_json(const std::string& name, const std::string& unit, const std::string& words, double value);
/// All parameters of a model with their values, in its order.
nlohmann::json parameters_json(const Model& model);
/// The same for columns without words.
nlohmann::json columns_json(const std::vector<ResultColumn>& columns);

} // namespace graze
