#pragma once

#include "atlas/atlas_runs.hpp"
#include "graze/branch/monitor.hpp"
#include "graze/flow/system.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace graze {

/// The monitors of orbits by which an atlas tells them apart: see OrbitMark.
std::vector<Monitor> mark_monitors(const Model& model);

/// Solves orbits at exactly the same parameters, so that it is certain whether they are one orbit. Not to be used by
/// several threads at once.
class OrbitComparison {
public:
    OrbitComparison(const Study& study, const StudyRun& atlas, const ResultFile& file);

    /// The orbit of a motion that has settled on a periodic one. @return none where no orbit is found, with the reason
    /// in `why`
    std::optional<OrbitMark> mark_of(const SampledMotion& sample, std::string& why) const;

    /// Looks for an orbit, or one that it repeats, on a branch in one parameter, between the points that it has.
    /// @param stable whether the orbit of the branch must be stable, or at a bifurcation
    /// @return the number of the point before it; none: it does not lie on the branch
    std::optional<std::size_t> place_on(const FollowedRun& branch, const OrbitMark& mark, const MarkScales& scales,
                                        bool stable) const;

    /// The types of the curves that pass through a point of a curve, or begin there.
    std::vector<PointType> curves_through(const FollowedRun& curve, const FollowedOrbit& point) const;

private:
    std::optional<OrbitMark> mark_of(const OrbitSolution& solution) const;
    std::optional<Orbit> between(const FollowedRun& branch, std::size_t index, double value) const;

    const StudyRun* atlas_;
    const ResultFile* file_;
    Model base_; ///< with the parameters that all motions have in common
    std::unique_ptr<System> system_;
    std::vector<Monitor> monitors_;
};

} // namespace graze
