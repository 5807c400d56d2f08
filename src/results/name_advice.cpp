#include "graze/results/name_advice.hpp"

#include "graze/base/name_list.hpp"
#include "graze/symbolic/parser.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

std::string name_advice(std::string_view name, const std::vector<std::string>& known, std::string_view none) {
    if (known.empty())
        return std::string(none);
    const std::string nearest = nearest_name(name, known);
    if (!nearest.empty())
        return fmt::format("did you mean '{}'?", nearest);
    std::vector<std::string> distinct; // a monitor and a column may have the same name
    for (const std::string& one : known)
        if (std::find(distinct.begin(), distinct.end(), one) == distinct.end())
            distinct.push_back(one);
    return fmt::format("known are: {}", name_list(distinct, name));
}

} // namespace graze
