#include "graze/base/physical_unit.hpp"

#include "base/letter_case.hpp"
#include "base/read_whole.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace graze {

namespace {

struct NamedUnit {
    std::string_view name;
    PhysicalUnit unit;
};
constexpr std::array units{
    NamedUnit{"m", {0, {1, 0, 0, 0, 0}}},    NamedUnit{"g", {-3, {0, 1, 0, 0, 0}}},
    NamedUnit{"s", {0, {0, 0, 1, 0, 0}}},    NamedUnit{"A", {0, {0, 0, 0, 1, 0}}},
    NamedUnit{"Hz", {0, {0, 0, -1, 0, 0}}},  NamedUnit{"N", {0, {1, 1, -2, 0, 0}}},
    NamedUnit{"Pa", {0, {-1, 1, -2, 0, 0}}}, NamedUnit{"J", {0, {2, 1, -2, 0, 0}}},
    NamedUnit{"W", {0, {2, 1, -3, 0, 0}}},   NamedUnit{"V", {0, {2, 1, -3, -1, 0}}},
    NamedUnit{"F", {0, {-2, -1, 4, 2, 0}}},  NamedUnit{"rad", {0, {0, 0, 0, 0, 0}}},
    NamedUnit{"deg", {0, {0, 0, 0, 0, 1}}},  NamedUnit{"ohm", {0, {2, 1, -3, -2, 0}}},
    NamedUnit{"H", {0, {2, 1, -2, -2, 0}}},  NamedUnit{"Wb", {0, {2, 1, -2, -1, 0}}},
    NamedUnit{"T", {0, {0, 1, -2, -1, 0}}},  NamedUnit{"S", {0, {-2, -1, 3, 2, 0}}},
};
/// Units that take no prefixes.
constexpr std::array whole_units{
    NamedUnit{"min", {0, {0, 0, 1, 0, 0}, 60}},
    NamedUnit{"h", {0, {0, 0, 1, 0, 0}, 3600}},
};

struct Prefix {
    std::string_view name;
    int exponent;
};
constexpr std::array prefixes{Prefix{"f", -15}, Prefix{"p", -12}, Prefix{"n", -9}, Prefix{"u", -6},
                              Prefix{"µ", -6},  Prefix{"μ", -6},  Prefix{"m", -3}, Prefix{"c", -2},
                              Prefix{"k", 3},   Prefix{"M", 6},   Prefix{"G", 9}};

/// Words for units in lower case, as instruments and people write them, and their symbols.
constexpr std::array<std::pair<std::string_view, std::string_view>, 31> spelt_units{{
    {"second", "s"},
    {"seconds", "s"},
    {"sec", "s"},
    {"secs", "s"},
    {"minute", "min"},
    {"minutes", "min"},
    {"mins", "min"},
    {"hour", "h"},
    {"hours", "h"},
    {"hr", "h"},
    {"hrs", "h"},
    {"volt", "V"},
    {"volts", "V"},
    {"ampere", "A"},
    {"amperes", "A"},
    {"amp", "A"},
    {"amps", "A"},
    {"watt", "W"},
    {"watts", "W"},
    {"ohm", "ohm"},
    {"ohms", "ohm"},
    {"hertz", "Hz"},
    {"metre", "m"},
    {"meter", "m"},
    {"metres", "m"},
    {"meters", "m"},
    {"newton", "N"},
    {"newtons", "N"},
    {"pascal", "Pa"},
    {"\xce\xa9", "ohm"},
    {"\xe2\x84\xa6", "ohm"},
}};
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> spelt_prefixes{
    {{"pico", "p"}, {"nano", "n"}, {"micro", "u"}, {"milli", "m"}, {"kilo", "k"}, {"mega", "M"}}};

/// Returns the symbol of a unit's word, or "" if the word is not known.
std::string_view symbol_of_word(std::string_view word) {
    const std::string small = in_small_letters(word);
    const auto* const found =
        std::find_if(spelt_units.begin(), spelt_units.end(), [&](const auto& one) { return one.first == small; });
    return found == spelt_units.end() ? std::string_view() : found->second;
}

bool takes_prefixes(std::string_view symbol) {
    return std::none_of(whole_units.begin(), whole_units.end(), [&](const auto& one) { return one.name == symbol; });
}

std::optional<PhysicalUnit> named(std::string_view name) {
    for (const NamedUnit& one : units)
        if (one.name == name)
            return one.unit;
    return std::nullopt;
}

/// Parses one factor without its power.
std::optional<PhysicalUnit> with_prefix(std::string_view text) {
    const std::string symbol = unit_symbol(text);
    const std::string_view name = symbol;
    for (const NamedUnit& one : whole_units)
        if (one.name == name)
            return one.unit;
    if (const auto plain = named(name))
        return plain;
    for (const Prefix& prefix : prefixes)
        if (name.starts_with(prefix.name))
            if (auto unit = named(name.substr(prefix.name.size()))) {
                unit->exponent += prefix.exponent;
                return unit;
            }
    return std::nullopt;
}

[[noreturn]] void refuse_unit(std::string_view text) {
    throw InputError(fmt::format("'{}' is no unit", text), "write it as um, GPa, kg/m^3 or Pa s");
}

} // namespace

std::string unit_symbol(std::string_view text) {
    if (const std::string_view symbol = symbol_of_word(text); !symbol.empty())
        return std::string(symbol);
    const auto behind = [&](std::string_view before, std::string_view prefix) {
        const std::string_view symbol = symbol_of_word(text.substr(before.size()));
        return symbol.empty() || !takes_prefixes(symbol) ? std::string() : std::string(prefix) + std::string(symbol);
    };
    const std::string small = in_small_letters(text);
    for (const auto& [word, prefix] : spelt_prefixes)
        if (small.starts_with(word))
            if (std::string symbol = behind(word, prefix); !symbol.empty())
                return symbol;
    // "MSec" is ambiguous (it may mean ms), so times take no large prefix.
    for (const Prefix& prefix : prefixes)
        if (text.starts_with(prefix.name))
            if (std::string symbol = behind(prefix.name, prefix.name);
                !symbol.empty() && (prefix.exponent < 0 || !symbol.ends_with('s')))
                return symbol;
    return std::string(text);
}

PhysicalUnit physical_unit(std::string_view text) {
    constexpr int most = 12; // largest power of a factor: keeps the sums of exponents small
    PhysicalUnit result;
    int sign = 1;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find_first_of(" */", at), text.size());
        const std::string_view factor = text.substr(at, end - at);
        if (!factor.empty() && factor != "1") {
            const std::size_t hat = factor.find('^');
            const auto unit = with_prefix(factor.substr(0, hat));
            int power = 1;
            if (hat != std::string_view::npos && (!read_whole(factor.substr(hat + 1), power) || std::abs(power) > most))
                refuse_unit(text);
            if (!unit || result.exponent > 1000 || result.exponent < -1000)
                refuse_unit(text);
            result.exponent += sign * power * unit->exponent;
            result.factor *= std::pow(unit->factor, sign * power);
            for (std::size_t i = 0; i < result.dimension.size(); ++i)
                result.dimension[i] += sign * power * unit->dimension[i];
        }
        if (end < text.size() && text[end] == '/')
            sign = -1;
        at = end + 1;
    }
    return result;
}

std::optional<PhysicalUnit> known_unit(std::string_view text) {
    try {
        return physical_unit(text);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

std::optional<PhysicalUnit> told_unit(std::string_view text) {
    return text.empty() ? std::nullopt : known_unit(text);
}

double converted(double value, const PhysicalUnit& from, const PhysicalUnit& to) {
    if (from.dimension != to.dimension)
        throw InputError("the units measure different things", "give a unit of the same kind");
    if (from.factor != to.factor)
        value *= from.factor / to.factor;
    const int power = from.exponent - to.exponent;
    // Powers of ten are exact up to 10^22: dividing by one rounds once, multiplying by its inverse rounds twice.
    return power < 0 ? value / std::pow(10.0, -power) : value * std::pow(10.0, power);
}

} // namespace graze
