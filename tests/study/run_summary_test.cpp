#include "graze/study/run_summary.hpp"

#include "study_fixture.hpp"
#include "trajectory/model_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace graze::run_summary_test {

using RunSummaryTest = testing::StudyFixture;

/// The curve of torus points of a driven van der Pol oscillator ends where its multipliers are 1.
TEST_F(RunSummaryTest, ACurveThatEndsAtAResonanceSaysSo) {
    const testing::OneMode parts{.parameters = "F = 2\nomega = 1.2",
                                 .states = "x = 0\nv = 0",
                                 .rates = "x = 'v', v = '0.3*(1 - x^2)*v - x + F*cos(theta)'",
                                 .clock = "omega"};
    folder_.write("model.toml", "name = 'beats'\n" + parts.text());
    const auto reports = run(R"(
name = "s"
model = "model.toml"
[runs.orbits]
kind = "continue"
along = { F = [0, 2] }
direction = "down"
[runs.curve]
kind = "curve"
start = { run = "orbits", point = "NS1" }
along = { F = [0, 2], omega = [0.9, 1.4] }
)");
    testing::expect_complete(reports);
    const ResultFile file(path_, ResultFile::Access::read);
    EXPECT_THAT(summary_of(reports.back(), file).ends,
                ::testing::UnorderedElementsAre(std::pair<std::string, std::string>("up", "omega = 1.4"),
                                                std::pair<std::string, std::string>("down", "R1-1")));
}

} // namespace graze::run_summary_test
