#pragma once

#include "flow/root_tracker.hpp"

#include <optional>
#include <span>

namespace graze::roots {

/// What is known of a polynomial that passes zero once or never within a step, before anybody asks where.
struct LoneCrossing {
    bool crosses = false;
    int at_start = 0; ///< the sign there
    PointValue end{};
    /// Of one that crosses.
    double place(std::span<const double> c, double length) const;
};

/// Most polynomials rise or fall throughout, or keep their sign, as one pass shows. Nothing for others, for those that
/// are zero at the start, and where round-off hides the sign at the end.
std::optional<LoneCrossing> lone_crossing(std::span<const double> c, double length);

/// Of a polynomial that rises or falls from start to end, where it passes zero if its inverse is the cubic that has its
/// slopes.
double guess_of_monotone(std::span<const double> c, double length, const PointValue& end);

} // namespace graze::roots
