#pragma once

#include "graze/identify/estimate.hpp"

#include <string>
#include <vector>

namespace graze {

/// A number estimated from measurements, as a result file stores it.
struct EstimateRecord {
    std::string name; ///< the name of the parameter, if the number is one
    std::string unit;
    Estimate estimate{}; ///< the error is unknown if there are no degrees of freedom
    std::string note{};  ///< for example "at its bound"; empty: none
};

/// The estimates of one run of kind `identify`.
struct EstimateRecords {
    std::vector<EstimateRecord> numbers{};
    /// Covariance matrix of the numbers, row by row; 0 where a covariance is unknown. Empty: all are unknown.
    std::vector<double> covariance{};
};

} // namespace graze
