// What is told of an atlas.

#include "atlas/truth_atlas.hpp"
#include "base/message_of.hpp"

#include <gmock/gmock.h>

namespace graze::atlas_findings_test {

using namespace graze::testing;
using ::testing::HasSubstr;

TEST(AtlasFindings, AreOfRunsOfKindAtlasOnly) {
    const AtlasResults results(flips_study("multiple = 2\n"));
    EXPECT_THAT(message_of([&] { atlas_findings(results.study, "other", results.file); }),
                HasSubstr("there is no atlas 'other'"));
}

TEST(AtlasFindings, AreNotFinishedBeforeAllIsComputed) {
    AtlasResults results(flips_study("multiple = 2\n"));
    EXPECT_FALSE(results.findings().finished);
    run_study(results.study, results.file, {});
    EXPECT_FALSE(results.findings().finished);
    results.run();
    EXPECT_TRUE(results.findings().finished);
    StudyRun more = *results.study.find_run("map.branch1");
    more.name = "map.branch99"; // asked for, and not computed yet
    results.study.runs.push_back(std::move(more));
    EXPECT_FALSE(results.findings().finished);
}

TEST(AtlasFindings, CountEachPointOnceWithAllThatMeetsThere) {
    AtlasResults results(flips_study("multiple = 2\n"));
    results.run();
    const AtlasFindings found = results.findings();
    std::size_t degenerate = 0;
    for (std::size_t i = 0; i < found.points.size(); ++i) {
        const AtlasPoint& one = found.points[i];
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_NE(one.name, found.points[k].name);
        EXPECT_FALSE(one.found.empty());
        if (one.types != std::vector{PointType::generalised})
            continue;
        // The curves of flips and of folds of the doubled orbits, of which the simpler orbit tells.
        ++degenerate;
        EXPECT_EQ(one.curves.size(), 2U);
        EXPECT_EQ(one.multiple, 1U);
        EXPECT_NEAR(one.period, 1, 1e-9);
        EXPECT_FALSE(one.on_row);
    }
    EXPECT_EQ(degenerate, 2U);
    // Each flip of a row lies on the curve of flips, which counts it.
    std::size_t crossings = 0, flips = 0;
    for (const AtlasCurve& one : found.curves)
        crossings += one.type == PointType::flip ? one.crossings : 0;
    for (const AtlasPoint& one : found.points)
        flips += one.on_row && one.types == std::vector{PointType::flip} ? 1U : 0U;
    EXPECT_EQ(crossings, flips);
}

TEST(AtlasFindings, TellAttractorsAndClaimsInWords) {
    AtlasMotion motion;
    motion.label = Label::chaotic;
    EXPECT_EQ(motion.attractor(), "chaotic");
    motion.label = Label::periodic;
    motion.period = 2;
    motion.contacts = 1;
    EXPECT_EQ(motion.attractor(), "period 2, 1 contact");
    motion.contacts = 3;
    EXPECT_EQ(motion.attractor(), "period 2, 3 contacts");
    motion.accumulates = true;
    EXPECT_EQ(motion.attractor(), "period 2, accumulating contacts");
    EXPECT_EQ(name_of(AtlasClaim::beyond), "beyond limits");
}

TEST(AtlasFindings, ShareCountsWhatIsValidAndDoesNotConfirm) {
    AtlasFindings found;
    EXPECT_EQ(found.share(), 0);
    for (const AtlasClaim claim : {AtlasClaim::explained, AtlasClaim::explained, AtlasClaim::unexplained,
                                   AtlasClaim::other, AtlasClaim::invalid}) {
        found.motions.emplace_back().claim = claim;
    }
    found.motions.emplace_back().claim = AtlasClaim::explained;
    found.motions.back().confirms = true;
    EXPECT_EQ(found.count(AtlasClaim::explained), 2U);
    EXPECT_EQ(found.share(), 0.5);
}

} // namespace graze::atlas_findings_test
