#pragma once

#include "atlas/atlas_runs.hpp"
#include "atlas/orbit_comparison.hpp"

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Where a sampled motion lies.
struct Explanation {
    std::string branch;     ///< empty: on none that is known
    std::size_t number = 0; ///< of a point of the branch next to it
    std::string why;        ///< why its orbit is not known
};

/// All that an atlas has computed so far, with what is the same and with the branches on which motions have settled.
/// It depends on nothing but the results in the file. What is costly to decide is kept, also in the file.
class ExploredOrbits {
public:
    ExploredOrbits(const Study& study, const StudyRun& atlas, const ResultFile& file);

    /// What has been decided, for the file. @see note_of
    std::string decisions() const;
    static std::string note_of(const StudyRun& atlas) { return "atlas " + atlas.name; }

    const AtlasRuns& runs() const { return runs_; }
    const OrbitComparison& comparison() const { return comparison_; }
    bool is_followable(const SampledMotion& sample) const;
    /// Of a sample; null where it is not periodic, or has too many contacts.
    const Explanation* explanation(const SampledMotion& sample) const;
    /// Stable stretches of a branch: from the index of an orbit to that of another.
    static std::vector<std::pair<std::size_t, std::size_t>> stable_stretches(const FollowedRun& branch);
    /// The motion that confirms a stretch; null: none does.
    const SampledMotion* confirmation(const FollowedRun& branch, std::pair<std::size_t, std::size_t> stretch) const;

private:
    using SampleKey = std::pair<std::string, std::size_t>; ///< run and number

    void read_decisions(const ResultFile& file);
    bool is_possible(const SampleKey& key, const Explanation& explanation) const;
    void find_same_branches();
    void find_same_curves();
    void explain();

    const StudyRun* atlas_;
    AtlasRuns runs_;
    OrbitComparison comparison_;
    std::map<std::string, std::string> same_; ///< branches that were compared, with the earlier one that is the same
    std::map<SampleKey, Explanation> explanations_;
    std::map<SampleKey, std::set<std::string>> compared_; ///< branches that a sample is not on
};

} // namespace graze
