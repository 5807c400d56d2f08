#include "program/quantity.hpp"

namespace graze {

RequestedQuantity requested_quantity(const Model& model, const std::string& text, const std::string& option) {
    return named_value(model, text, {option + ' ' + text, 1, 1});
}

std::vector<RequestedQuantity> requested_quantities(const Model& model, const std::vector<std::string>& texts,
                                                    const std::string& option) {
    std::vector<RequestedQuantity> result;
    for (const std::string& text : texts)
        result.push_back(requested_quantity(model, text, option));
    return result;
}

} // namespace graze
