#pragma once

#include <cstddef>

namespace graze {

/// Coefficients of a power series where a jet left them, until its next `compute`: those of one lane are as many numbers apart as it has lanes.
struct Series {
    const double* first = nullptr;
    std::size_t stride = 1;
    double operator[](std::size_t k) const { return first[k * stride]; }
};

} // namespace graze
