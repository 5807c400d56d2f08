#pragma once

#include "branch/locked_orbit_problem.hpp"
#include "graze/branch/continuation.hpp"
#include "graze/branch/torus.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// An orbit of the closed curve of orbits to which the motion on a torus locks.
struct LockedPoint {
    std::vector<double> u, tangent;
    double along = 0; ///< length along the curve
    double parameter = 0;
    LockedOrbitProblem::Drift drift;
};

/// The orbits of a resonance, from one along the circle up to the same orbit from a later return on.
struct LockedCurve {
    std::vector<LockedPoint> points;
    std::vector<LockedPoint> extremes; ///< orbits at which the parameter is extreme: their folds
    bool closed = false;               ///< false: the curve could not be followed all around; `problem` says why
    std::size_t shift = 0;             ///< number of returns after which the last orbit is the first
    std::string problem;
    double least() const;
    double greatest() const;
};

/// Looks for the orbits of a resonance beside tori whose rotation numbers are near it.
class LockedCurveFinder {
public:
    /// @param circle of a torus near the resonance @param parameter at which orbits are expected
    LockedCurveFinder(const TorusSetting& setting, const Torus& circle, const Resonance& resonance, double parameter,
                      const ContinuationOptions& options, double tolerance);

    /// How the parameter varies along the circle, from few of its angles.
    struct Spread {
        double least = 0, greatest = 0;
        /// Error of the parameter at one of them, by round-off and by the tolerance of the integration.
        double round_off = 0, error = 0;
        std::optional<LockedPoint> orbit; ///< one of them
    };
    /// @return none where no orbit was found at one of the angles
    std::optional<Spread> spread();
    /// Follows the whole curve, from an orbit near an angle at which one is found.
    /// @param farthest distance of parameters from that of the constructor at which it is given up
    LockedCurve follow(double farthest);
    LockedOrbitProblem& problem() { return *problem_; }

private:
    bool start(Continuation& continuation, double turns);
    bool start_across(Continuation& continuation, double turns);
    bool start_beside(Continuation& continuation, const std::vector<double>& u, const std::vector<double>& direction);
    LockedCurve followed(double farthest);
    std::vector<double> angles_by_slowness() const;
    LockedPoint described(const ContinuationPoint& at);
    void locate_extreme(Continuation& continuation, LockedCurve& curve);
    bool closes(Continuation& continuation, LockedCurve& curve);

    Torus circle_;
    Resonance resonance_;
    double parameter_, tolerance_;
    std::shared_ptr<LockedOrbitProblem> problem_;
    double length_ = 0;       ///< of the curve, as far as the circle tells
    double start_offset_ = 0; ///< of the last orbit that was started from, from the circle
    ContinuationOptions options_;
};

} // namespace graze
