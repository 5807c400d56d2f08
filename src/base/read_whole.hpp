#pragma once

#include <charconv>
#include <string_view>
#include <system_error>

namespace graze {

/// Reads a text that is a number as a whole. @return whether it is one
template <class Number>
bool read_whole(std::string_view text, Number& value) {
    const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && next == text.data() + text.size();
}

} // namespace graze
