// Runs of kind equilibrium, and what starts from them.

#include "graze/study/stored_study.hpp"
#include "study/study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace graze::equilibrium_run_test {

using ::testing::HasSubstr;

const std::string brusselator = R"([parameters]
a = 1
b = 1
[states]
x = 1
y = 1
[modes.free]
rates = { x = "1 - (b + 1)*x + a*x^2*y", y = "b*x - a*x^2*y" }
[sections.middle]
function = "x - 1"
direction = "rising"
)";
const std::string head = "name = \"s\"\nmodel = \"./model.toml\"\n";

class EquilibriumRun : public testing::StudyFixture {
protected:
    EquilibriumRun() { folder_.write("model.toml", brusselator); }
};

TEST_F(EquilibriumRun, FindsAllInABoxAndStartsBranchesCyclesAndCurves) {
    testing::expect_complete(run(head + R"([runs.rest]
kind = "equilibrium"
within = { x = [0, 10], y = [0, 10] }
[runs.branch]
kind = "continue"
start = { run = "rest" }
along = { b = [0.5, 4] }
[runs.cycles]
kind = "continue"
start = { run = "branch", point = "HB1" }
along = { b = [0.5, 4] }
[runs.curve]
kind = "curve"
start = { run = "branch", point = "HB1" }
along = { a = [0.5, 3], b = [0.5, 5] }
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto rest = file.orbit("rest", std::string("EP1"));
    ASSERT_TRUE(rest);
    EXPECT_EQ(rest->part, "free");
    EXPECT_THAT(rest->point.detail, HasSubstr("in the box is one equilibrium, by proof"));
    EXPECT_EQ(rest->point.solution.orbit.period(), 0);
    ASSERT_EQ(rest->point.solution.eigenvalues.size(), 2U); // l^2 + l + 1 = 0
    EXPECT_NEAR(rest->point.solution.eigenvalues[0].real(), -0.5, 1e-15);
    EXPECT_NEAR(rest->point.solution.eigenvalues[0].imag(), std::sqrt(0.75), 1e-15);
    EXPECT_NEAR(file.orbit("branch", std::string("HB1"))->point.parameter, 2, 1e-13);
    EXPECT_TRUE(file.orbit("cycles", std::string("BD1"))->stable);
    for (const OrbitRecord& one : file.orbits("curve", false))
        EXPECT_NEAR(one.point.solution.orbit.parameters[1], 1 + one.point.solution.orbit.parameters[0], 1e-12);
}

TEST_F(EquilibriumRun, StoredSettingsSayTheSameAgain) {
    const std::string text = head + "[runs.rest]\nkind = \"equilibrium\"\nwithin = { x = [0, 10], y = [0, 10] }\n";
    run(text);
    ResultFile file(path_, ResultFile::Access::write);
    const Study again = stored_study(file);
    ASSERT_EQ(again.runs.at(0).branch().within.size(), 2U);
    EXPECT_EQ(again.runs.at(0).branch().within[1].greatest, 10);
    EXPECT_TRUE(again.runs.at(0).branch().every_mode);
    for (const RunReport& report : run_study(again, file, {}))
        EXPECT_EQ(report.computed, 0U);
}

TEST_F(EquilibriumRun, BeginsAtTheEndOfAMotionOrFromTheInitialState) {
    testing::expect_complete(run(head + R"([runs.motion]
kind = "simulate"
time = 5
[runs.rest]
kind = "equilibrium"
start = { run = "motion" }
[runs.same]
kind = "equilibrium"
from = { x = 2, y = 2 }
[runs.settled]
kind = "continue"
from = { x = 1.1 }
along = { b = [0.5, 1.5] }
[runs.signed]
kind = "continue"
signature = "equilibrium"
along = { b = [0.5, 1.5] }
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    for (const char* name : {"rest", "same", "settled", "signed"})
        EXPECT_NEAR(file.orbits(name, false).at(0).point.solution.orbit.starts[0][0], 1, 1e-12) << name;
}

TEST_F(EquilibriumRun, SweepsStoreEigenvaluesOfEquilibria) {
    testing::expect_complete(run(head + "[runs.sweep]\nkind = \"sweep\"\nvary = { b = [0.5, 1] }\n"));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto point = file.point("sweep", 1);
    ASSERT_TRUE(point);
    EXPECT_EQ(point->result.label, Label::equilibrium);
    ASSERT_EQ(point->result.eigenvalues.size(), 2U);
    EXPECT_NEAR(point->result.eigenvalues[0].real(), -0.5, 1e-9);
}

TEST_F(EquilibriumRun, RefusesWhatMakesNoSense) {
    const std::string begin = head + "[runs.rest]\nkind = \"equilibrium\"\n";
    EXPECT_THAT(refusal(begin + "within = { x = [0, 10] }\n"), HasSubstr("no range of state 'y'"));
    EXPECT_THAT(refusal(begin + "within = { z = [0, 10] }\n"), HasSubstr("no state 'z'"));
    EXPECT_THAT(refusal(begin + "within = {}\n"), HasSubstr("names no state"));
    EXPECT_THAT(refusal(begin + "within = { x = [10, 0], y = [0, 1] }\n"), HasSubstr("within.x"));
    EXPECT_THAT(refusal(begin + "within = { x = [0, 1], y = [0, 1] }\nfrom = { x = 1 }\n"), HasSubstr("`from`"));
    EXPECT_THAT(refusal(begin + "signature = \"equilibrium\"\n"), HasSubstr("have no `signature`"));
    EXPECT_THAT(refusal(begin + "along = { b = [0, 1] }\n"), HasSubstr("have no `along`"));
    EXPECT_THAT(refusal(begin + "within = { x = [2, 3], y = [0, 1] }\n"),
                HasSubstr("it is proven that there is no equilibrium in the box; widen the box"));
    EXPECT_THAT(refusal(head + "[runs.sweep]\nkind = \"sweep\"\nvary = { b = [1] }\nwithin = { x = [0, 1] }\n"),
                HasSubstr("it belongs to \"equilibrium\""));
}

} // namespace graze::equilibrium_run_test
