#include "graze/results/name_advice.hpp"

#include "graze/symbolic/parser.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace graze {

std::string name_advice(std::string_view name, const std::vector<std::string>& known, std::string_view none) {
    if (known.empty())
        return std::string(none);
    const std::string nearest = nearest_name(name, known);
    return nearest.empty() ? fmt::format("known are: {}", fmt::join(known, ", "))
                           : fmt::format("did you mean '{}'?", nearest);
}

} // namespace graze
