#include "model/written_text.hpp"

#include "base/read_whole.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

std::string toml_string(const std::string& text) {
    const bool long_form = text.find('\n') != std::string::npos;
    std::string result = long_form ? "\"\"\"\n" : "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            result += {'\\', c};
        else if ((code < 0x20 && c != '\n' && c != '\t') || code == 0x7f)
            result += fmt::format("\\u{:04X}", code);
        else
            result += c;
    }
    return result + (long_form ? "\"\"\"" : "\"");
}

std::string toml_key(const std::string& name) {
    const bool bare = std::ranges::all_of(name, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
    return bare && !name.empty() ? name : toml_string(name);
}

std::string number_text(double value) {
    if (value == 0 && std::signbit(value))
        return "-0.0"; // "-0" would be an integer, which has no sign
    return fmt::format("{}", value);
}

std::string written_text(const Expression& expression) {
    return expression.is_number() ? number_text(expression.node().value) : to_string(expression);
}

std::string value_of_written(const std::string& text) {
    double value = 0;
    return read_whole(text, value) && std::isfinite(value) && text == number_text(value) ? text : toml_string(text);
}

} // namespace graze
