#pragma once

#include "graze/branch/chatter_limit.hpp"
#include "graze/branch/orbit_branch.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace graze {

/// Follows an onset of chatter in two parameters, past folds in either: an iterator that can be stopped after any step.
/// Steps are predicted along the secant; the parameter that changes more is fixed, and the other one solved for (W. C.
/// Rheinboldt, "Numerical Analysis of Parametrized Nonlinear Equations", 1986).
class ChatterCurve {
public:
    /// @param first a point of type `chatter` @param settings used are: the parameter that varies and the first free
    /// one, their bounds, the number of steps, the tolerance of orbits @throws InputError as require_chatter_curve
    /// does, and if no onset is found at the first point
    ChatterCurve(const System& system, const SpecialPoint& first, const BranchSettings& settings);
    ~ChatterCurve();
    ChatterCurve(ChatterCurve&&) noexcept;

    /// Returns to the first point and follows the curve with the parameter rising (1) or falling (-1).
    void start(int direction);
    /// Advances to the next point. @param interrupted called before each attempt, returns true to stop; may be empty
    /// @return false at the end of the curve or when interrupted
    bool step(const std::function<bool()>& interrupted = {});

    const ChatterLimit& limit() const;
    std::size_t steps() const; ///< number of steps since the start
    /// Returns the current point as a point of a branch, of type `regular`, without monitors.
    SpecialPoint point() const;
    bool interrupted() const;
    const std::string& ending() const; ///< why the curve has ended, in one line; empty while it continues

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// @throws InputError for settings that do not apply to an onset of chatter, or if the point lies outside their bounds
void require_chatter_curve(const Model& model, const SpecialPoint& first, const BranchSettings& settings);

} // namespace graze
