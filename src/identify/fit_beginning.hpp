#pragma once

#include "identify/fit_solver.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace graze {

/// While little is known, a change by a tenth counts as much as one reading's noise: what noise alone would move far
/// stays near.
double prior_weight(const FitRows& rows);

/// Leads a point from its first guess to where pieces nearly join. The first pieces of records come alone, then twice
/// as many, and so on: each begins where what is known by then leads to, so that a wrong frequency, say, does not add
/// up to a wrong phase.
class FitBeginning {
public:
    using Minimiser = std::function<StageReport(const FitStage&)>;
    FitBeginning(FitRows& rows, FitPoint& point, Minimiser minimise)
        : rows_(&rows), point_(&point), minimise_(std::move(minimise)) {}

    /// Pieces begin with the states that readings tell, each by itself: wrong guesses and chaos do not reach far. Noise
    /// may make a slow contact there, or hide it.
    StageReport by_readings();
    /// Pieces begin where the motion before them leads, and hardly leave it: contacts are those of the whole motion.
    StageReport by_prediction();

private:
    template <class Begin>
    StageReport extend(FitStage together, const Begin& begin);
    StageReport begin_piece(std::size_t& piece);
    StageReport best_opening(const FitStage& stage, std::size_t piece);
    FitStage alone(std::size_t piece) const;
    double usual_cost();
    std::size_t ordinal(std::size_t piece) const;
    std::size_t most_pieces() const;
    std::vector<FitPiece>& pieces() { return rows_->layout.pieces; }

    FitRows* rows_;
    FitPoint* point_;
    Minimiser minimise_;
    std::vector<double> usual_costs_; ///< by reading, of pieces that have begun
};

} // namespace graze
