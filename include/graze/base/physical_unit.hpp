#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace graze {

/// A unit such as "um^2", "kg/m^3" or "Pa s": a multiple of the unit of the SI with its dimension.
struct PhysicalUnit {
    int exponent = 0;               ///< of ten, in units of m, kg, s, A
    std::array<int, 5> dimension{}; ///< powers of m, kg, s, A and degree
    double factor = 1;              ///< beside the power of ten: 60 of a minute

    bool operator==(const PhysicalUnit&) const = default;
};

/// The symbol of a unit that is written as a word: "seconds" is s, "msec" and "mSec" ms, "Volts" V, "millivolt" mV,
/// "hours" h. All else stays: symbols mean by their case what they do in the SI, where mS is millisiemens.
std::string unit_symbol(std::string_view text);

/// Units m, g, s, A, Hz, N, Pa, J, W, V, F, ohm, H, Wb, T, S, rad (which is 1) and deg, with the prefixes f, p, n, u
/// (or the Greek letter), m, c, k, M and G, besides min and h, and words for them (see above), with whole powers, as
/// factors between blanks or stars; behind a slash all that follow divide.
/// @throws InputError (without a place) for anything else
PhysicalUnit physical_unit(std::string_view text);
/// The same, and nothing for what is no unit.
std::optional<PhysicalUnit> known_unit(std::string_view text);
/// The same, and nothing for a text that says none.
std::optional<PhysicalUnit> told_unit(std::string_view text);

/// A value in another unit, rounded once. @throws InputError where the units measure different things
double converted(double value, const PhysicalUnit& from, const PhysicalUnit& to);

} // namespace graze
