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
#include <string_view>
#include <vector>

namespace graze {

/// Bounds of an additional free parameter, at which a branch ends.
struct FreeBounds {
    ParameterId parameter;
    std::optional<double> least, greatest;
};

/// What varies along a family of orbits at the same parameters: a conserved quantity of the model, or the period.
struct FamilyCoordinate {
    std::string conserved; ///< name of the quantity; empty: the period
    /// Returns the name of the coordinate: that of the quantity, or "period".
    const std::string& name() const;
    bool operator==(const FamilyCoordinate&) const = default;
};

/// What a branch follows, and where it ends.
struct BranchSettings {
    ParameterId parameter; ///< the parameter that varies along the branch
    /// Follow the family to which the candidate belongs, at the same parameters, instead of `parameter`, which is then
    /// unused except on curves, whose two coordinates they are. `direction`, `least` and `greatest` are those of this
    /// coordinate (of curves, those of `parameter`; the coordinate then has `family_least` and `family_greatest`).
    std::optional<FamilyCoordinate> family;
    std::optional<double> family_least, family_greatest; ///< of curves: bounds of the family's coordinate
    std::size_t unfolded = 0; ///< set by graze: how many of the model's last parameters unfold its families
    int direction = 1;        ///< initial direction of the parameter: up (1) or down (-1)
    std::size_t steps = 1000; ///< largest number of steps
    /// Largest number of integration steps per point, beyond which the branch ends; hundreds or thousands are usual.
    /// Raise it for orbits of very long period.
    std::size_t work = 1'000'000;
    std::optional<double> least, greatest; ///< bounds of the parameter, at which the branch ends; empty: none
    ContinuationOptions continuation;      ///< step lengths and accuracy
    OrbitOptions orbit;                    ///< tolerance of the integration
    std::vector<Monitor> monitors;         ///< quantities that are recorded, held or bounded
    /// A special point whose condition is held, so that the branch is the curve of such points (folds, flips, grazings)
    /// with one more free parameter. PointKind::may_be_kept says which types allow it.
    std::optional<SpecialPoint> kept;
    /// A second condition besides a kept touch, for a curve of codimension two in three parameters. Only `sensitivity`
    /// is allowed: the boundary between touches at which an attractor may persist and touches at which it is lost.
    std::optional<PointType> kept_too;
    /// Additional free parameters: one for each fixed monitor, one for the kept point, and one for the second
    /// condition.
    std::vector<ParameterId> free;
    std::vector<FreeBounds> free_bounds; ///< bounds of some or all additional parameters
    std::vector<PointType> stop_at;      ///< types of points at which the branch ends
    bool stop_when_unphysical = true;    ///< end the branch where orbits cease to be admissible
    /// Continue with the new signature where events change their order, a segment vanishes or a guard chooses another
    /// mode. A grazing ends the branch in any case.
    bool reorder = true;
    /// Number of monitors that are held at their values.
    std::size_t fixed_monitors() const;
    /// Number of conditions that are held: fixed monitors, the kept point, and the second condition besides it.
    std::size_t conditions() const { return fixed_monitors() + (kept ? 1U : 0U) + (kept_too ? 1U : 0U); }
    /// @throws InputError naming the setting that is out of range
    void validate(const Model& model) const;
    /// Validates only the settings that a single orbit needs: `orbit` and `monitors`. The model may have no parameters.
    void validate_orbit(const Model& model) const;
};

/// Returns the name of what varies along a branch: the coordinate of its family, or its parameter. Empty if the model
/// has no parameters.
std::string coordinate_name(const BranchSettings& settings, const Model& model);

/// A computed point of a branch.
struct BranchPoint {
    OrbitSolution solution;
    double parameter = 0; ///< value of what varies along the branch
    double arclength = 0;
    bool stable = false;          ///< all multipliers within the unit circle
    std::size_t step = 0;         ///< number of the step
    std::size_t iterations = 0;   ///< iterations of Newton's method
    OrbitDirection tangent;       ///< tangent of the branch
    std::vector<double> monitors; ///< values of the monitors
};

/// Why a branch has ended.
enum class BranchOutcome {
    steps,          ///< the largest number of steps has been made
    bound,          ///< a bound of a parameter or monitor has been reached
    stopped,        ///< the branch has reached a point of a type in `stop_at`
    unphysical,     ///< orbits beyond the last special point are not admissible
    closed,         ///< the branch has returned to its first point
    returned,       ///< the branch has met a branch of simpler orbits: of half the period, or symmetric
    shrunk,         ///< the orbits shrink to an equilibrium
    homoclinic,     ///< the period grows without bound: the orbits approach a homoclinic one
    no_convergence, ///< the step has become too small
    undefined,      ///< the model is not defined beyond the last point
    too_long,       ///< orbits take too many integration steps, as where the period diverges
    no_start,       ///< no first orbit was found
};
std::string_view name_of(BranchOutcome outcome);
/// True when a branch with this outcome ends in a special point, if one was found with its last point.
bool ends_at_point(BranchOutcome outcome);

class BranchFollower;

/// Follows a branch of periodic orbits of one signature, or of equilibria, in one parameter and locates its special
/// points: an iterator that can be stopped and resumed after any step.
class OrbitBranch {
public:
    /// @throws InputError when candidate or settings do not fit the model
    OrbitBranch(const System& system, const Orbit& candidate, const BranchSettings& settings);
    ~OrbitBranch();
    OrbitBranch(OrbitBranch&&) noexcept;

    /// Computes the first point. @return false when it is not found; outcome() and detail() say why
    bool start();
    /// Starts from the candidate, a solution, along the branch through it that has this direction, such as
    /// SpecialPoint::tangent.
    /// @param distance of the first point, in scaled unknowns; 0 for the solution itself
    /// @throws InputError when the direction does not fit the orbit
    bool start_along(const OrbitDirection& direction, double distance);

    /// @return false when the branch has ended. If a special point ended it, that is its last point.
    bool step();
    const BranchPoint& point() const;
    /// The special points between the previous point and the last one, in the order of the branch.
    const std::vector<SpecialPoint>& found() const;
    BranchOutcome outcome() const;
    const std::string& detail() const;

private:
    std::unique_ptr<BranchFollower> follower_;
    bool begun_ = false;
};

/// True when the branch has ended in the last special point found, not after it.
bool ends_in_found(const OrbitBranch& branch);

struct Branch {
    std::vector<BranchPoint> points;
    std::vector<SpecialPoint> special;
    BranchOutcome outcome = BranchOutcome::no_start;
    std::string detail;
};

/// Called after each point with the special points found just before it; returns false to end the branch.
using BranchVisitor = std::function<bool(const BranchPoint&, const std::vector<SpecialPoint>&)>;
/// Follows a whole branch.
Branch follow_branch(const System& system, const Orbit& candidate, const BranchSettings& settings,
                     const BranchVisitor& visit = {});

} // namespace graze
