#pragma once

#include "graze/branch/chatter_limit.hpp"
#include "graze/branch/orbit_branch.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace graze {

/// Follows an onset of chatter in two parameters, past turns in either: an iterator that one can stop after any step.
/// Steps go along the secant; the parameter that changes more is held, and the other one solved for (W. C. Rheinboldt,
/// "Numerical Analysis of Parametrized Nonlinear Equations", 1986).
class ChatterCurve {
public:
    /// @param first of type `chatter`
    /// @param settings the parameter that varies and the first free one, their bounds, the number of steps, and the
    ///        tolerance of orbits
    /// @throws InputError as require_chatter_curve does, and where no onset is found at the first point
    ChatterCurve(const System& system, const SpecialPoint& first, const BranchSettings& settings);
    ~ChatterCurve();
    ChatterCurve(ChatterCurve&&) noexcept;

    /// Back to the first point, to go on from there with the parameter rising (1) or falling (-1).
    void start(int direction);
    /// On to the next point. @param interrupted asked before each attempt; may be empty
    /// @return false at the end of the curve, and when interrupted
    bool step(const std::function<bool()>& interrupted = {});

    const ChatterLimit& limit() const;
    std::size_t steps() const; ///< made since the start
    /// The same as a point of a branch, of type `regular`, without its monitors.
    SpecialPoint point() const;
    bool interrupted() const;
    const std::string& ending() const; ///< why the curve does not go on, in one line; empty while it does

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// @throws InputError for settings that have no meaning for an onset of chatter, and where it lies beyond their bounds
void require_chatter_curve(const Model& model, const SpecialPoint& first, const BranchSettings& settings);

} // namespace graze
