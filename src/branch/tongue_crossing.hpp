#pragma once

#include "branch/phase_locking.hpp"
#include "branch/torus_problem.hpp"
#include "graze/branch/torus_branch.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace graze {

/// A tongue that a branch of tori has entered, and the torus on its other side.
struct CrossedTongue {
    PhaseLocking locking;
    /// The equations of the torus beyond, and its unknowns; null where none was found: `problem` says why.
    std::shared_ptr<TorusProblem> equations;
    ContinuationPoint beyond;
    std::string problem;
};

/// A torus near a resonance, as far as the branch tells.
using TorusForecast = std::function<std::optional<Torus>(const Resonance&)>;

/// Finds out whether the branch of tori from a torus ends in a tongue, and begins anew beyond.
class TongueCrossing {
public:
    TongueCrossing(const LockingSearch& search, const BranchSettings& settings, const TorusResolution& resolution)
        : search_(search), settings_(settings), resolution_(resolution) {}

    /// @param from last torus before @param equations of which it is a solution
    /// @param turning sign of the change of the rotation number along the branch; 0: unknown
    /// @param direction of the change of the parameter; 0: unknown
    std::optional<CrossedTongue> cross(const Torus& from, const TorusProblem& equations, double turning,
                                       double direction, const TorusForecast& forecast) const;

private:
    std::optional<CrossedTongue> ahead_of(const Torus& from, const TorusProblem& equations, double direction,
                                          const Resonance& resonance, const Torus& circle) const;
    std::vector<Resonance> ahead(double rotation, double turning) const;
    void leave(const Torus& from, const TorusProblem& equations, const LockedCurve& curve, CrossedTongue& tongue) const;
    bool solve(CrossedTongue& tongue, const LockedCurve& curve, double parameter, double across) const;

    const LockingSearch& search_;
    const BranchSettings& settings_;
    const TorusResolution& resolution_;
};

} // namespace graze
