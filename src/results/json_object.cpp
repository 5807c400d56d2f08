#include "graze/results/json_object.hpp"

#include "base/json_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

void JsonObject::put(std::string_view name, const std::string& value) {
    members_ += (members_.empty() ? "" : ",\n") + json_text(name) + ':' + value;
}

void JsonObject::add(std::string_view name, std::string_view text) {
    put(name, json_text(text));
}

void JsonObject::add(std::string_view name, double number) {
    put(name, std::isfinite(number) ? fmt::format("{:.17g}", number) : "null");
}

void JsonObject::add(std::string_view name, const JsonObject& object) {
    put(name, '{' + object.members_ + '}');
}

void JsonObject::add(std::string_view name, const std::vector<JsonObject>& objects) {
    std::string items;
    for (const JsonObject& object : objects)
        items += (items.empty() ? "{" : ",\n{") + object.members_ + '}';
    put(name, '[' + items + ']');
}

} // namespace graze
