#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace graze {

/// A unit such as "um^2", "kg/m^3" or "Pa s": factor * 10^exponent times the coherent unit of its dimension.
struct PhysicalUnit {
    int exponent = 0;               ///< power of ten, relative to m, kg, s, A
    std::array<int, 5> dimension{}; ///< exponents of m, kg, s, A and degree
    double factor = 1;              ///< further factor: 60 for a minute

    bool operator==(const PhysicalUnit&) const = default;
};

/// Returns the symbol of a unit written as a word: "s" for "seconds", "ms" for "msec" and "mSec", "V" for "Volts", "mV"
/// for "millivolt", "h" for "hours". Other texts are returned unchanged; symbols are case-sensitive as in the SI, where
/// mS is millisiemens.
std::string unit_symbol(std::string_view text);

/// Parses a unit: a product of whole powers, separated by blanks or '*'; all factors behind a '/' divide. Known units
/// are m, g, s, A, Hz, N, Pa, J, W, V, F, ohm, H, Wb, T, S, rad (equal to 1) and deg, with the prefixes f, p, n, u (or
/// the Greek letter), m, c, k, M and G; min and h without prefixes; and the words of `unit_symbol`.
/// @throws InputError (without a place) if the text is not such a unit
PhysicalUnit physical_unit(std::string_view text);
/// Parses a unit as `physical_unit` does; returns nothing if the text is not a unit.
std::optional<PhysicalUnit> known_unit(std::string_view text);
/// Parses a unit as `known_unit` does; returns nothing for an empty text too.
std::optional<PhysicalUnit> told_unit(std::string_view text);

/// Converts a value to another unit, rounding once. @throws InputError if the dimensions differ
double converted(double value, const PhysicalUnit& from, const PhysicalUnit& to);

} // namespace graze
