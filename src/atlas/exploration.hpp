#pragma once

#include "atlas/explored_orbits.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace graze {

/// What an atlas has met and does not go on from, and why.
struct LeftOut {
    std::string what, where, why;
};

/// Decides what an atlas computes next.
class Exploration {
public:
    Exploration(const Study& study, const StudyRun& atlas, const ResultFile& file);

    /// The runs that come next, once all runs before them have been computed; none: nothing is left to do. Call it
    /// once.
    std::vector<StudyRun> next();
    /// Whether a limit on the number of branches or curves leaves something out that would come next.
    bool is_limited() const { return limited_; }

    const ExploredOrbits& explored() const { return explored_; }
    const std::vector<LeftOut>& left_out() const { return left_out_; }

private:
    const AtlasRuns& known() const { return explored_.runs(); }
    void leave(const std::string& what, const OrbitMark& mark, const std::string& why);
    std::string text_of(const std::vector<double>& at) const;
    bool was_tried(const std::string& run, const std::string& point, const std::string& onto = "") const;
    StudyRun blank(RunKind kind, const std::string& stem);
    StudyRun following(RunKind kind, const std::string& run, const std::string& point, const std::string& onto);
    StudyRun checking(const FollowedRun& branch, const FollowedOrbit& begin);
    std::vector<AtlasStart> ranges_of_starts() const;
    std::vector<StudyRun> random_motions();
    std::vector<StudyRun> branches_of_motions();
    std::vector<StudyRun> branches_of_points();
    std::vector<StudyRun> curves_of_branches();
    std::vector<StudyRun> curves_of_curves();
    std::vector<StudyRun> confirming_motions();
    std::vector<StudyRun> within_limits(std::vector<StudyRun> runs, RunKind kind, std::size_t most);
    bool is_seen_from_inside(const FollowedRun& branch, const FollowedOrbit& point) const;
    bool may_have_contacts(const FollowedOrbit& point, std::size_t contacts, std::size_t multiple);
    bool may_leave(const FollowedRun& branch, const FollowedOrbit& point);
    bool may_begin(const FollowedRun& curve, const FollowedOrbit& point, PointType type);

    const Study* study_;
    const StudyRun* atlas_;
    ExploredOrbits explored_;
    std::vector<LeftOut> left_out_;
    std::map<std::string, std::size_t> counts_; ///< of names that were given
    bool limited_ = false;
};

} // namespace graze
