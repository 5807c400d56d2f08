#include "picture/section_passages.hpp"

#include "graze/results/stored_run.hpp"
#include "study/study_fixture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

namespace graze::section_passages_test {

using ::testing::ElementsAre;

class SectionPassagesOfOrbits : public testing::StudyFixture {
protected:
    /// Compares x at the section: of an orbit, and of a motion that has settled on it.
    void compare(const std::string& set, std::size_t period) const {
        testing::expect_complete(
            run(fmt::format("name = \"s\"\nmodel = \"impact-oscillator\"\nset = {{ {} }}\n[runs.motion]\n"
                            "kind = \"sweep\"\nvary = {{ zeta = [0.02] }}\nkeep = {}\n[runs.orbit]\nkind = \"orbit\"\n",
                            set, period)));
        const ResultFile file(path_, ResultFile::Access::read);
        const StoredRun orbits(file, "orbit", {});
        std::vector<double> samples;
        auto rows = StoredRun(file, "motion", {}).rows({.samples = true, .values = {"x"}});
        while (rows.next())
            samples.push_back(rows.number(0));
        SectionPassages passages(orbits.model, "phase0", named_value(orbits.model, "x", {}));
        std::vector<double> values = passages.of(file.orbits("orbit", false).at(0).point.solution.orbit);
        ASSERT_EQ(values.size(), period);
        ASSERT_EQ(samples.size(), period);
        std::ranges::sort(values);
        std::ranges::sort(samples);
        for (std::size_t i = 0; i < period; ++i)
            EXPECT_NEAR(values[i], samples[i], 1e-6);
    }
};

TEST_F(SectionPassagesOfOrbits, AreTheSamplesOfMotionsThatSettleOnThem) {
    compare("omega = 2.8", 2);
}

// There the section itself ends the segments.
TEST_F(SectionPassagesOfOrbits, AreCountedOnceWhereSegmentsEndAtTheSection) {
    compare("omega = 1.2, sigma = 0.5, amplitude = 0.1", 1);
}

TEST(AlignPassages, TurnsTheOrderRound) {
    std::vector<double> values{3.1, 1.1, 2.1};
    align_passages(values, {1, 2, 3});
    EXPECT_THAT(values, ElementsAre(1.1, 2.1, 3.1));
    align_passages(values, {3.2}); // of an orbit that passes less often
    EXPECT_THAT(values, ElementsAre(3.1, 1.1, 2.1));
    std::vector<double> none;
    align_passages(none, {1});
    EXPECT_TRUE(none.empty());
}

} // namespace graze::section_passages_test
