#pragma once

#include "base/special_numbers.hpp"
#include "bernstein.hpp"
#include "number_pair.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace graze::roots {

/// The sign of a sum throughout an interval (0 if not certain), and the least size of the sum.
struct Kept {
    int sign = 0;
    double least = 0;
};

/// Returns the sum of factor(k) |c_k| s^(k - first), k >= first. Odd and even terms are summed side by side.
template <class Factor>
double sum_of_sizes(std::span<const double> c, std::size_t first, double s, Factor factor) {
    const double square = s * s;
    double sums[2] = {0, 0};
    std::size_t k = c.size();
    if ((k - first) % 2 == 1) {
        --k;
        sums[0] = factor(static_cast<double>(k)) * std::abs(c[k]);
    }
    double orders[2] = {static_cast<double>(k), static_cast<double>(k) + 1};
    for (const double* pair = c.data() + k; k > first; k -= 2) {
        pair -= 2;
        for (std::size_t j = 0; j < 2; ++j) {
            orders[j] -= 2;
            sums[j] = sums[j] * square + factor(orders[j]) * std::abs(pair[j]);
        }
    }
    return sums[0] + sums[1] * s;
}

/// Returns the sign of the sum of factor(k) c_k s^(k - first), k >= first, if it is constant for 0 <= s <= length: the
/// sum is between its partial sums at `length`, as in `enclosure`. Only sizes are used of the small terms after the
/// first ones.
/// @param factor computed without rounding
template <class Factor>
Kept kept_sign(std::span<const double> c, std::size_t first, double length, Factor factor) {
    if (c.size() <= first || !(length > 0))
        return {};
    constexpr std::size_t signed_terms = 8;
    const double sign = c[first] > 0 ? 1 : -1;
    double sum = 0, size = 0, power = sign, least = infinity, order = static_cast<double>(first);
    const std::size_t behind = std::min(c.size(), first + signed_terms);
    for (std::size_t k = first; k < behind; ++k) {
        const double term = factor(order) * c[k] * power;
        sum += term;
        size += std::abs(term);
        least = std::min(least, sum);
        power *= length;
        order += 1;
    }
    const double rest = sum_of_sizes(c, behind, length, factor) * std::abs(power);
    // The product with the factor is rounded too.
    const double share = bernstein::unit_roundoff * static_cast<double>(2 * c.size() + 9);
    least = std::min(least, sum - rest) - share * (size + rest);
    return least > 0 && least < infinity ? Kept{sign > 0 ? 1 : -1, least} : Kept{};
}

/// Returns 1 or -1 if the polynomial has that sign throughout, else 0.
inline int kept_sign(std::span<const double> c, double length) {
    return kept_sign(c, 0, length, [](double) { return 1; }).sign;
}

/// A constant sign found by a cheap test, and the sum of the sizes of all terms.
struct ClearSign {
    int sign = 0; ///< 0 not certain, including sums within some hundred round-offs of zero
    double size = 0;
};

/// Tests the polynomial, or its derivative. Only the first 3 to 6 terms are summed with their signs; of the others
/// sizes are summed, four at a time. The code is kept short, since it runs in every step and shares the instruction
/// cache with the kernels, which nearly fill it.
template <bool derivative>
ClearSign clear_sign(std::span<const double> c, double length) {
    constexpr std::size_t block = 4, least_signed = 3, first = derivative ? 1 : 0;
    if (c.size() < first + least_signed || !(length > 0))
        return {0, std::numeric_limits<double>::infinity()};
    const std::size_t behind = c.size() - (c.size() - first - least_signed) / block * block;
    const double square = length * length, fourth = square * square;
    NumberPair low{}, high{}, low_orders{}, high_orders{};
    if constexpr (derivative) {
        const auto size = static_cast<double>(c.size());
        low_orders = NumberPair{size, size + 1};
        high_orders = NumberPair{size + 2, size + 3};
    }
    for (const double* some = c.data() + c.size(); some != c.data() + behind;) {
        some -= block;
        NumberPair one = absolute(load_pair(some)), other = absolute(load_pair(some + 2));
        if constexpr (derivative) {
            low_orders -= static_cast<double>(block);
            high_orders -= static_cast<double>(block);
            one *= low_orders;
            other *= high_orders;
        }
        low = low * fourth + one;
        high = high * fourth + other;
    }
    const double sign = std::copysign(1.0, c[first]);
    double sum = sign * c[first], size = std::abs(sum), power = sign, least = sum;
    for (std::size_t k = first + 1; k < behind; ++k) {
        power *= length;
        const double term = (derivative ? static_cast<double>(k) * c[k] : c[k]) * power;
        sum += term;
        size += std::abs(term);
        least = std::min(least, sum);
    }
    const NumberPair both = low + high * square;
    const double rest = (both[0] + both[1] * length) * std::abs(power * length);
    size += rest;
    const double margin = bernstein::unit_roundoff * static_cast<double>(256 + 2 * static_cast<int>(c.size()));
    // Written so that NaN gives no sign.
    if (!(least - rest > margin * size && size < std::numeric_limits<double>::infinity()))
        return {0, size};
    return {c[first] > 0 ? 1 : -1, size};
}

} // namespace graze::roots
