#include "graze/study/setting_list.hpp"

#include "study/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace graze {

namespace {

/// Lists of more numbers are told by their ends.
constexpr std::size_t longest_list = 8;

void add_lines(const std::string& name, const Json& json, std::vector<Setting>& all) {
    const auto member = [&](const std::string& last) { return name.empty() ? last : name + "." + last; };
    using Kind = Json::Kind;
    if (json.kind == Kind::object) {
        for (std::size_t i = 0; i < json.items.size(); ++i)
            add_lines(member(json.names[i]), json.items[i], all);
        return;
    }
    if (json.kind != Kind::list && json.kind != Kind::nothing) {
        const bool number = json.kind == Kind::number;
        all.push_back({name, number ? std::optional(std::strtod(json.text.c_str(), nullptr)) : std::nullopt,
                       json.kind != Kind::truth ? json.text
                       : json.truth             ? "true"
                                                : "false"});
    }
    if (json.kind != Kind::list)
        return;
    const std::vector<Json>& items = json.items;
    const bool numbers =
        std::all_of(items.begin(), items.end(), [](const Json& item) { return item.kind == Json::Kind::number; });
    if (numbers && items.size() > longest_list) {
        all.push_back({member("count"), static_cast<double>(items.size()), fmt::format("{}", items.size())});
        add_lines(member("first"), items.front(), all);
        add_lines(member("last"), items.back(), all);
        return;
    }
    for (std::size_t i = 0; i < items.size(); ++i)
        add_lines(member(fmt::format("{}", i + 1)), items[i], all);
}

} // namespace

std::vector<Setting> setting_list(const std::string& settings, const Place& place) {
    std::vector<Setting> all;
    add_lines("", parse_json(settings, place), all);
    return all;
}

} // namespace graze
