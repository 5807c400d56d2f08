#include "graze/base/name_list.hpp"

#include "base/letter_case.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace graze {

namespace {

constexpr std::size_t longest_compared = 64; ///< in characters

/// Returns the least number of edits: insertions, deletions, replacements, exchanges of adjacent characters.
std::size_t edit_distance(std::string_view one, std::string_view other) {
    std::vector<std::size_t> before_last(other.size() + 1), last(other.size() + 1), current(other.size() + 1);
    std::iota(current.begin(), current.end(), std::size_t{0});
    for (std::size_t row = 1; row <= one.size(); ++row) {
        std::swap(before_last, last);
        std::swap(last, current);
        current[0] = row;
        for (std::size_t column = 1; column <= other.size(); ++column) {
            const std::size_t replaced = last[column - 1] + (one[row - 1] != other[column - 1]);
            current[column] = std::min({replaced, last[column] + 1, current[column - 1] + 1});
            if (row > 1 && column > 1 && one[row - 1] == other[column - 2] && one[row - 2] == other[column - 1])
                current[column] = std::min(current[column], before_last[column - 2] + 1);
        }
    }
    return current.back();
}

/// Returns the distance of a candidate; candidates that contain the name rank before all others.
std::size_t distance_between(const std::string& wanted, const std::string& candidate) {
    const std::string other = in_small_letters(std::string_view(candidate).substr(0, longest_compared));
    const std::size_t distance = edit_distance(wanted, other);
    const bool part = wanted.size() > 1 && other.find(wanted) != std::string::npos;
    return part ? distance : distance + longest_compared;
}

} // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
    const std::string wanted = in_small_letters(name.substr(0, longest_compared + 1));
    std::string nearest;
    std::size_t least = 4; // a name with more edits is not a misspelling
    for (const std::string& candidate : candidates) {
        const std::size_t longer = std::max(name.size(), candidate.size());
        if (longer > longest_compared)
            continue;
        const std::size_t distance = edit_distance(wanted, in_small_letters(candidate));
        const std::size_t near = std::max<std::size_t>(1, longer / 3);
        if (distance < least && distance < longer && distance <= near) {
            least = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

std::string name_list(const std::vector<std::string>& names, std::string_view wanted, std::size_t most) {
    if (names.size() <= most)
        return fmt::format("{}", fmt::join(names, ", "));
    std::vector<std::string> shown;
    if (wanted.empty()) {
        shown.assign(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(most));
    } else {
        const std::string lower = in_small_letters(wanted.substr(0, longest_compared));
        std::vector<std::pair<std::size_t, std::size_t>> order; // distance, index in names
        for (std::size_t i = 0; i < names.size(); ++i)
            order.emplace_back(distance_between(lower, names[i]), i);
        std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end());
        for (std::size_t i = 0; i < most; ++i)
            shown.push_back(names[order[i].second]);
    }
    return fmt::format("{} and {} more", fmt::join(shown, ", "), names.size() - most);
}

} // namespace graze
