#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace graze {

/// A unit such as "um^2", "kg/m^3" or "Pa s": a power of ten of the unit of the SI with its dimension.
struct PhysicalUnit {
    int exponent = 0;               ///< of ten, in units of m, kg, s, A
    std::array<int, 5> dimension{}; ///< powers of m, kg, s, A and degree

    bool operator==(const PhysicalUnit&) const = default;
};

/// Units m, g, s, A, Hz, N, Pa, J, W, V, F, ohm, H, Wb, T, rad (which is 1) and deg, with the prefixes f, p, n, u (or
/// the Greek letter), m, c, k, M and G and whole powers, as factors between blanks or stars; behind a slash all that
/// follow divide.
/// @throws InputError (without a place) for anything else
PhysicalUnit physical_unit(std::string_view text);
/// The same, and nothing for what is no unit.
std::optional<PhysicalUnit> known_unit(std::string_view text);

/// A value in another unit, rounded once. @throws InputError where the units measure different things
double converted(double value, const PhysicalUnit& from, const PhysicalUnit& to);

} // namespace graze
