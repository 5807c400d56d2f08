#pragma once

#include "identify/fit_solver.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace graze {

/// Weight of a soft prior for the early stages: a change of an unknown by a tenth of its scale costs as much as one
/// standard deviation of a reading. It keeps unknowns that the readings hardly determine near their values.
double prior_weight(const FitRows& rows);

/// Initialises a fit: moves a point from its first guess to where pieces nearly join. The first pieces of all records
/// are fitted first, then twice as many, and so on. Each new piece starts from the parameters found so far, so that an
/// error of a frequency, say, cannot accumulate into a wrong phase.
class FitInitialisation {
public:
    using Minimiser = std::function<StageReport(const FitStage&)>;
    FitInitialisation(FitRows& rows, FitPoint& point, Minimiser minimise)
        : rows_(&rows), point_(&point), minimise_(std::move(minimise)) {}

    /// Initial states of pieces are taken from readings, and each piece is fitted by itself: wrong guesses and chaos do
    /// not spread. Noise may create a slow contact at the start of a piece, or hide one.
    StageReport by_readings();
    /// Initial states of pieces are the predicted final states of the pieces before, and pieces are kept nearly joined:
    /// contacts are those of the continuous motion.
    StageReport by_prediction();

private:
    template <class Begin>
    StageReport extend(FitStage together, const Begin& begin);
    StageReport initialise_piece(std::size_t& piece);
    StageReport best_initial_state(const FitStage& stage, std::size_t piece);
    FitStage alone(std::size_t piece) const;
    double usual_cost();
    std::size_t ordinal(std::size_t piece) const;
    std::size_t most_pieces() const;
    std::vector<FitPiece>& pieces() { return rows_->layout.pieces; }

    FitRows* rows_;
    FitPoint* point_;
    Minimiser minimise_;
    std::vector<double> usual_costs_; ///< cost per reading of the pieces fitted so far
};

} // namespace graze
