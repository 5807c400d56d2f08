#pragma once

#include "identify/fit_rows.hpp"

#include <functional>

namespace graze {

struct DescentReport {
    bool interrupted = false;
    bool least = false; ///< no motion that was tried beside the last one meets the readings better
    int iterations = 0;
};

/// Goes on from where pieces join, by motions that join exactly: only what is told by the first states of records and
/// by parameters moves, and each piece begins where the one before it ends. What keeps pieces together bends no valley
/// then, along which steps would be short.
///
/// Where a contact that is too slow to be told from noise passes a reading the sum of squares has a step, at whose edge
/// no derivative tells whether it is least. There each direction is tried by parts of its error, beyond the edge too.
///
/// The point stays as it was if its pieces join so loosely, as in chaos, that no motion that joins exactly is as good.
/// @param joint what gaps weigh. @param look whether directions are tried
/// @param tell is told half the sum of squares after each iteration: false ends it
DescentReport descend_joined(FitRows& rows, FitPoint& point, double joint, bool look,
                             const std::function<bool(double)>& tell);

} // namespace graze
