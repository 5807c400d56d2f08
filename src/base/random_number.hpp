#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace graze {

// Numbers that look random, each of its place alone and not of those drawn before: whoever draws them, in whatever
// order, on whatever thread, gets the same.

/// A number that looks random, of another one (G. L. Steele, D. Lea and C. H. Flood, "Fast splittable pseudorandom
/// number generators", 2014).
inline std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

/// Evenly in (0, 1), without either end. @param item such as the device; @param place within what is drawn for it
inline double drawn(std::uint64_t seed, std::size_t item, std::size_t place) {
    const std::uint64_t bits = mixed(mixed(mixed(seed) ^ static_cast<std::uint64_t>(item)) ^ place);
    return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
}

/// By the standard normal distribution (G. E. P. Box and M. E. Muller, 1958).
inline double drawn_normal(std::uint64_t seed, std::size_t item, std::size_t place) {
    const double first = drawn(seed, item, 2 * place), second = drawn(seed, item, 2 * place + 1);
    return std::sqrt(-2 * std::log(first)) * std::cos(2 * std::numbers::pi * second);
}

} // namespace graze
