#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace graze {

// Pseudorandom numbers that depend on their position alone, not on earlier draws: results are the same in any order of
// evaluation and on any number of threads.

/// Returns the output of SplitMix64 (G. L. Steele, D. Lea and C. H. Flood, "Fast splittable pseudorandom number
/// generators", 2014) in the state `x`.
inline std::uint64_t scrambled(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

/// Returns a hash of `x`, one step of SplitMix64.
inline std::uint64_t mixed(std::uint64_t x) {
    return scrambled(x + 0x9e3779b97f4a7c15ULL);
}

/// Returns a uniform number in the open interval (0, 1). @param item such as the device; @param place index of the draw
inline double drawn(std::uint64_t seed, std::size_t item, std::size_t place) {
    const std::uint64_t bits = mixed(mixed(mixed(seed) ^ static_cast<std::uint64_t>(item)) ^ place);
    return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
}

/// Returns a standard normal number (G. E. P. Box and M. E. Muller, 1958). Parameters as for `drawn`.
inline double drawn_normal(std::uint64_t seed, std::size_t item, std::size_t place) {
    const double first = drawn(seed, item, 2 * place), second = drawn(seed, item, 2 * place + 1);
    return std::sqrt(-2 * std::log(first)) * std::cos(2 * std::numbers::pi * second);
}

} // namespace graze
