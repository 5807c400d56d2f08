#include "picture/attractor_classes.hpp"

#include <gmock/gmock.h>

#include <set>

namespace graze::attractor_classes_test {

using ::testing::ElementsAre;

AtlasMotion motion_of(Label label, std::size_t period = 0, std::size_t contacts = 0) {
    AtlasMotion motion;
    motion.label = label;
    motion.period = period;
    motion.contacts = contacts;
    return motion;
}

std::vector<std::string> names_of(const AttractorClasses& classes) {
    std::vector<std::string> names;
    for (const AttractorClass& one : classes.all())
        names.push_back(one.name);
    return names;
}

TEST(AttractorClasses, AreNamedInWordsSimpleOnesFirst) {
    const std::vector<AtlasMotion> motions{motion_of(Label::chaotic), motion_of(Label::periodic, 2, 3),
                                           motion_of(Label::periodic, 1, 1), motion_of(Label::periodic, 2, 3)};
    const AttractorClasses classes(motions, {motion_of(Label::periodic, 1, 2)});
    EXPECT_THAT(names_of(classes),
                ElementsAre("period 1, 1 contact", "period 1, 2 contacts", "period 2, 3 contacts", "chaotic"));
    EXPECT_EQ(classes.index_of(motions[1]), 2U);
}

TEST(AttractorClasses, MotionsThatHaveNotSettledLookTheSame) {
    const std::vector<AtlasMotion> motions{motion_of(Label::transient), motion_of(Label::unsettled),
                                           motion_of(Label::unbounded), motion_of(Label::chaotic)};
    const AttractorClasses classes(motions, {});
    ASSERT_EQ(classes.all().size(), 3U);
    EXPECT_EQ(classes.index_of(motions[0]), classes.index_of(motions[1]));
    EXPECT_EQ(classes.all()[classes.index_of(motions[0])].name, "unsettled");
    EXPECT_EQ(classes.all()[classes.index_of(motions[0])].drawn, DrawnAs::uncertain);
    std::set<int> hatches; // chaotic regions are filled
    for (const AttractorClass& one : classes.all())
        hatches.insert(one.hatch);
    EXPECT_EQ(hatches.size(), 3U);
}

TEST(AttractorClasses, OnlyTheMostFrequentPeriodsHaveColoursOfTheirOwn) {
    std::vector<AtlasMotion> motions;
    for (std::size_t period = 1; period <= 14; ++period)
        for (std::size_t times = 0; times < (period == 14 ? 1 : 2); ++times)
            motions.push_back(motion_of(Label::periodic, period));
    motions.push_back(motion_of(Label::periodic, 13)); // so that it is more frequent than others
    const AttractorClasses classes(motions, {});
    ASSERT_EQ(classes.all().size(), 11U);
    EXPECT_EQ(classes.all().back().name, "other periods");
    EXPECT_EQ(classes.all()[classes.index_of(motions.back())].name, "period 13, 0 contacts");
    EXPECT_EQ(classes.index_of(motion_of(Label::periodic, 14)), 10U);
    std::set<std::size_t> colours;
    for (const AttractorClass& one : classes.all())
        colours.insert(one.colour);
    EXPECT_EQ(colours.size(), classes.all().size());
}

} // namespace graze::attractor_classes_test
