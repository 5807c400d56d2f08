#pragma once

#include "graze/flow/couplings.hpp"
#include "graze/flow/mode_jets.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Carries derivatives of a flow in several directions along its steps, as many directions at once as tangent jets
/// have lanes.
///
/// The error of a direction's component is measured against the component's size, or, where that is less, against what
/// the direction's other components make of it within the response time of the flow (see Couplings): errors that these
/// are allowed come to as much there. A component that has only begun to differ from zero, such as the motion of the
/// far end of a chain of oscillators, therefore needs no shorter steps than the others.
///
/// Matrices are row by row, [row * directions + direction].
class TangentSteps {
public:
    /// What derivatives are allowed of the tolerance of the states: what is cut off is far smaller than the last terms.
    static constexpr double allowance = 50;
    /// Parts of a step that directions may need which are faster than the motion, or than the first ones.
    static constexpr int most_parts = 200'000;

    /// @param tolerance of the states; @param directions any number of them
    TangentSteps(const System& system, int order, double tolerance, std::size_t directions);

    /// @param seeds of the parameters in the directions, parameters x directions
    void set_parameters(std::span<const double> parameters, std::span<const double> seeds);

    /// The series at the start of a step: those of states, watched events and observed expressions, and of their
    /// derivatives in the directions from `first` on. @param matrix of the states' derivatives
    const Jet& begin(std::size_t mode, std::span<const double> state, std::span<const double> matrix,
                     std::size_t first = 0);
    /// Directions that a jet has, from the first on.
    std::size_t count_from(std::size_t first) const { return std::min(lanes_, directions_ - first); }

    /// Whether polynomials and model agree at the end of a step forwards, after `begin` for the first directions: as
    /// Jet::find_disagreement asks, of states and outputs. `carry` over the same step then goes on from there.
    bool agrees(std::size_t mode, double length, const EndAllowance& allowed);
    /// Carries all directions along a step, after `begin` for the first ones: as far as these may be carried at once,
    /// and others as far, in parts if need be.
    /// @param after the matrix at the end; @param output row of that output's derivatives there, `row`, unless it is
    /// empty
    /// @return how far, at most `length`; 0 where a direction is so much faster than the first ones that it did not
    /// come as far in `most_parts`
    double carry(std::size_t mode, std::span<const double> state, std::span<const double> matrix, double length,
                 std::span<double> after, std::size_t output = 0, std::span<double> row = {});
    /// Where `carry` has led to.
    std::span<const double> state() const { return state_; }

private:
    void load_parameters(std::size_t mode, std::size_t first);
    double follow(const Jet& jet, std::size_t mode, std::size_t first, double length, bool seen = false);
    std::span<const double> floors_of(const Jet& jet, std::size_t mode, std::size_t count, double length);
    std::span<const double> noise_of(const Jet& jet, std::size_t mode, std::size_t count);
    const Couplings& couplings_here(std::size_t mode);
    void finish(const Jet& jet, std::size_t first, std::span<double> after, std::size_t output, std::span<double> row);

    System system_;
    std::size_t states_, directions_;
    double tolerance_;
    ModeJets jets_;
    std::size_t lanes_;
    bool parameters_move_ = false; ///< along some direction
    std::vector<double> parameters_, parameter_seeds_, parameter_lanes_;
    std::vector<double> seeds_, sums_, slopes_, times_, state_, disagreement_;
    double seen_ = 0; ///< length of a step whose end is in `sums_` and `slopes_`; 0: none
    ModeCouplings couplings_;
    std::span<const double> place_;       ///< state at which couplings are wanted
    const Couplings* measured_ = nullptr; ///< what they are there, once it has been asked for
    std::vector<double> floors_, noise_;  ///< [state * width + lane]
};

} // namespace graze
