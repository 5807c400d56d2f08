#include "program/wrapped_text.hpp"

#include <algorithm>
#include <sstream>

namespace graze {

std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string wrapped(const std::string& text, std::size_t width, std::size_t indent) {
    std::string result;
    std::size_t column = indent;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        const bool first = column == indent, fits = first || column + 1 + width_of(word) <= width;
        if (!fits)
            column = indent;
        result += first ? "" : fits ? " " : '\n' + std::string(indent, ' ');
        column += width_of(word) + (!first && fits ? 1 : 0);
        result += word;
    }
    return result;
}

} // namespace graze
