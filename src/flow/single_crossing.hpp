#pragma once

#include "flow/root_tracker.hpp"

#include <optional>
#include <span>

namespace graze::roots {

/// The result of a cheap test of a polynomial with at most one zero in a step; the location of the zero is found on
/// demand.
struct SingleCrossing {
    bool crosses = false;
    int at_start = 0; ///< sign at the start
    PointValue end{};
    /// Returns the location of the crossing, if there is one.
    double place(std::span<const double> c, double length) const;
};

/// Tests in one pass whether the polynomial is monotone or has a constant sign, as most are. Returns nothing for
/// others, for those that are zero at the start, and where round-off hides the sign at the end.
std::optional<SingleCrossing> single_crossing(std::span<const double> c, double length);

/// Returns an estimate of the zero of a monotone polynomial: that of the inverse approximated by the cubic with the
/// same values and slopes at both ends.
double guess_of_monotone(std::span<const double> c, double length, const PointValue& end);

} // namespace graze::roots
