#include "graze/base/printable.hpp"

#include "base/character.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace graze {

namespace {

constexpr std::string_view replacement = "\xef\xbf\xbd"; // U+FFFD, the replacement character

bool is_layout(char32_t code) {
    return code == '\n' || code == '\t' || code == '\r';
}

/// True for characters that control a terminal or change how adjacent characters are shown.
bool is_active(char32_t code) {
    return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0xad || code == 0x61c || code == 0x180e ||
           (code >= 0x200b && code <= 0x200f) || (code >= 0x2028 && code <= 0x202e) ||
           (code >= 0x2060 && code <= 0x206f) || code == 0xfeff || (code >= 0xfff9 && code <= 0xfffb) ||
           (code >= 0xe0000 && code <= 0xe0fff);
}

bool is_plain(std::string_view text, bool with_layout) {
    for (std::size_t at = 0; at < text.size();) {
        const Character character = character_at(text, at);
        if (!character.valid || (is_active(character.code) && !(with_layout && is_layout(character.code))))
            return false;
        at += character.bytes;
    }
    return true;
}

std::string shown(std::string_view text, std::string_view kept) {
    std::string result;
    result.reserve(text.size());
    for (std::size_t at = 0; at < text.size();) {
        const Character character = character_at(text, at);
        if (!character.valid || (is_active(character.code) && character.code > 0xffff))
            result += replacement;
        else if (is_active(character.code) && kept.find(text[at]) == std::string_view::npos)
            result += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(character.code));
        else
            result += text.substr(at, character.bytes);
        at += character.bytes;
    }
    return result;
}

bool continues(char c) {
    return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
}

} // namespace

bool is_plain_text(std::string_view text) {
    return is_plain(text, true);
}

bool is_plain_line(std::string_view text) {
    return is_plain(text, false);
}

std::string printable(std::string_view text) {
    return shown(text, "\n\t");
}

std::string printable_line(std::string_view text) {
    return shown(text, "");
}

std::size_t unfinished_character(std::string_view text) {
    for (std::size_t bytes = 1; bytes <= std::min<std::size_t>(3, text.size()); ++bytes) {
        const char c = text[text.size() - bytes];
        if (continues(c))
            continue;
        return bytes_announced(static_cast<unsigned char>(c)) > bytes ? bytes : 0;
    }
    return 0;
}

std::string shortened(std::string_view text, std::size_t most) {
    if (text.size() <= most)
        return std::string(text);
    std::size_t head = most * 2 / 3, tail = text.size() - most / 4;
    while (head > 0 && continues(text[head]))
        --head;
    while (tail < text.size() && continues(text[tail]))
        ++tail;
    return fmt::format("{} ... [{} bytes left out] ... {}", text.substr(0, head), tail - head, text.substr(tail));
}

} // namespace graze
