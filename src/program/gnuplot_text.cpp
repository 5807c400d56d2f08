#include "program/gnuplot_text.hpp"

#include "graze/symbolic/input_error.hpp"
#include "graze/symbolic/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

namespace graze {

namespace {

/// A line that ends within quotes ends a command, and what stands on the next one is obeyed.
void require_quotable(const std::string& text) {
    if (std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
        throw InputError(fmt::format("'{}' cannot be written into a picture: it has control characters", text),
                         "change the name, title or label");
}

} // namespace

std::string plain(const std::string& given) {
    require_quotable(given);
    const std::string text = printable_line(given); // what is no UTF-8, too
    std::string result;
    for (const char c : text) {
        // By its code: in no other way do all versions leave it alone.
        if (c == '`')
            result += "\\140";
        else if (c == '@')
            result += "\\\\\\100";
        else if (std::string_view("_^{}&~\\").find(c) != std::string_view::npos)
            result += (c == '\\' ? "\\\\\\" : "\\\\") + std::string(1, c);
        else
            result += (c == '"' ? "\\" : "") + std::string(1, c);
    }
    return result;
}

std::string quoted_path(const std::string& path) {
    require_quotable(path);
    std::string result = "'";
    for (const char c : path)
        result += c == '\'' ? "''" : std::string(1, c);
    return result + "'";
}

std::string unit_text(const std::string& unit) {
    std::string result;
    for (std::size_t i = 0; i < unit.size(); ++i) {
        if (unit[i] != '^') {
            const std::size_t end = std::min(unit.find('^', i), unit.size());
            result += plain(unit.substr(i, end - i));
            i = end - 1;
            continue;
        }
        std::size_t end = i + 1;
        while (end < unit.size() &&
               (std::isdigit(static_cast<unsigned char>(unit[end])) != 0 || unit[end] == '-' || unit[end] == '.'))
            ++end;
        result += "^{" + unit.substr(i + 1, end - i - 1) + '}';
        i = end - 1;
    }
    return result;
}

std::string name_text(const std::string& name) {
    constexpr std::size_t longest_symbol = 2;
    const bool word =
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    if (!word)
        return plain(name);
    const std::size_t underscore = name.find('_');
    const std::size_t stem = underscore == std::string::npos ? name.find_last_not_of("0123456789") + 1 : underscore;
    if (stem == 0 || stem > longest_symbol) {
        std::string words = name;
        std::replace(words.begin(), words.end(), '_', ' ');
        return words;
    }
    const std::string index = name.substr(std::min(name.size(), stem + (underscore == std::string::npos ? 0 : 1)));
    return fmt::format("{{/:Italic {}}}", name.substr(0, stem)) +
           (index.empty() ? "" : fmt::format("_{{{}}}", plain(index)));
}

std::string with_unit(const std::string& label, const std::string& unit) {
    return unit.empty() ? label : fmt::format("{} ({})", label, unit_text(unit));
}

std::string number_text(double value) {
    return fmt::format("{:.10g}", value);
}

} // namespace graze
