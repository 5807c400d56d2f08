#pragma once

#include <cstddef>
#include <vector>

namespace graze {

/// Returns lists of numbers one after another, such as the inputs of a model's functions: states, then parameters.
template <class... Lists>
std::vector<double> concatenated(const Lists&... lists) {
    std::vector<double> all;
    all.reserve((static_cast<std::size_t>(lists.size()) + ...));
    (all.insert(all.end(), lists.begin(), lists.end()), ...);
    return all;
}

} // namespace graze
