#include "graze/base/physical_unit.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>

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
    NamedUnit{"T", {0, {0, 1, -2, -1, 0}}},
};

struct Prefix {
    std::string_view name;
    int exponent;
};
constexpr std::array prefixes{Prefix{"f", -15}, Prefix{"p", -12}, Prefix{"n", -9}, Prefix{"u", -6},
                              Prefix{"µ", -6},  Prefix{"μ", -6},  Prefix{"m", -3}, Prefix{"c", -2},
                              Prefix{"k", 3},   Prefix{"M", 6},   Prefix{"G", 9}};

std::optional<PhysicalUnit> named(std::string_view name) {
    for (const NamedUnit& one : units)
        if (one.name == name)
            return one.unit;
    return std::nullopt;
}

/// One factor without its power.
std::optional<PhysicalUnit> with_prefix(std::string_view name) {
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

[[noreturn]] void fail(std::string_view text) {
    throw InputError(fmt::format("'{}' is no unit", text), "write it as um, GPa, kg/m^3 or Pa s");
}

} // namespace

PhysicalUnit physical_unit(std::string_view text) {
    constexpr int most = 12; // of a power: further exponents stay small
    PhysicalUnit result;
    int sign = 1;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find_first_of(" */", at), text.size());
        const std::string_view factor = text.substr(at, end - at);
        if (!factor.empty() && factor != "1") {
            const std::size_t hat = factor.find('^');
            const auto unit = with_prefix(factor.substr(0, hat));
            int power = 1;
            if (hat != std::string_view::npos) {
                const std::string_view digits = factor.substr(hat + 1);
                const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), power);
                if (read.ec != std::errc() || read.ptr != digits.data() + digits.size() || std::abs(power) > most)
                    fail(text);
            }
            if (!unit || result.exponent > 1000 || result.exponent < -1000)
                fail(text);
            result.exponent += sign * power * unit->exponent;
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

double converted(double value, const PhysicalUnit& from, const PhysicalUnit& to) {
    if (from.dimension != to.dimension)
        throw InputError("the units measure different things", "give a unit of the same kind");
    const int power = from.exponent - to.exponent;
    // Powers of ten are exact up to 22: a division by one of them is rounded once, a product by its inverse twice.
    return power < 0 ? value / std::pow(10.0, -power) : value * std::pow(10.0, power);
}

} // namespace graze
