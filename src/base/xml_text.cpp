#include "graze/base/xml_text.hpp"

#include "base/character.hpp"

namespace graze {

namespace {

/// True for characters that XML allows (XML 1.0, section 2.2).
bool is_xml_character(const Character& character) {
    const char32_t code = character.code;
    return character.valid && (code >= 0x20 || code == '\t' || code == '\n' || code == '\r') && code != 0xfffe &&
           code != 0xffff;
}

/// @param written returns the replacement of an allowed character
template <class Written>
std::string rewritten(std::string_view text, Written written) {
    std::string result;
    result.reserve(text.size());
    for (std::size_t at = 0; at < text.size();) {
        const Character character = character_at(text, at);
        if (is_xml_character(character))
            result += written(at, text.substr(at, character.bytes));
        else
            result += "\xef\xbf\xbd";
        at += character.bytes;
    }
    return result;
}

} // namespace

std::string xml_text(std::string_view text) {
    return rewritten(text, [](std::size_t, std::string_view letter) -> std::string_view {
        return letter == "&"    ? "&amp;"
               : letter == "<"  ? "&lt;"
               : letter == ">"  ? "&gt;"
               : letter == "\"" ? "&quot;"
                                : letter;
    });
}

std::string well_formed(std::string_view document) {
    return rewritten(document, [document](std::size_t at, std::string_view letter) -> std::string_view {
        return letter == ">" && at >= 2 && document.substr(at - 2, 2) == "]]" ? "&gt;" : letter;
    });
}

} // namespace graze
