#pragma once

#include "identify/fit_information.hpp"

namespace graze {

/// Puts into a fit what is known at a point: numbers with their errors, what is not told, how well readings are met.
/// @param joint weight of gaps at which the point was found
void describe(FitRows& rows, const FitPoint& point, double joint, Fit& fit);

/// What makes a point the result, or not: half of the reasons are words for Fit::detail.
struct FitChecks {
    bool stationary = false; ///< a further step would change the numbers by a hundredth of their errors at most
    double gap = 0, allowed_gap = 0;
    std::string broken; ///< the first motion that ends early; empty without
    bool modes_agree = true;
};
/// What of the readings cannot be computed at a point. Empty if all can.
std::string unreadable(FitRows& rows, const FitPoint& point);

FitChecks check_point(FitRows& rows, const FitPoint& point, double joint);

/// Shared unknowns that are at a bound.
std::vector<int> bounded_at(const FitRows& rows, const FitPoint& point);

/// What is left of all readings: the sum of squares, by their ranges.
double squares_at(FitRows& rows, const FitPoint& point);

/// Standard deviations of what is left of each output.
std::vector<double> noise_at(FitRows& rows, const FitPoint& point);

} // namespace graze
