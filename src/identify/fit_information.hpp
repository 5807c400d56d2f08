#pragma once

#include "identify/fit_rows.hpp"

#include <Eigen/Core>

#include <vector>

namespace graze {

/// What readings say about the shared unknowns and the unknown states at the beginnings of records, given that pieces
/// join. In scales.
struct FitInformation {
    /// Triangular, of the sums of squares of all rows: columns are the states of each record, one after another, then
    /// what is shared, and what is left.
    Eigen::MatrixXd rows;
    double eliminated = 0; ///< by how much a step of the states in between would lessen the sum of squares
};

/// Eliminates the states at the beginnings of pieces that follow others, from the last one back (G. J. Bierman,
/// Factorization Methods for Discrete Sequential Estimation, 1977, of square roots of information).
/// @param known all pieces at the point, in which all is finite
/// @param joint weight of gaps
FitInformation information_of(const FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known,
                              double joint);

/// Of columns brought to length 1.
struct FitDecomposition {
    Eigen::VectorXd lengths, values; ///< of the columns; singular values, falling
    Eigen::MatrixXd directions;      ///< columns
    std::vector<bool> told;          ///< of each singular value: whether it is more than what round-off leaves
    Eigen::MatrixXd covariance;      ///< in scales, for a variance of 1 of the rows' noise, of what is told
    std::vector<bool> known;         ///< of each unknown: whether it is
    double gain = 0;                 ///< by how much a Gauss-Newton step would lessen the sum of squares,
    Eigen::VectorXd step;            ///< and that step, in scales
};
/// @param held unknowns that do not move, as those at bounds
FitDecomposition decompose(const FitInformation& information, const std::vector<bool>& held);

} // namespace graze
