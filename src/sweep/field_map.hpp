#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Largest states that are examined for unlimited growth: products of two such numbers are still finite.
inline constexpr double end_of_growth = 1e150;

/// Returns element k of a sequence that fills the unit interval evenly.
double even_place(std::size_t k);

/// Returns whether a transition has no effect: no jump, and the same mode continues.
bool changes_nothing(const Transition& transition);

/// The vector fields of all modes with their derivatives by the states. Immutable; threads may share it.
class FieldMap {
public:
    explicit FieldMap(const System& system);

    const System& system() const { return system_; }
    std::size_t states() const { return system_.states(); }

    /// Workspace for one thread.
    struct Workspace {
        std::vector<double> inputs, work;
        std::vector<double> rates;    ///< rates of the states
        std::vector<double> jacobian; ///< of the rates, row by row
        std::vector<double> events, event_gradients;
    };
    Workspace workspace(std::span<const double> parameters) const;

    void evaluate_rates(Workspace& workspace, std::size_t mode, std::span<const double> state) const;
    /// Evaluates rates and their derivatives.
    void evaluate(Workspace& workspace, std::size_t mode, std::span<const double> state) const;
    void evaluate_events(Workspace& workspace, std::size_t mode, std::span<const double> state) const;
    /// Returns whether the field beyond a state is affine up to the largest numbers, so that growth there continues
    /// forever.
    /// @param extents of the states; those that are zero, clocks and drifting states are not varied
    bool is_affine_beyond(Workspace& workspace, std::size_t mode, std::span<const double> state,
                          std::span<const double> extents, std::span<const double> periods) const;
    /// Returns whether motions never cross zero of this state, because its rate vanishes there in all modes, whatever
    /// the other states are, and jumps keep it there: for example a population or a concentration.
    bool keeps_sign(std::size_t state) const { return keeps_sign_[state]; }
    /// Returns whether the rates of a mode are exactly affine in all states except clocks, on which no state acts.
    bool is_linear(std::size_t mode) const { return linear_[mode]; }
    /// Returns whether the state is constant: its rate is zero in all modes, and jumps leave it unchanged.
    bool is_conserved(std::size_t state) const { return conserved_[state]; }
    /// Returns whether no state acts on the rate of this state in this mode.
    bool is_clock(std::size_t mode, std::size_t state) const { return clocks_[mode][state]; }
    /// Returns whether no watched event that changes the motion has its surface between these values of the states: the
    /// function of each has one sign at the corners and at evenly spread points. Cyclic states take all their values.
    bool keeps_sides(Workspace& workspace, std::size_t mode, std::span<const double> least,
                     std::span<const double> greatest, std::span<const double> periods) const;

private:
    System system_;
    std::vector<Function> jacobians_;        ///< for each mode
    std::vector<bool> keeps_sign_;           ///< for each state
    std::vector<bool> conserved_;            ///< for each state
    std::vector<bool> linear_;               ///< for each mode
    std::vector<std::vector<bool>> clocks_;  ///< for each mode and state
    std::vector<std::vector<bool>> changes_; ///< whether each event that a mode watches changes the motion
};

} // namespace graze
