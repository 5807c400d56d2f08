#pragma once

#include <cstddef>
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

} // namespace graze
