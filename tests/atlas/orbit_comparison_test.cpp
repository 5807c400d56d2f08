// Orbits of motions and of branches at exactly the same parameters.

#include "atlas/orbit_comparison.hpp"

#include "atlas/truth_atlas.hpp"

#include <cmath>

namespace graze::orbit_comparison_test {

using namespace graze::testing;

TEST(OrbitComparison, FindsTheOrbitsOfMotionsAndTheirPlacesOnBranches) {
    AtlasResults results(flips_study("multiple = 2\n"));
    results.run();
    const StudyRun& atlas = *results.study.find_run("map");
    const AtlasRuns runs = read_atlas(results.study, atlas, results.file);
    const OrbitComparison comparison(results.study, atlas, results.file);
    std::size_t compared = 0;
    for (const SampledMotion& sample : runs.samples) {
        if (sample.result.label != Label::periodic || sample.result.period > 2 || compared > 20)
            continue;
        std::string why;
        const auto mark = comparison.mark_of(sample, why);
        ASSERT_TRUE(mark) << why;
        EXPECT_EQ(mark->at[0], sample.value);
        EXPECT_NEAR(mark->period, static_cast<double>(sample.result.period), 1e-9);
        if (sample.result.period == 1) { // X (1 - a + X^2) = b, and x goes from X to X + 1
            const double X = mark->extents[1], a = mark->at[0], b = mark->at[1];
            EXPECT_NEAR(X * (1 - a + X * X), b, 1e-9);
            EXPECT_NEAR(mark->extents[0], X + 1, 1e-9);
        }
        std::size_t places = 0;
        for (const FollowedRun& branch : runs.branches)
            places += branch.row == sample.row && comparison.place_on(branch, *mark, runs.scales, true) ? 1 : 0;
        EXPECT_EQ(places, 1U) << sample.run->name << ' ' << sample.number;
        OrbitMark other = *mark;
        other.extents[0] += 0.01;
        for (const FollowedRun& branch : runs.branches)
            EXPECT_FALSE(comparison.place_on(branch, other, runs.scales, true));
        ++compared;
    }
    EXPECT_GT(compared, 10U);
}

TEST(OrbitComparison, SaysWhyAMotionHasNoOrbit) {
    AtlasResults results(flips_study("multiple = 2\n"));
    run_study(results.study, results.file, {});
    const StudyRun& atlas = *results.study.find_run("map");
    SampledMotion sample;
    sample.run = &atlas;
    sample.number = 12345;
    std::string why;
    EXPECT_FALSE(OrbitComparison(results.study, atlas, results.file).mark_of(sample, why));
    EXPECT_EQ(why, "the motion is not in the file");
}

} // namespace graze::orbit_comparison_test
