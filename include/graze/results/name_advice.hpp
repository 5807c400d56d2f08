#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Remedy for an unknown name: "did you mean 'x'?" if a known name is similar, otherwise the list of known names.
/// @param none returned if there are no known names
std::string name_advice(std::string_view name, const std::vector<std::string>& known, std::string_view none);

/// The member `name` of each item.
template <class Item>
std::vector<std::string> names_of(const std::vector<Item>& items) {
    std::vector<std::string> names;
    for (const Item& item : items)
        names.push_back(item.name);
    return names;
}

} // namespace graze
