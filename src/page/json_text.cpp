#include "page/json_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

namespace graze {

std::string json_text(const nlohmann::json& value) {
    std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    constexpr std::string_view code = "\\u003c";
    const auto found = static_cast<std::size_t>(std::count(text.begin(), text.end(), '<'));
    if (found == 0)
        return text;
    std::string safe;
    safe.reserve(text.size() + found * code.size());
    for (const char one : text) // occurs in texts only, where JSON allows codes
        one == '<' ? safe.append(code) : safe.append(1, one);
    return safe;
}

nlohmann::json number_json(double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json numbers_json(std::span<const double> values) {
    nlohmann::json::array_t list;
    list.reserve(values.size());
    for (const double value : values)
        list.push_back(number_json(value));
    return list;
}

} // namespace graze
