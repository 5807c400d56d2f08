#pragma once

#include "branch/branch_state.hpp"
#include "branch/hopf_point.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace graze {

/// Finds the equilibrium to which the orbits of a branch shrink, so that the branch ends there. Where the section of
/// the orbits passes through the equilibrium, the solutions of the equations continue through it, with the same orbits
/// half a period later, and it is located from both sides. Otherwise the section or cut is touched before; then the
/// Hopf point is computed from the equations of the equilibrium, and the orbits start where a cut contains it.
class ShrinkingOrbit {
public:
    explicit ShrinkingOrbit(BranchState& state) : state_(&state) {}

    /// Makes a step. If it leads through an equilibrium, that is located, and the step is repeated to end just before
    /// it, so that special points on the way are separated from the singularity.
    /// @param make makes a step, returns false when it fails; @param from point of the branch from which it is made
    /// @param rates at sections there
    bool step(const std::function<bool()>& make, const BranchPoint& from, const std::vector<double>& rates);
    /// The equilibrium in which the branch ends, if it lies ahead.
    const std::optional<SpecialPoint>& end() const { return end_; }
    /// True when a Hopf point may lie within the last step, which is then to be repeated after `turn`.
    bool must_turn() const { return hopf_ && !end_; }
    /// Moves the start of the orbit to where it is farthest from the Hopf point ahead, and sets the length of the next
    /// step accordingly; at most once per point. @return false where that is impossible
    bool turn(const BranchPoint& from);
    /// After a step towards a Hopf point: if the orbits shrink to it, the branch ends there with the next step.
    void update(const Orbit& before);

private:
    bool is_located(const HopfPoint& hopf) const;

    BranchState* state_;
    std::optional<SpecialPoint> end_;
    std::optional<HopfPoint> hopf_;       ///< Hopf point that may lie within the last attempted step
    std::optional<HopfPoint> approached_; ///< Hopf point that the next step approaches
    std::optional<double> tried_;         ///< arclength at which `turn` was tried last
};

} // namespace graze
