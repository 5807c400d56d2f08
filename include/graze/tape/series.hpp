#pragma once

#include <cstddef>

namespace graze {

/// Coefficients of a power series of one lane, in the memory of a jet until its next `compute`; `stride` is the jet's
/// number of lanes.
struct Series {
    const double* first = nullptr;
    std::size_t stride = 1;
    double operator[](std::size_t k) const { return first[k * stride]; }
};

} // namespace graze
