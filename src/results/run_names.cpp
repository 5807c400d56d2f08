#include "results/run_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace graze {

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

} // namespace

void require_free_name(const std::string& name, bool branch, const std::vector<std::string>& others,
                       const Place& place) {
    // The table of its orbits would be the view over those of all runs.
    if (branch && lower(name) == "points")
        throw InputError(place,
                         fmt::format("no branch can be called '{}': result files have a view of that name", name),
                         "give it another name");
    for (const std::string& other : others)
        if (other != name && lower(other) == lower(name))
            throw InputError(place, fmt::format("the names of the runs '{}' and '{}' differ in case only", other, name),
                             "give one of them another name");
}

} // namespace graze
