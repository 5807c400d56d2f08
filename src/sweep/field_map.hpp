#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Up to which states are looked at where a motion may grow on and on: products of two of them are numbers still.
inline constexpr double end_of_growth = 1e150;

/// Vector fields of all modes with their derivatives by the states. Immutable; threads may share it.
class FieldMap {
public:
    explicit FieldMap(const System& system);

    const System& system() const { return system_; }
    std::size_t states() const { return system_.states(); }

    /// Numbers that every use needs, for one thread.
    struct Workspace {
        std::vector<double> inputs, work;
        std::vector<double> rates;    ///< of the states
        std::vector<double> jacobian; ///< of the rates, row by row
        std::vector<double> events, event_gradients;
    };
    Workspace workspace(std::span<const double> parameters) const;

    void evaluate_rates(Workspace& workspace, std::size_t mode, std::span<const double> state) const;
    /// Rates and their derivatives.
    void evaluate(Workspace& workspace, std::size_t mode, std::span<const double> state) const;
    void evaluate_events(Workspace& workspace, std::size_t mode, std::span<const double> state) const;
    /// Whether the field beyond a state is affine as far as numbers go, so that what grows there does so for ever.
    /// @param extents of the states; those that are zero, clocks and drifting states are left as they are
    bool is_affine_beyond(Workspace& workspace, std::size_t mode, std::span<const double> state,
                          std::span<const double> extents, std::span<const double> periods) const;
    /// Whether motions never cross zero of this state, for its rate vanishes there whatever the others are, in all
    /// modes, and jumps leave it there: a number of animals, a concentration.
    bool keeps_sign(std::size_t state) const { return keeps_sign_[state]; }
    /// Whether the rates of a mode are affine in all states but clocks, on whose rates nothing acts: exactly so.
    bool is_linear(std::size_t mode) const { return linear_[mode]; }
    /// Whether nothing ever changes the state: its rate is zero in all modes, and jumps leave it.
    bool is_conserved(std::size_t state) const { return conserved_[state]; }
    /// Whether nothing acts on the rate of the state in this mode.
    bool is_clock(std::size_t mode, std::size_t state) const { return clocks_[mode][state]; }
    /// Whether no watched event that changes the motion has its surface between these values of the states: each has
    /// one sign there, as far as corners and places spread evenly tell. Cyclic states take all their values.
    bool keeps_sides(Workspace& workspace, std::size_t mode, std::span<const double> least,
                     std::span<const double> greatest, std::span<const double> periods) const;

private:
    System system_;
    std::vector<Function> jacobians_;        ///< of each mode
    std::vector<bool> keeps_sign_;           ///< of each state
    std::vector<bool> conserved_;            ///< of each state
    std::vector<bool> linear_;               ///< of each mode
    std::vector<std::vector<bool>> clocks_;  ///< of each mode and state
    std::vector<std::vector<bool>> changes_; ///< whether each event that a mode watches changes the motion
};

} // namespace graze
