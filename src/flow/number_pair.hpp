#pragma once

#include <bit>
#include <cstring>

namespace graze {

/// Two numbers in a SIMD register that every processor has.
typedef double NumberPair __attribute__((vector_size(16)));

inline NumberPair load_pair(const double* from) {
    NumberPair pair;
    std::memcpy(&pair, from, sizeof pair);
    return pair;
}

inline NumberPair absolute(NumberPair pair) {
    typedef long long Bits __attribute__((vector_size(16)));
    constexpr long long all_but_sign = 0x7fffffffffffffff;
    return std::bit_cast<NumberPair>(std::bit_cast<Bits>(pair) & Bits{all_but_sign, all_but_sign});
}

} // namespace graze
