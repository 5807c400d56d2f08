#pragma once

#include "branch/branch_state.hpp"
#include "branch/point_kind.hpp"

#include <limits>
#include <optional>

namespace graze {

/// The end of a branch of periodic orbits whose period grows without bound, because they approach a homoclinic orbit.
class HomoclinicEnd {
public:
    /// True where a homoclinic orbit is looked for: on branches, not curves or families, whose orbits become longer.
    static bool is_sought(const BranchSettings& settings, const BranchPoint& here);
    /// Returns the homoclinic orbit that lies ahead of such a point; empty if there is none, or it is still far. The
    /// equations of the branch must be evaluated at the point.
    std::optional<SpecialPoint> find(BranchState& state, const BranchPoint& here);

private:
    /// Distance from the saddle at which it was sought last.
    double sought_ = std::numeric_limits<double>::infinity();
};

/// The condition that holds along a curve of homoclinic orbits: the distance from the saddle at which they begin.
PointRule::Condition condition_of_homoclinic;

/// Returns a homoclinic orbit of a curve at distances from its saddle that suit the present eigenvalues, with one of
/// the parameters slightly changed. @return empty where none is found @param tangent of the curve
std::optional<Orbit> at_suitable_distances(BranchState& state, const Orbit& orbit, const OrbitDirection& tangent);

/// @throws InputError unless an orbit is homoclinic exactly if the settings keep it so
void require_kept_homoclinic(const Orbit& candidate, const BranchSettings& settings);

} // namespace graze
