#pragma once

#include "identify/fit_rows.hpp"

namespace graze {

struct FoundTwin {
    FitTwin twin;
    FitPoint point;
    std::vector<std::size_t> modes; ///< of pieces
    std::size_t strays = 0;         ///< as `strays_of`
};

/// How many parameters and gains have another sign than their guesses.
std::size_t strays_of(const FitTask& task, const std::vector<double>& shared);

/// Other solutions that meet the readings as well: signs of up to three numbers changed, phases half a period later,
/// all states mirrored, or a symmetry that the model declares, alone or with the signs of gains. Only numbers that are
/// known, and not within their errors of 0, count.
/// @param known all pieces at the point. @param fit with its numbers
std::vector<FoundTwin> twins_of(FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known,
                                const Fit& fit);

} // namespace graze
