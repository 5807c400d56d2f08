#include "graze/base/file_name.hpp"

#include "graze/base/printable.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

constexpr std::size_t longest_line = 10000;

bool is_letter_or_digit(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

} // namespace

bool is_file_name(std::string_view name) {
    return !name.empty() && name.size() <= longest_name && name.front() != '.' && name.front() != '-' &&
           std::all_of(name.begin(), name.end(),
                       [](char c) { return is_letter_or_digit(c) || c == '.' || c == '_' || c == '-'; });
}

void require_file_name(std::string_view name, std::string_view what, const Place& place) {
    if (!is_file_name(name))
        throw InputError(place, fmt::format("'{}' cannot be the {}", shortened(name, 100), what),
                         fmt::format("use up to {} letters, digits, '.', '_' and '-', the first a letter, digit or '_'",
                                     longest_name));
}

void require_plain_line(std::string_view text, std::string_view what, const Place& place) {
    if (text.size() > longest_line)
        throw InputError(place, fmt::format("the {} has {} bytes", what, text.size()),
                         fmt::format("shorten it to {}", longest_line));
    if (!is_plain_line(text))
        throw InputError(
            place,
            fmt::format("the {} '{}' has characters in it that control a terminal or break the line", what, text),
            "write it on one line, of characters that can be seen");
}

} // namespace graze
