#pragma once

#include "graze/identify/fit.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace graze {

/// A piece of a record: a time interval with an initial state of its own (multiple shooting).
struct FitPiece {
    std::size_t record = 0;
    std::size_t first = 0, last = 0; ///< its readings are first ... last - 1
    double begin = 0, end = 0;
    std::size_t mode = 0;  ///< mode at its beginning
    bool has_next = false; ///< another piece of the same record follows
    bool is_first = false; ///< the first piece of its record
};

/// Values of all unknowns, each divided by its scale.
struct FitPoint {
    Eigen::VectorXd shared; ///< parameters, then unknown gains, then unknown offsets
    /// Initial states of the pieces; of a record's first piece only the unknown ones.
    std::vector<Eigen::VectorXd> states;
};

/// Lists the unknowns, the pieces and the scales of a fit.
struct FitLayout {
    std::vector<std::size_t> gains, offsets; ///< outputs with unknown gains and unknown offsets
    std::vector<FitPiece> pieces;
    std::size_t parameters = 0, states = 0;
    Eigen::VectorXd shared_scale, state_scale;

    Eigen::Index shared() const { return static_cast<Eigen::Index>(parameters + gains.size() + offsets.size()); }
    /// The state that is a piece's unknown number `column`.
    static std::size_t state_of(const FitTask& task, const FitPiece& piece, Eigen::Index column) {
        const auto place = static_cast<std::size_t>(column);
        return piece.is_first ? task.records[piece.record].unknown_states[place] : place;
    }
    /// Number of unknown initial states of a piece.
    Eigen::Index unknown_states(const FitTask& task, const FitPiece& piece) const {
        return static_cast<Eigen::Index>(piece.is_first ? task.records[piece.record].unknown_states.size() : states);
    }
};

/// Number of all readings of a task, and of its unknowns.
std::size_t readings_of(const FitTask& task);
std::size_t unknowns_of(const FitTask& task);

/// Checks a task and its settings. @throws InputError for an invalid task (see fit_model)
void require_task(const System& system, const FitTask& task, const FitSettings& settings);

/// Cuts records into pieces at times where readings are smooth, that is, away from contacts.
std::vector<FitPiece> cut_records(const System& system, const FitTask& task, const FitSettings& settings);

} // namespace graze
