#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// What to say to somebody who has named something that is not there: "did you mean 'x'?", or all that there is.
/// @param none what to say when there is nothing at all
std::string name_advice(std::string_view name, const std::vector<std::string>& known, std::string_view none);

/// Names of what has some.
template <class Item>
std::vector<std::string> names_of(const std::vector<Item>& items) {
    std::vector<std::string> names;
    for (const Item& item : items)
        names.push_back(item.name);
    return names;
}

} // namespace graze
