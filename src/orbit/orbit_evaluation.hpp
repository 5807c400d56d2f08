#pragma once

#include "graze/flow/watched_series.hpp"
#include "orbit/cyclic_system.hpp"

#include <complex>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Positions of the unknowns of an orbit's equations. Each segment is split into pieces, each with a start and a
/// duration:
///
///     (x_0, T_0, x_1, T_1, ..., inner unknowns, free parameters).
///
/// The pieces of a complete chatter sequence end with its contacts, the last one at the accumulation.
/// Inner unknowns are states within the pieces, as in collocation; shooting has none.
class OrbitLayout {
public:
    /// @param counts number of pieces of each segment, at least one; @param inner number of inner unknowns of each
    /// piece
    OrbitLayout(std::size_t states, const std::vector<std::size_t>& counts, std::size_t inner, std::size_t free,
                std::vector<bool> chatter = {})
        : states_(states), inner_(inner), free_(free), chatter_(std::move(chatter)) {
        chatter_.resize(counts.size(), false);
        for (const std::size_t count : counts) {
            first_.push_back(segments_.size());
            segments_.insert(segments_.end(), count, first_.size() - 1);
        }
    }

    std::size_t states() const { return states_; }
    std::size_t segments() const { return first_.size(); }
    std::size_t pieces() const { return segments_.size(); }
    std::size_t inner() const { return inner_; } ///< of each piece
    std::size_t free() const { return free_; }
    std::size_t unknowns() const { return parameter(free_); }

    std::size_t start_of(std::size_t piece) const { return piece * (states_ + 1); }
    std::size_t duration_of(std::size_t piece) const { return start_of(piece) + states_; }
    std::size_t inner_of(std::size_t piece) const { return start_of(pieces()) + piece * inner_; }
    std::size_t parameter(std::size_t index) const { return inner_of(pieces()) + index; }

    std::size_t segment_of(std::size_t piece) const { return segments_[piece]; }
    std::size_t first_piece(std::size_t segment) const { return first_[segment]; }
    /// The piece that ends with the end of the segment.
    std::size_t last_piece(std::size_t segment) const {
        return (segment + 1 < first_.size() ? first_[segment + 1] : pieces()) - 1;
    }
    bool is_last(std::size_t piece) const { return last_piece(segments_[piece]) == piece; }

    bool is_chatter(std::size_t segment) const { return chatter_[segment]; }
    /// True when the piece takes in all contacts that are left of a chatter sequence.
    bool accumulates(std::size_t piece) const { return is_last(piece) && chatter_[segments_[piece]]; }
    /// True when the piece ends with a contact within a chatter sequence.
    bool is_contact(std::size_t piece) const { return !is_last(piece) && chatter_[segments_[piece]]; }
    /// True when an end condition determines the duration of the piece; otherwise it is fixed.
    bool has_end(std::size_t piece) const { return is_last(piece) || chatter_[segments_[piece]]; }

private:
    std::size_t states_, inner_, free_;
    std::vector<bool> chatter_; ///< of each segment
    std::vector<std::size_t> first_, segments_;
};

/// The equations of an orbit and their derivatives at given unknowns. It is a value that may be kept and reused.
struct OrbitEvaluation {
    OrbitEvaluation(std::size_t states, std::size_t free) : system(states, free) {}

    /// One piece: the states before and after its end, with derivatives. Columns are derivatives with respect to the
    /// states at its start (`flow`) or at its end (`jump`), then to the free parameters.
    struct Piece {
        std::vector<double> end;   ///< state at the end, before the jump
        std::vector<double> after; ///< state after the jump
        Eigen::MatrixXd flow;      ///< derivatives of `end`, states x (states + free)
        WatchedSeries watched;     ///< event functions along the piece, if it was integrated
        Eigen::VectorXd field;     ///< vector field at the end
        Eigen::VectorXd by_time; ///< derivative of `end` with respect to the duration; equals `field` for an exact flow
        Eigen::MatrixXd inner; ///< derivatives of the inner unknowns with respect to start, duration, free parameters;
                               ///< last column: their defect
        Eigen::MatrixXd jump;  ///< derivatives of `after`, states x (states + free)
        Eigen::VectorXd condition;  ///< gradient of the end condition, for the last piece of a segment: states + free
        double condition_value = 0; ///< value of the end condition, zero on the orbit
        double condition_unit = 1;  ///< unit by which the row of the condition is divided
        /// Of a piece that takes in all contacts that are left: derivatives of its duration with respect to the states
        /// at its start and the free parameters. Its `flow` contains the change of this time, and `condition` is zero.
        Eigen::VectorXd time_by;
        double time_round_off = 0; ///< of that duration
    };

    Eigen::VectorXd unknowns; ///< unknowns of the evaluation; empty when it failed, and `problem` says why
    Eigen::VectorXd scales;   ///< scales of the unknowns and equations
    std::vector<double> parameters, periods;
    std::vector<Piece> pieces;
    std::vector<std::size_t> active; ///< states that are neither drifting nor neutral
    /// Of a homoclinic orbit: the excess of the distance from its saddle at which it begins, with the gradient with
    /// respect to its first state and the free parameters; and the eigenvalues of the saddle.
    double departure = 0;
    Eigen::VectorXd departure_by;
    std::vector<std::complex<double>> eigenvalues;
    Eigen::VectorXd effects; ///< largest derivative of the scaled equations with respect to each free parameter
    CyclicSystem system;     ///< the linearised equations, scaled
    double residual = 0;     ///< largest scaled residual
    std::string problem;
    bool took_too_long = false; ///< a segment takes too many steps: callers should not retry often

    bool is_at(const Eigen::VectorXd& u) const { return unknowns.size() == u.size() && unknowns == u; }
};

} // namespace graze
