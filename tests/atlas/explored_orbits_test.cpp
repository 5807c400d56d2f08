// What of an atlas is the same, and on which branches motions have settled.

#include "atlas/explored_orbits.hpp"

#include "atlas/truth_atlas.hpp"

namespace graze::explored_orbits_test {

using namespace graze::testing;

TEST(ExploredOrbits, AreDecidedAlikeWithAndWithoutWhatTheFileKeeps) {
    AtlasResults results(flips_study("multiple = 2\n"));
    results.run();
    const StudyRun& atlas = *results.study.find_run("map");
    const ExploredOrbits kept(results.study, atlas, results.file);
    EXPECT_EQ(results.file.note(ExploredOrbits::note_of(atlas)), kept.decisions());
    results.file.set_note(ExploredOrbits::note_of(atlas), "");
    const ExploredOrbits anew(results.study, atlas, results.file);
    EXPECT_EQ(anew.decisions(), kept.decisions());
    std::size_t explained = 0;
    for (const SampledMotion& sample : anew.runs().samples)
        if (const Explanation* one = anew.explanation(sample); one && !one->branch.empty()) {
            ++explained;
            const FollowedRun& branch = *anew.runs().find(one->branch);
            EXPECT_EQ(branch.row, sample.row);
            EXPECT_EQ(branch.multiple, sample.result.period);
        }
    EXPECT_GT(explained, 10U);
}

TEST(ExploredOrbits, DoNotBelieveWhatIsImpossible) {
    AtlasResults results(flips_study("multiple = 2\n"));
    results.run();
    const StudyRun& atlas = *results.study.find_run("map");
    const ExploredOrbits before(results.study, atlas, results.file);
    std::string lines;
    for (const FollowedRun& one : before.runs().branches)
        lines += "same " + one.name() + " " + one.name() + "\n";
    for (const SampledMotion& one : before.runs().samples) // a branch of another row, and a point far away
        lines += fmt::format("on {0} {1} map.branch{2} 3\non {0} {1} map.branch1 9999\n", one.run->name, one.number,
                             one.row < 2 ? 4 : 1);
    results.file.set_note(ExploredOrbits::note_of(atlas), lines);
    EXPECT_EQ(ExploredOrbits(results.study, atlas, results.file).decisions(), before.decisions());
}

TEST(ExploredOrbits, StableStretchesEndAtUnstableOrbits) {
    FollowedRun branch;
    const auto add = [&](const char* part, bool stable, const char* label = "") {
        FollowedOrbit& one = branch.orbits.emplace_back();
        one.part = part;
        one.label = label;
        one.stable = stable;
    };
    add("up", true);
    add("up", false, "PD1"); // does not count
    add("up", true);
    add("up", false);
    add("up", true);
    add("down", true);
    using Stretches = std::vector<std::pair<std::size_t, std::size_t>>;
    EXPECT_EQ(ExploredOrbits::stable_stretches(branch), (Stretches{{0, 2}, {4, 5}}));
}

} // namespace graze::explored_orbits_test
