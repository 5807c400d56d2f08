#pragma once

#include "graze/identify/fit.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace graze {

/// A piece of a record.
struct FitPiece {
    std::size_t record = 0;
    std::size_t first = 0, last = 0; ///< its readings: first ... last - 1
    double begin = 0, end = 0;
    std::size_t mode = 0; ///< at its beginning
    bool leads = false;   ///< a piece of the same record follows
    bool opening = false; ///< the first of its record
};

/// All unknowns, each divided by its scale.
struct FitPoint {
    Eigen::VectorXd shared;              ///< parameters, then unknown gains, then unknown offsets
    std::vector<Eigen::VectorXd> states; ///< at the beginnings of pieces; of opening ones those that are unknown
};

/// Which unknowns there are, and how large they are.
struct FitLayout {
    std::vector<std::size_t> gains, offsets; ///< outputs of which these are unknown
    std::vector<FitPiece> pieces;
    std::size_t parameters = 0, states = 0;
    Eigen::VectorXd shared_scale, state_scale;

    Eigen::Index shared() const { return static_cast<Eigen::Index>(parameters + gains.size() + offsets.size()); }
    /// States at the beginning of a piece that are unknown.
    Eigen::Index unknown_states(const FitTask& task, const FitPiece& piece) const {
        return static_cast<Eigen::Index>(piece.opening ? task.records[piece.record].unknown_states.size() : states);
    }
};

/// @throws InputError for tasks without meaning
void require_task(const System& system, const FitTask& task, const FitSettings& settings);

/// Cuts records into pieces where readings are smooth, which they are not at contacts.
std::vector<FitPiece> cut_records(const System& system, const FitTask& task, const FitSettings& settings);

} // namespace graze
