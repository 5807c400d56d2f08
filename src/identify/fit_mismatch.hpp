#pragma once

#include "identify/fit_rows.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// A channel of which the model makes something else than was measured.
struct FitMismatch {
    std::size_t output = 0, record = 0;
    double since = 0; ///< time
    double size = 0;  ///< root of the mean square of what is left, relative to the range of the readings
    /// By which the readings are larger than what the model makes, where they are in proportion; 0: they are not.
    double factor = 0;
};

/// Those by far more than a fit leaves that is on its way. @param known of the pieces, of which some may not be finite
std::vector<FitMismatch> mismatches_of(const FitRows& rows, const std::vector<PieceRows>& known);
/// In one line; empty for none.
std::string text_of(const std::vector<FitMismatch>& mismatches, const FitTask& task);

} // namespace graze
