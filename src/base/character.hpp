#pragma once

#include <cstddef>
#include <string_view>

namespace graze {

/// A character of a UTF-8 text.
struct Character {
    char32_t code = 0;
    std::size_t bytes = 1;
    bool valid = false;
};

/// Returns the length of the character that starts with this byte; 0 if none does.
inline std::size_t bytes_announced(unsigned char first) {
    return first < 0x80                    ? 1
           : first >= 0xc2 && first < 0xe0 ? 2
           : first >= 0xe0 && first < 0xf0 ? 3
           : first >= 0xf0 && first < 0xf5 ? 4
                                           : 0;
}

/// Returns the character at `at`; if the bytes are not valid UTF-8, the first byte marked as invalid.
inline Character character_at(std::string_view text, std::size_t at) {
    const auto first = static_cast<unsigned char>(text[at]);
    const std::size_t bytes = bytes_announced(first);
    if (bytes == 1)
        return {first, 1, true};
    if (bytes == 0 || at + bytes > text.size())
        return {};
    char32_t code = first & (0xffu >> (bytes + 1));
    for (std::size_t i = 1; i < bytes; ++i) {
        const auto next = static_cast<unsigned char>(text[at + i]);
        if ((next & 0xc0) != 0x80)
            return {};
        code = code << 6 | (next & 0x3fu);
    }
    constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < least[bytes] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000))
        return {};
    return {code, bytes, true};
}

inline bool is_blank(char letter) {
    return letter == ' ' || letter == '\t';
}

} // namespace graze
