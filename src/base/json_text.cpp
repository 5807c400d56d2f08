#include "base/json_text.hpp"

#include <fmt/format.h>

namespace graze {

std::string json_text(std::string_view text) {
    std::string result = "\"";
    for (const char c : text)
        if (c == '"' || c == '\\')
            result += {'\\', c};
        else if (static_cast<unsigned char>(c) < 0x20)
            result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            result += c;
    return result + '"';
}

} // namespace graze
