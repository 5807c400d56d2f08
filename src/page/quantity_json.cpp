#include "page/quantity_json.hpp"

#include "graze/results/model_table.hpp"
#include "page/json_text.hpp"
#include "picture/shown_names.hpp"

namespace graze {

nlohmann::json quantity_json(const std::string& name, const std::string& unit, const std::string& words) {
    return {{"name", name}, {"unit", unit}, {"words", words}};
}

nlohmann::json quantity_json(const std::string& name, const std::string& unit, const std::string& words, double value) {
    nlohmann::json one = quantity_json(name, unit, words);
    one["value"] = number_json(value);
    return one;
}

nlohmann::json parameters_json(const Model& model) {
    nlohmann::json list = nlohmann::json::array();
    const std::vector<double> values = all_parameter_values(model);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Parameter& parameter = model.parameters[i];
        list.push_back(quantity_json(parameter.name, parameter.unit, first_words(parameter.text), values[i]));
    }
    return list;
}

nlohmann::json columns_json(const std::vector<ResultColumn>& columns) {
    nlohmann::json list = nlohmann::json::array();
    for (const ResultColumn& column : columns)
        list.push_back(quantity_json(column.name, column.unit, ""));
    return list;
}

} // namespace graze
