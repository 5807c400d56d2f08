#pragma once

#include "graze/identify/estimate.hpp"

#include <string>
#include <vector>

namespace graze {

/// A number that was found from measurements, as results keep it.
struct EstimateRecord {
    std::string name; ///< the parameter's, where it is one
    std::string unit;
    Estimate estimate{}; ///< without freedom: its error is not known
    std::string note{};  ///< such as "at its bound"
};

/// What one run has found.
struct EstimateRecords {
    std::vector<EstimateRecord> numbers{};
    /// Of the numbers, row by row; 0 where nothing is known. Empty: nothing is known of any two of them.
    std::vector<double> covariance{};
};

} // namespace graze
