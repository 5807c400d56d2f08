#pragma once

#include "identify/fit_rows.hpp"

#include <Eigen/Core>

#include <vector>

namespace graze {

/// Linearised least-squares problem in the shared unknowns and the unknown initial states of records, after the states
/// between pieces have been eliminated by the condition that pieces join. Unknowns are in their scales.
struct FitInformation {
    /// Triangular factor of all rows: columns are the initial states of each record, one record after another, then the
    /// shared unknowns, then the residuals.
    Eigen::MatrixXd rows;
    double eliminated = 0; ///< decrease of the sum of squares by the step of the eliminated states
};

/// Eliminates the initial states of all pieces but the first, from the last one back (square-root information filter:
/// G. J. Bierman, Factorization Methods for Discrete Sequential Estimation, 1977).
/// @param known all evaluated pieces; they must be finite
/// @param joint weight of gaps
FitInformation information_of(const FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known,
                              double joint);

/// Singular value decomposition of a FitInformation, with columns scaled to length 1.
struct FitDecomposition {
    Eigen::VectorXd lengths, values; ///< lengths of the columns before scaling; singular values, decreasing
    Eigen::MatrixXd directions;      ///< right singular vectors, as columns
    std::vector<bool> determined;    ///< for each singular value: whether it exceeds round-off
    Eigen::MatrixXd covariance; ///< covariance of the determined part, in scales, for rows with noise of variance 1
    std::vector<bool> known;    ///< for each unknown: whether it is determined
    double gain = 0;            ///< decrease of the sum of squares by a Gauss-Newton step,
    Eigen::VectorXd step;       ///< and that step, in scales
};
/// @param held unknowns that are fixed, such as those at bounds
FitDecomposition decompose(const FitInformation& information, const std::vector<bool>& held);

} // namespace graze
