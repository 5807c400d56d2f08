#include "layout/quantity_reader.hpp"

#include "graze/symbolic/physical_unit.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace graze {

namespace {

std::optional<PhysicalUnit> unit_in(std::string_view text) {
    try {
        return physical_unit(text);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

} // namespace

double read_quantity(const StudyReader& reader, const TomlEntry& entry, const char* unit) {
    if (!entry.node->is_string())
        return reader.number(Model(), entry);
    const PhysicalUnit wanted = physical_unit(unit);
    const std::string text = reader.toml().line(entry);
    // The unit begins behind a blank, and may have blanks itself: the longest one counts.
    for (std::size_t blank = text.find(' '); blank != std::string::npos; blank = text.find(' ', blank + 1)) {
        const auto given = unit_in(std::string_view(text).substr(blank + 1));
        const bool is_unit = given && text.find_first_not_of(" *1", blank) != std::string::npos;
        if (is_unit && given->dimension != wanted.dimension)
            reader.fail(entry, fmt::format("{} is not measured in {}", entry.path, text.substr(blank + 1)),
                        fmt::format("give it in {}", unit));
        if (is_unit)
            return converted(value_of_text(Model(), text.substr(0, blank), reader.inside(entry)), *given, wanted);
    }
    return reader.number(Model(), entry);
}

void require_within(double value, const std::string& what, const char* unit, double least, double greatest) {
    if (!(value >= least && value <= greatest))
        throw InputError(fmt::format("{} is {}{}{}", what, value, *unit ? " " : "", unit),
                         fmt::format("give a number from {} to {}", least, greatest));
}

} // namespace graze
