#pragma once

#include "graze/branch/orbit_branch.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// What makes the points of an OrbitBranch, whose functions have the same meaning.
class BranchFollower {
public:
    virtual ~BranchFollower() = default;
    virtual bool start() = 0;
    virtual bool start_along(const OrbitDirection& direction, double distance) = 0;
    virtual bool step() = 0;
    virtual const BranchPoint& point() const = 0;
    const std::vector<SpecialPoint>& found_points() const { return found_; }
    BranchOutcome how_ended() const { return outcome_; }
    const std::string& why_ended() const { return detail_; }

protected:
    /// Ends the branch. @return false, for functions that tell whether there is a point
    bool end(BranchOutcome how, std::string why) {
        finish(how, std::move(why));
        return false;
    }
    void finish(BranchOutcome how, std::string why) {
        ended_ = true;
        outcome_ = how;
        detail_ = std::move(why);
    }
    /// Drops the special points found after number i, and moves the last point of the branch to that one.
    void end_at(std::size_t i, BranchPoint& last);

    std::vector<SpecialPoint> found_; ///< between the previous point and the last one
    bool ended_ = true;

private:
    BranchOutcome outcome_ = BranchOutcome::no_start;
    std::string detail_;
};

std::unique_ptr<BranchFollower> follower_of_orbits(const System& system, const Orbit& candidate,
                                                   const BranchSettings& settings);
/// Returns the follower of a family of orbits; null where the settings mean an ordinary branch: see Family::of.
std::unique_ptr<BranchFollower> follower_of_family(const System& system, const Orbit& candidate,
                                                   const BranchSettings& settings);
std::unique_ptr<BranchFollower> follower_of_equilibria(const System& system, const Orbit& candidate,
                                                       const BranchSettings& settings);

} // namespace graze
