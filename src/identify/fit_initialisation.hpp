#pragma once

#include "identify/fit_solver.hpp"

#include <functional>

namespace graze {

/// Weight of a soft prior for the early stages: a change of an unknown by a tenth of its scale costs as much as one
/// standard deviation of a reading. It keeps unknowns that the readings hardly determine near their values.
double prior_weight(const FitRows& rows);

using FitMinimiser = std::function<StageReport(const FitStage&)>;

/// Initialise a fit: move a point from its first guess to where pieces nearly join. The first pieces of all records are
/// fitted first, then twice as many, and so on. Each new piece starts from the parameters found so far, so that an
/// error of a frequency, say, cannot accumulate into a wrong phase.
///
/// By readings: initial states of pieces are taken from readings, and each piece is fitted by itself: wrong guesses and
/// chaos do not spread. Noise may create a slow contact at the start of a piece, or hide one.
StageReport initialise_by_readings(FitRows& rows, FitPoint& point, const FitMinimiser& minimise);
/// By prediction: initial states of pieces are the predicted final states of the pieces before, and pieces are kept
/// nearly joined: contacts are those of the continuous motion.
StageReport initialise_by_prediction(FitRows& rows, FitPoint& point, const FitMinimiser& minimise);

} // namespace graze
