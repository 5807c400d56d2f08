#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace graze {

/// Returns the name of an enumerator. @param names in the order of the enumeration, from 0 on
/// @param otherwise for a number that is none of the enumerators
template <class Enumeration>
constexpr std::string_view enumerator_name(std::span<const std::string_view> names, Enumeration value,
                                           std::string_view otherwise) {
    const auto index = static_cast<std::size_t>(value);
    return index < names.size() ? names[index] : otherwise;
}

/// Returns the enumerator of this name, of those up to the last one; nothing for other names.
template <class Enumeration>
std::optional<Enumeration> enumerator_named(std::string_view name, Enumeration last) {
    for (int i = 0; i <= static_cast<int>(last); ++i)
        if (name == name_of(static_cast<Enumeration>(i)))
            return static_cast<Enumeration>(i);
    return std::nullopt;
}

} // namespace graze
