#include "page/quantity_json.hpp"

#include "page/json_text.hpp"

namespace graze {

nlohmann::json quantity_json(const std::string& name, const std::string& unit, const std::string& words) {
    return {{"name", name}, {"unit", unit}, {"words", words}};
}

nlohmann::json quantity_json(const std::string& name, const std::string& unit, const std::string& words, double value) {
    nlohmann::json one = quantity_json(name, unit, words);
    one["value"] = number_json(value);
    return one;
}

nlohmann::json columns_json(const std::vector<ResultColumn>& columns) {
    nlohmann::json list = nlohmann::json::array();
    for (const ResultColumn& column : columns)
        list.push_back(quantity_json(column.name, column.unit, ""));
    return list;
}

} // namespace graze
