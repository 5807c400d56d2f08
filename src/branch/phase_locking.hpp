#pragma once

#include "branch/locked_curve.hpp"
#include "branch/torus_problem.hpp"
#include "graze/branch/torus_branch.hpp"

#include <vector>

namespace graze {

/// Looks for the intervals of the parameter in which tori lock.
class LockingSearch {
public:
    /// @param simulation is used as long as this exists
    LockingSearch(const Simulation& simulation, const BranchSettings& settings, TorusSetting setting)
        : simulation_(simulation), settings_(settings), setting_(std::move(setting)) {}

    void set_parameter_scale(double scale) { setting_.parameter_scale = scale; }
    /// Returns what is known of all resonances from one torus, whose own does not count, to the next.
    std::vector<PhaseLocking> between(const Torus& from, const Torus& to) const;
    LockedCurveFinder finder(const Torus& circle, const Resonance& resonance, double parameter) const;
    /// @param direction in which the branch passes the interval: up (1) or down (-1)
    PhaseLocking described(LockedCurveFinder& finder, const LockedCurve& curve, const Resonance& resonance,
                           int direction) const;
    double parameter_of(const Torus& torus) const { return torus.parameters[setting_.parameter.place()]; }

private:
    PhaseLocking examined(const Torus& circle, const Resonance& resonance, double parameter, double step) const;
    SpecialPoint end_of(LockedCurveFinder& finder, const LockedPoint& fold) const;

    const Simulation& simulation_;
    const BranchSettings& settings_;
    TorusSetting setting_;
};

} // namespace graze
