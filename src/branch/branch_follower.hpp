#pragma once

#include "graze/branch/orbit_branch.hpp"

#include <memory>
#include <string>
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
    virtual const std::vector<SpecialPoint>& found_points() const = 0;
    virtual BranchOutcome how_ended() const = 0;
    virtual const std::string& why_ended() const = 0;
};

std::unique_ptr<BranchFollower> follower_of_orbits(const System& system, const Orbit& candidate,
                                                   const BranchSettings& settings);
std::unique_ptr<BranchFollower> follower_of_equilibria(const System& system, const Orbit& candidate,
                                                       const BranchSettings& settings);

} // namespace graze
