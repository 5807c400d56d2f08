#pragma once

// Products and reciprocals of known series of one lane, with many orders side by side in a register. To be included
// only by the translation unit of an instruction set.

#include "tape/kernels.hpp"

#if defined(__FMA__)
namespace graze::GRAZE_INSTRUCTION_SET {

/// Shifts lanes up by one; the free lane takes the last number of `before`.
GRAZE_INLINE Pack moved_up(Pack before, Pack numbers) {
#if defined(__AVX512F__)
    // The mask selects all lanes; without it g++ 12 warns of uninitialised values.
    return _mm512_castsi512_pd(
        _mm512_maskz_alignr_epi64(0xff, _mm512_castpd_si512(numbers), _mm512_castpd_si512(before), lanes - 1));
#else
    return _mm256_blend_pd(_mm256_permute4x64_pd(numbers, 0x93), _mm256_permute4x64_pd(before, 0x93), 1);
#endif
}
/// Shifts lanes down by one; the free lane takes the first number of `behind`.
GRAZE_INLINE Pack moved_down(Pack numbers, Pack behind) {
#if defined(__AVX512F__)
    return _mm512_castsi512_pd(
        _mm512_maskz_alignr_epi64(0xff, _mm512_castpd_si512(behind), _mm512_castpd_si512(numbers), 1));
#else
    return _mm256_blend_pd(_mm256_permute4x64_pd(numbers, 0x39), _mm256_permute4x64_pd(behind, 0x39), 8);
#endif
}
/// Stores lanes first .. end - 1.
GRAZE_INLINE void put_lanes(double* to, Pack numbers, Order first, Order end) {
#if defined(__AVX512F__)
    _mm512_mask_storeu_pd(to, static_cast<__mmask8>((0xffU << first) & ~(~0U << end)), numbers);
#else
    const __m256i lane = _mm256_setr_epi64x(0, 1, 2, 3);
    _mm256_maskstore_pd(to,
                        _mm256_andnot_si256(_mm256_cmpgt_epi64(_mm256_set1_epi64x(first), lane),
                                            _mm256_cmpgt_epi64(_mm256_set1_epi64x(end), lane)),
                        numbers);
#endif
}

/// Multiplies two known series of one lane, all orders side by side in `packs` registers. For each coefficient of one
/// series, the other has been shifted up by one order. (Values read beyond the last coefficient affect only higher
/// orders, which are not stored.)
template <int packs>
GRAZE_INLINE void product_in_packs(const KernelOperands& o, Order highest) {
    Pack moved[packs], sums[packs];
    for (int i = 0; i < packs; ++i) {
        __builtin_memcpy(&moved[i], o.right + i * lanes, sizeof(Pack));
        sums[i] = splat(0);
    }
    const auto add_block = [&]<int block>()
        __attribute__((always_inline)) { // packs before `block` have been shifted to zero
        const Order first = block * lanes, end = block + 1 < packs ? first + lanes : highest + 1;
        for (Order j = first; j < end; ++j) {
            const Pack factor = splat(o.left[j]);
            for (int i = block; i < packs; ++i)
                sums[i] = multiply_add(factor, moved[i], sums[i]);
            for (int i = packs - 1; i > block; --i)
                moved[i] = moved_up(moved[i - 1], moved[i]);
            moved[block] = moved_up(splat(0), moved[block]);
        }
    };
    [&]<int... block>(Indices<block...>) __attribute__((always_inline)) {
        (add_block.template operator()<block>(), ...);
    }
    (std::make_integer_sequence<int, packs>{});
    for (int i = 0; i < packs; ++i) {
        const Order left = highest + 1 - i * lanes;
        put_lanes(o.result + i * lanes, sums[i], i == 0 ? 2 : 0, left < lanes ? left : lanes);
    }
}

/// Computes the reciprocal of a known series. The sums of all remaining orders are side by side, the next first: each
/// new coefficient is immediately added to the sums of higher orders.
template <int packs>
GRAZE_INLINE void reciprocal_in_packs(const KernelOperands& o, Order highest) {
    Pack known[packs], sums[packs];
    const double first = o.result[0];
    for (int i = 0; i < packs; ++i) {
        __builtin_memcpy(&known[i], o.left + 1 + i * lanes, sizeof(Pack));
        sums[i] = splat(first) * known[i];
    }
    const auto add = [&](double coefficient) __attribute__((always_inline)) {
        for (int i = 0; i < packs; ++i)
            sums[i] =
                multiply_add(splat(coefficient), known[i], moved_down(sums[i], i + 1 < packs ? sums[i + 1] : splat(0)));
    };
    add(o.result[1]);
    for (Order k = 2; k <= highest; ++k) {
        const double coefficient = -(sums[0][0] * first);
        o.result[k] = coefficient;
        add(coefficient);
    }
}

/// Choose the number of packs that the order needs.
template <int packs = 1>
GRAZE_INLINE void whole_product(const KernelOperands& o, Order highest) {
    if constexpr (packs * lanes <= highest_order)
        if (highest >= packs * lanes)
            return whole_product<packs + 1>(o, highest);
    product_in_packs<packs>(o, highest);
}
template <int packs = 1>
GRAZE_INLINE void whole_reciprocal(const KernelOperands& o, Order highest) {
    if constexpr (packs * lanes < highest_order)
        if (highest > packs * lanes)
            return whole_reciprocal<packs + 1>(o, highest);
    reciprocal_in_packs<packs>(o, highest);
}

} // namespace graze::GRAZE_INSTRUCTION_SET
#endif
