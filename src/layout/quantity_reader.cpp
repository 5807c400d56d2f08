#include "layout/quantity_reader.hpp"

#include "graze/base/physical_unit.hpp"
#include "graze/base/printable.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

namespace graze {

namespace {

struct ValueAndUnit {
    std::string value, name;
    PhysicalUnit unit;
};

/// Splits value and unit. The unit follows a blank (and may contain blanks; the longest one counts), or follows a
/// number directly.
std::optional<ValueAndUnit> split_unit(const std::string& text) {
    const auto split = [&](std::size_t end, std::size_t begin) -> std::optional<ValueAndUnit> {
        const auto unit = known_unit(std::string_view(text).substr(begin));
        return unit && text.find_first_not_of(" *1", end) != std::string::npos
                   ? std::optional(ValueAndUnit{text.substr(0, end), text.substr(begin), *unit})
                   : std::nullopt;
    };
    for (std::size_t blank = text.find(' '); blank != std::string::npos; blank = text.find(' ', blank + 1))
        if (auto found = split(blank, blank + 1))
            return found;
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const auto length = static_cast<std::size_t>(end - text.data());
    return error == std::errc() && length < text.size() ? split(length, length) : std::nullopt;
}

/// @throws InputError with the place, for a text that ends in a word after a value
void require_no_unit(const std::string& text, const std::string& name, const char* units, const Place& place) {
    const std::size_t blank = text.find_last_of(' ');
    const std::size_t before = blank == std::string::npos ? blank : text.find_last_not_of(' ', blank);
    if (before == std::string::npos || blank + 1 == text.size())
        return;
    const std::string word = text.substr(blank + 1);
    const auto first = static_cast<unsigned char>(word.front());
    const bool is_word = std::isalpha(first) || first >= 0x80; // or the Greek letter mu
    // After an operator it is a name, which the expression parser will refuse.
    if (!is_word || std::string_view("+-*/^(,").find(text[before]) != std::string_view::npos ||
        word.find('(') != std::string::npos)
        return;
    throw InputError(place,
                     known_unit(word) ? fmt::format("{} is not measured in {}", name, word)
                                      : fmt::format("{} has the unknown unit '{}'", name, shortened(word, 100)),
                     *units ? fmt::format("give it in {}", units) : "give a number without a unit");
}

} // namespace

double quantity_of_text(const std::string& text, const std::string& name, const char* unit, const Place& place,
                        const Place& inside, const char* units) {
    const PhysicalUnit wanted = physical_unit(unit);
    units = units == nullptr ? unit : units;
    if (const auto split = split_unit(text)) {
        if (split->unit.dimension != wanted.dimension)
            throw InputError(place, fmt::format("{} is not measured in {}", name, split->name),
                             fmt::format("give it in {}", units));
        return converted(value_of_text(Model(), split->value, inside), split->unit, wanted);
    }
    require_no_unit(text, name, units, place);
    return value_of_text(Model(), text, inside);
}

double read_quantity(const StudyReader& reader, const TomlEntry& entry, const char* unit, const char* units) {
    if (!entry.node->is_string())
        return reader.number(Model(), entry);
    return quantity_of_text(reader.toml().line(entry), entry.path, unit, reader.toml().place(*entry.node),
                            reader.inside(entry), units);
}

} // namespace graze
