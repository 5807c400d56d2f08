#pragma once

#include "identify/fit_rows.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// A channel that the model does not reproduce.
struct FitMismatch {
    std::size_t output = 0, record = 0;
    double since = 0; ///< time from which on it differs
    double size = 0;  ///< root mean square of the residuals, relative to the range of the readings
    /// Ratio of readings to model values if they are proportional; otherwise 0.
    double factor = 0;
};

/// Returns the channels whose residuals are far larger than those of a fit that may still converge. @param known the
/// evaluated pieces, some of which may not be finite
std::vector<FitMismatch> mismatches_of(const FitRows& rows, const std::vector<PieceRows>& known);
/// Describes mismatches in one line; empty if there are none.
std::string text_of(const std::vector<FitMismatch>& mismatches, const FitTask& task);

} // namespace graze
