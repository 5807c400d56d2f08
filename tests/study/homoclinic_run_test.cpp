// Runs that begin at a saddle cycle and lead onto the orbits that are homoclinic to it.

#include "graze/branch/special_point.hpp"

#include "base/message_of.hpp"
#include "orbit/saddle_cycles.hpp"
#include "study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace graze::homoclinic_run_test {

using ::testing::HasSubstr;

constexpr const char* start_of_study = R"(
name = "s"
model = "model.toml"
[runs.cycle]
kind = "orbit"
signature = "start"
[runs.tangle]
kind = "continue"
start = { run = "cycle", point = "EP1", onto = "homoclinic" }
along = { c = [0, 0.6] }
direction = "up"
)";

class HomoclinicRun : public testing::StudyFixture {
protected:
    /// Manifolds touch at c = A.
    HomoclinicRun() { write(0.2); }
    void write(double c) { folder_.write("model.toml", "name = 'gate'\n" + testing::parts_of_gated_saddle(c).text()); }
};

TEST_F(HomoclinicRun, StoresOrbitsThatAreReadBack) {
    testing::expect_complete(run(start_of_study));
    const ResultFile file(path_, ResultFile::Access::read);
    std::size_t tangencies = 0;
    for (const OrbitRecord& one : file.orbits("tangle", false)) {
        EXPECT_EQ(one.point.solution.orbit.cycle, 1U);
        EXPECT_FALSE(one.stable);
        EXPECT_FALSE(one.touch);
        if (one.point.type != PointType::homoclinic_tangency)
            continue;
        ++tangencies;
        EXPECT_NEAR(one.point.parameter, 0.5, 1e-12);
    }
    EXPECT_EQ(tangencies, 2U); // of two orbits that meet there
    for (const OrbitRecord& one : file.orbits("cycle", false))
        EXPECT_FALSE(one.point.solution.orbit.cycle);
}

TEST_F(HomoclinicRun, CurvesAndFurtherBranchesBeginAtItsPoints) {
    testing::expect_complete(run(std::string(start_of_study) + R"(
[runs.tangency]
kind = "curve"
start = { run = "tangle", point = "HT1" }
along = { c = [0.3, 0.7], A = [0.3, 0.7] }
[runs.other]
kind = "continue"
start = { run = "tangle", point = "EP1" }
along = { A = [0.45, 0.55] }
[runs.one]
kind = "orbit"
start = { run = "cycle", point = "EP1", onto = "homoclinic" }
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto curve = file.orbits("tangency", false);
    ASSERT_GT(curve.size(), 5U);
    for (const OrbitRecord& one : curve)
        EXPECT_NEAR(one.point.solution.orbit.parameters[0], one.point.solution.orbit.parameters[1], 1e-12);
    EXPECT_GT(file.orbits("other", false).size(), 3U);
    ASSERT_EQ(file.orbits("one", false).size(), 1U);
    EXPECT_EQ(file.orbits("one", false)[0].point.solution.orbit.cycle, 1U);
}

TEST_F(HomoclinicRun, SaysWhatIsMissing) {
    EXPECT_THAT(run(std::string(start_of_study) + R"(
[runs.other]
kind = "continue"
start = { run = "tangle", point = "EP1", onto = "other" }
along = { A = [0.45, 0.55] }
)")[2]
                    .problem,
                HasSubstr("no branch of type \"other\" leaves an orbit that is homoclinic to a cycle"));
}

TEST_F(HomoclinicRun, SaysWhereManifoldsDoNotCross) {
    write(0.55);
    EXPECT_THAT(run(start_of_study)[1].problem, HasSubstr("no orbit that is homoclinic to the cycle was found"));
}

} // namespace graze::homoclinic_run_test
