#include "graze/branch/orbit_branch.hpp"

#include "branch/branch_follower.hpp"
#include "branch/touch_curve_start.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

namespace graze {

OrbitBranch::OrbitBranch(const System& system, const Orbit& candidate, const BranchSettings& settings) {
    if ((follower_ = follower_of_family(system, candidate, settings)))
        return;
    if (is_rest(candidate.signature)) {
        follower_ = follower_of_equilibria(system, candidate, settings);
        return;
    }
    const CurveStart begun = start_of_curve(system, candidate, settings);
    follower_ = follower_of_orbits(system, begun.orbit, begun.settings);
}
OrbitBranch::~OrbitBranch() = default;
OrbitBranch::OrbitBranch(OrbitBranch&&) noexcept = default;

bool OrbitBranch::start() {
    begun_ = true;
    return follower_->start();
}
bool OrbitBranch::start_along(const OrbitDirection& direction, double distance) {
    for (const std::vector<double>& start : direction.starts)
        require_finite(start, "a number of the direction");
    require_finite(direction.durations, "a number of the direction");
    require_finite(direction.parameters, "a number of the direction");
    require_finite(distance, "the distance");
    begun_ = true;
    return follower_->start_along(direction, distance);
}
bool OrbitBranch::step() {
    if (!begun_)
        throw OrderError("a branch has no point to step from before it is started");
    return follower_->step();
}
const BranchPoint& OrbitBranch::point() const {
    if (!begun_)
        throw OrderError("a branch has no point before it is started");
    return follower_->point();
}
const std::vector<SpecialPoint>& OrbitBranch::found() const {
    return follower_->found_points();
}
BranchOutcome OrbitBranch::outcome() const {
    return follower_->how_ended();
}
const std::string& OrbitBranch::detail() const {
    return follower_->why_ended();
}

bool ends_in_found(const OrbitBranch& branch) {
    return ends_at_point(branch.outcome()) && !branch.found().empty() &&
           branch.found().back().arclength == branch.point().arclength;
}

Branch follow_branch(const System& system, const Orbit& candidate, const BranchSettings& settings,
                     const BranchVisitor& visit) {
    OrbitBranch follower(system, candidate, settings);
    Branch branch;
    bool going = follower.start();
    while (going) {
        branch.points.push_back(follower.point());
        branch.special.insert(branch.special.end(), follower.found().begin(), follower.found().end());
        if (visit && !visit(follower.point(), follower.found())) {
            branch.outcome = BranchOutcome::stopped;
            return branch;
        }
        going = follower.step();
    }
    branch.outcome = follower.outcome();
    branch.detail = follower.detail();
    return branch;
}

} // namespace graze
