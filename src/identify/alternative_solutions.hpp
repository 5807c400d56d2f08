#pragma once

#include "identify/fit_rows.hpp"

namespace graze {

/// An alternative solution, as a point of the fit.
struct FoundSolution {
    AlternativeSolution solution;
    FitPoint point;
    std::vector<std::size_t> modes; ///< modes of its pieces
    std::size_t changed_signs = 0;  ///< see `changed_signs_of`
};

/// Returns how many parameters and gains differ in sign from their guesses.
std::size_t changed_signs_of(const FitTask& task, const std::vector<double>& shared);

/// Searches for other solutions that fit the readings equally well: with the signs of up to three numbers changed,
/// phases shifted by half a period, all states reflected, or by a symmetry that the model declares, alone or together
/// with the signs of gains. Only numbers that differ from 0 by clearly more than their errors are considered.
/// @param known all evaluated pieces at the point. @param fit with its numbers
std::vector<FoundSolution> alternative_solutions(FitRows& rows, const FitPoint& point,
                                                 const std::vector<PieceRows>& known, const Fit& fit);

} // namespace graze
