#include "branch/resonances.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace graze {

namespace {

/// Some resonance with a greater denominator is near any rotation number.
constexpr std::size_t largest_near = 8;

} // namespace

std::optional<Resonance> resonance_near(double rotation, double distance) {
    for (std::size_t q = 1; q <= largest_near; ++q) {
        const double numerator = std::round(rotation * static_cast<double>(q));
        if (std::abs(rotation - numerator / static_cast<double>(q)) <= distance)
            return Resonance{static_cast<long>(numerator), q};
    }
    return std::nullopt;
}

std::vector<Resonance> resonances_between(double from, double to) {
    std::vector<Resonance> passed;
    const double least = std::min(from, to), greatest = std::max(from, to);
    for (std::size_t q = 1; q <= Resonance::largest; ++q)
        for (auto p = static_cast<long>(std::ceil(least * static_cast<double>(q)));; ++p) {
            const Resonance one{p, q};
            if (!(one.value() <= greatest))
                break;
            if (std::gcd(p, static_cast<long>(q)) == 1 && one.value() != from)
                passed.push_back(one);
        }
    std::ranges::sort(passed, [&](const Resonance& one, const Resonance& other) {
        return from < to ? one.value() < other.value() : one.value() > other.value();
    });
    return passed;
}

} // namespace graze
