// Runs of kind "curve" that go on from a touch along the folds and flips of impacting orbits that end there.

#include "study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace graze::impacting_curve_run_test {

using ::testing::HasSubstr;

const std::string touches = R"(
name = "s"
model = "impact-oscillator"
set = { zeta = 0.05, omega = 1.7, e = 0.7, sigma = 3 }
[runs.free]
kind = "continue"
along = { sigma = [0.1, 4] }
direction = "down"
[runs.touches]
kind = "curve"
start = { run = "free", point = "GR1" }
along = { omega = [1.5, 2.5], sigma = [0.001, 20] }
direction = "both"
)";

class ImpactingCurveRun : public testing::StudyFixture {
protected:
    /// The study with a curve from the joint. @param onto as it is written
    std::vector<RunReport> run(const std::string& onto) {
        std::filesystem::remove(path_);
        const std::string curve = "[runs.curve]\nkind = \"curve\"\nstart = { run = \"touches\", point = \"VS1\"" +
                                  onto + " }\nalong = { omega = [1.5, 2.5], sigma = [0.001, 20] }\n";
        return StudyFixture::run(touches + curve);
    }
};

TEST_F(ImpactingCurveRun, FollowsFoldsAndFlipsBeyondATouch) {
    for (const char* type : {"SN", "PD"}) {
        for (const RunReport& report : run(std::string(", onto = \"") + type + "\""))
            EXPECT_EQ(report.problem, "") << report.remedy;
        const ResultFile file(path_, ResultFile::Access::read);
        const auto joint = file.orbit("touches", "VS1"), start = file.orbit("curve", "EP1");
        ASSERT_TRUE(joint && start);
        EXPECT_THAT(joint->point.detail, HasSubstr("folds of orbits with an impact at stop end; flips of orbits"));
        // The first point is the joint itself, with an impact of no speed.
        const auto& parameters = start->point.solution.orbit.parameters;
        for (std::size_t i = 0; i < parameters.size(); ++i)
            EXPECT_NEAR(parameters[i], joint->point.solution.orbit.parameters[i], 1e-9) << i;
        ASSERT_EQ(start->point.solution.certificate.approach_speeds.size(), 1U);
        EXPECT_NEAR(start->point.solution.certificate.approach_speeds[0], 0, 1e-9);
        EXPECT_TRUE(start->point.solution.certificate.admissible) << start->point.solution.certificate.reason;
        ASSERT_TRUE(file.find_run("curve"));
        EXPECT_EQ(file.find_run("curve")->status, RunStatus::complete);
    }
}

TEST_F(ImpactingCurveRun, TellsWhichCurvesBeginAtAPoint) {
    const auto refusal = [&](const std::string& onto) {
        for (const RunReport& report : run(onto))
            if (!report.problem.empty())
                return report.problem + "; " + report.remedy;
        return std::string();
    };
    EXPECT_THAT(refusal(""), HasSubstr("onto = \"GR\" or onto = \"SN\" or onto = \"PD\""));
    EXPECT_THAT(refusal(", onto = \"NS\""), HasSubstr("is no torus"));
}

} // namespace graze::impacting_curve_run_test
