#include "graze/results/json_object.hpp"

#include "base/json_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

void JsonObject::begin(std::string_view name) {
    members_ += (members_.empty() ? "" : ",\n") + json_text(name) + ':';
}

void JsonObject::add(std::string_view name, std::string_view text) {
    begin(name);
    members_ += json_text(text);
}

void JsonObject::add(std::string_view name, double number) {
    begin(name);
    members_ += std::isfinite(number) ? fmt::format("{:.17g}", number) : "null";
}

void JsonObject::add(std::string_view name, const JsonObject& object) {
    begin(name);
    members_ += '{' + object.members_ + '}';
}

void JsonObject::add(std::string_view name, const std::vector<JsonObject>& objects) {
    begin(name);
    members_ += '[';
    for (std::size_t i = 0; i < objects.size(); ++i)
        members_ += (i > 0 ? ",\n{" : "{") + objects[i].members_ + '}';
    members_ += ']';
}

} // namespace graze
