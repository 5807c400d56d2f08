#pragma once

#include "identify/fit_rows.hpp"

#include <functional>

namespace graze {

/// Outcome of `descend_joined`.
struct DescentReport {
    bool interrupted = false;
    bool least = false; ///< none of the motions tried near the last one fits better
    int iterations = 0;
};

/// Continues a fit with motions whose pieces join exactly: only the initial states of records and the parameters move,
/// and each piece starts where the one before it ends. Without the penalty of gaps the cost has no curved valley, in
/// which steps would be short.
///
/// Where a contact too slow to be told from noise passes a reading, the sum of squares has a step, and derivatives
/// cannot tell whether the edge of the step is the minimum. There each direction is also tried by parts of its standard
/// error.
///
/// The point stays unchanged if its gaps are so large (as in chaos) that no exactly joined motion fits as well.
/// @param joint weight of gaps. @param probe whether directions are tried at the end
/// @param tell is called with half the sum of squares after each iteration; returning false stops
DescentReport descend_joined(FitRows& rows, FitPoint& point, double joint, bool probe,
                             const std::function<bool(double)>& tell);

} // namespace graze
