#pragma once

#include "graze/branch/continuation.hpp"
#include "graze/branch/monitor.hpp"
#include "graze/branch/special_point.hpp"
#include "graze/orbit/solve.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Where a branch ends in a further parameter that is free.
struct FreeBounds {
    ParameterId parameter;
    std::optional<double> least, greatest;
};

struct BranchSettings {
    ParameterId parameter;    ///< that varies
    int direction = 1;        ///< in which it goes at first: up (1) or down (-1)
    std::size_t steps = 1000; ///< at most
    /// Steps of integration for one point, beyond which the branch ends: hundreds or thousands are usual.
    std::size_t work = 1'000'000;
    std::optional<double> least, greatest; ///< of the parameter, where the branch ends
    ContinuationOptions continuation;
    OrbitOptions orbit;
    std::vector<Monitor> monitors;
    /// A point whose own condition is held all along, so that the branch is the curve of such points in one parameter
    /// more: of the folds, flips or grazings of what was found as one. Its kind says whether it can be kept.
    std::optional<SpecialPoint> kept;
    /// What is held besides the touch that is kept, so that the branch is a curve of points of codimension two in three
    /// parameters: `sensitivity`, the boundary between touches beyond which an attractor may persist and such beyond
    /// which it is lost.
    std::optional<PointType> kept_too;
    /// Further parameters that vary: one for each monitor that is fixed, one for the point that is kept, and one for
    /// what is held besides.
    std::vector<ParameterId> free;
    std::vector<FreeBounds> free_bounds; ///< of some of those, or of all
    std::vector<PointType> stop_at;      ///< types at which the branch ends
    bool stop_when_unphysical = true;    ///< ends where orbits cease to be admissible
    /// Goes on with another signature where events change their order, a segment vanishes or a guard chooses another
    /// mode, as the model's motion does. What is grazed ends a branch in any case.
    bool reorder = true;
    /// @throws InputError naming what is out of range
    void validate(const Model& model) const;
    /// The same of what one orbit needs alone, of a model that may have no parameters: `orbit` and `monitors`.
    void validate_orbit(const Model& model) const;
};

struct BranchPoint {
    OrbitSolution solution;
    double parameter = 0, arclength = 0;
    bool stable = false; ///< all multipliers within the unit circle
    std::size_t step = 0;
    std::size_t iterations = 0;
    OrbitDirection tangent;       ///< of the branch
    std::vector<double> monitors; ///< values of those asked for
};

enum class BranchOutcome {
    steps,          ///< all that were allowed have been made
    bound,          ///< of a parameter or monitor is reached
    stopped,        ///< at a point of a type that was to stop it
    unphysical,     ///< beyond the last special point orbits are not admissible
    closed,         ///< it has come back to its first point
    returned,       ///< it has come back to a branch of more regular orbits: of half the period, or symmetric
    shrunk,         ///< its orbits shrink to an equilibrium: it ends there
    no_convergence, ///< steps have become too small
    undefined,      ///< the model is not defined beyond
    too_long,       ///< orbits take more and more steps of integration, as where a period grows without end
    no_start,       ///< no orbit was found to start from
};
std::string_view name_of(BranchOutcome outcome);
/// Whether the branch then ends at a special point, if there is one with its last point.
bool ends_at_point(BranchOutcome outcome);

/// Follows a branch of periodic orbits of one signature in one parameter, and finds what happens on the way: an
/// iterator that one can stop and resume after any step.
class OrbitBranch {
public:
    /// @throws InputError when candidate or settings do not fit the model
    OrbitBranch(const System& system, const Orbit& candidate, const BranchSettings& settings);
    ~OrbitBranch();
    OrbitBranch(OrbitBranch&&) noexcept;

    /// Finds the first point. @return false when there is none: outcome() and detail() say why
    bool start();
    /// The same at a solution, onto the branch through it that has this direction, such as SpecialPoint::tangent.
    /// @param distance of the first point, in units of the unknowns' sizes; 0 for the solution itself
    /// @throws InputError when the direction does not fit the orbit
    bool start_along(const OrbitDirection& direction, double distance);

    /// @return false when the branch has ended. If a special point has ended it, its last point is that one.
    bool step();
    const BranchPoint& point() const;
    /// What was found between the last point and the one before, in the order of the branch.
    const std::vector<SpecialPoint>& found() const;
    BranchOutcome outcome() const;
    const std::string& detail() const;

private:
    class Follower;
    std::unique_ptr<Follower> follower_;
    bool begun_ = false;
};

/// Whether it has ended in the last point found, rather than after it.
bool ends_in_found(const OrbitBranch& branch);

struct Branch {
    std::vector<BranchPoint> points;
    std::vector<SpecialPoint> special;
    BranchOutcome outcome = BranchOutcome::no_start;
    std::string detail;
};

/// Follows a whole branch. @param visit called after each point with it and what was found just before; returning false
///        ends the branch
using BranchVisitor = std::function<bool(const BranchPoint&, const std::vector<SpecialPoint>&)>;
Branch follow_branch(const System& system, const Orbit& candidate, const BranchSettings& settings,
                     const BranchVisitor& visit = {});

} // namespace graze
