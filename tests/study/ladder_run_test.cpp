#include "graze/branch/ladder.hpp"
#include "graze/study/stored_ladder.hpp"

#include "study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace graze::ladder_run_test {

using ::testing::HasSubstr;

/// A slow force presses the mass against the stop: what does it do before it stays there?
const std::string free_text = R"(
name = "s"
model = "impact-oscillator"
set = { zeta = 0.5, omega = 0.3, e = 0.5, sigma = 1.5 }
[runs.free]
kind = "continue"
along = { sigma = [0.1, 3] }
direction = "down"
)";
const std::string ladder_text = R"(
[runs.ladder]
kind = "ladder"
start = { run = "free", point = "GR1" }
along = { sigma = [0.1, 3] }
rungs = 6
)";

class LadderRun : public testing::StudyFixture {};

TEST_F(LadderRun, KeepsAllGrazingsAndWhereTheyLead) {
    run(free_text + ladder_text);
    const ResultFile file(path_, ResultFile::Access::read);
    ASSERT_EQ(file.find_run("ladder")->status, RunStatus::complete);
    double before = 2;
    for (int k = 1; k <= 6; ++k) {
        const auto grazing = file.orbit("ladder", "GR" + std::to_string(k));
        ASSERT_TRUE(grazing) << k;
        EXPECT_EQ(grazing->part, "rung " + std::to_string(k));
        EXPECT_LT(grazing->point.parameter, before);
        before = grazing->point.parameter;
        // One contact more each; the first one touches between sections.
        EXPECT_EQ(grazing->point.solution.orbit.segments(), k == 1 ? 1u : static_cast<unsigned>(k - 1));
    }
    EXPECT_FALSE(file.orbit("ladder", std::string("GR7")));
    EXPECT_EQ(file.orbit("ladder", std::string("GR1"))->point.parameter,
              file.orbit("free", std::string("GR1"))->point.parameter);
    const auto limit = file.orbit("ladder", std::string("CH1"));
    ASSERT_TRUE(limit);
    EXPECT_EQ(limit->part, "limit");
    EXPECT_NEAR(limit->point.parameter, 0.883314285620, 1e-10); // see the test of ChatterLimit
    EXPECT_LT(limit->point.bracket.second - limit->point.bracket.first, 5e-10);
    EXPECT_THAT(limit->point.detail, HasSubstr("e = 0.5"));
    EXPECT_LT(limit->point.solution.residual, 1e-8);
    EXPECT_NEAR(limit->point.solution.orbit.period(), 2 * std::numbers::pi / 0.3, 1e-9);
}

// The settings of the run of the first grazing and those of the ladder's run are the same here.
TEST_F(LadderRun, ALadderFromAStoredPointIsTheSameToTheBit) {
    run(free_text + ladder_text);
    const ResultFile file(path_, ResultFile::Access::read);
    LadderRequest request;
    request.point = "free:GR1";
    request.grazings = 6;
    std::vector<std::size_t> told;
    request.progress = [&](std::size_t grazing) { told.push_back(grazing); };
    const StoredLadder found = stored_ladder(file, request);
    EXPECT_EQ(told, (std::vector<std::size_t>{2, 3, 4, 5, 6}));
    ASSERT_EQ(found.ladder.grazings().size(), 6U);
    for (std::size_t k = 0; k < 6; ++k) {
        const SpecialPoint& here = found.ladder.grazings()[k];
        const auto there = file.orbit("ladder", "GR" + std::to_string(k + 1));
        ASSERT_TRUE(there);
        EXPECT_EQ(here.parameter, there->point.parameter) << k;
        EXPECT_EQ(here.solution.orbit.starts, there->point.solution.orbit.starts) << k;
    }
    const auto limit = file.orbit("ladder", std::string("CH1"));
    ASSERT_TRUE(limit && found.limit.direct);
    EXPECT_EQ(found.limit.direct->first, limit->point.parameter);
    request.parameter = "none";
    EXPECT_THROW(stored_ladder(file, request), InputError);
    request.parameter.clear();
    request.interrupted = [] { return true; };
    const StoredLadder stopped = stored_ladder(file, request);
    EXPECT_TRUE(stopped.interrupted);
    EXPECT_EQ(stopped.ladder.grazings().size(), 1U);
}

TEST_F(LadderRun, ItsLimitIsFollowedInTwoParameters) {
    const std::string curve = R"(
[runs.onset]
kind = "curve"
start = { run = "ladder", point = "CH1" }
along = { omega = [0.28, 0.34], sigma = [0.1, 3] }
direction = "both"
)";
    run(free_text + ladder_text + curve);
    const ResultFile file(path_, ResultFile::Access::read);
    const auto orbits = file.orbits("onset", false);
    ASSERT_GT(orbits.size(), 20u);
    EXPECT_EQ(orbits.front().label, "CH1");
    EXPECT_THAT(orbits.back().point.detail, HasSubstr("bound: omega = 0.28"));
    EXPECT_FALSE(file.orbit("onset", std::string("CH2")));
    // At both ends it is the limit of a ladder of its own.
    const Model model = parse_study(free_text, "s.toml").runs.front().model;
    const std::size_t omega = model.independent_parameter("omega").place(),
                      sigma = model.independent_parameter("sigma").place();
    for (const char* end : {"EP1", "EP2"}) {
        const auto point = file.orbit("onset", std::string(end));
        ASSERT_TRUE(point) << end;
        const std::vector<double>& parameters = point->point.solution.orbit.parameters;
        EXPECT_NEAR(parameters[omega], end == std::string("EP1") ? 0.34 : 0.28, 1e-12);
        Model there = model;
        there.set_parameter("omega", parameters[omega]);
        AttractorOptions settle;
        settle.section = there.sections.front().name;
        BranchSettings settings;
        settings.parameter = there.independent_parameter("sigma");
        settings.direction = -1;
        settings.least = 0.1;
        settings.stop_at = {PointType::grazing};
        const Branch branch = follow_branch(System(there), find_orbit(System(there), settle).orbit, settings);
        const ChatterLimit limit = climb(System(there), branch.special.back(), settings, 5).limit();
        ASSERT_TRUE(limit.direct) << limit.problem;
        EXPECT_NEAR(parameters[sigma], limit.direct->first, 1e-10);
    }
}

class LadderRunSlow : public LadderRun {};

/// A restitution that depends on the square of a parameter: whatever the first one is, it turns where that is zero.
TEST_F(LadderRunSlow, ItsLimitIsFollowedPastATurn) {
    const std::string model_path = path_ + ".toml";
    std::ofstream(model_path) << R"(
name = "even"
[parameters]
s = 1.5
q = 0.1
[states]
x = 0
v = 0
theta = { initial = 0, period = "2*pi" }
[modes.free]
rates = { x = "v", v = "cos(theta) - x - v", theta = "0.3" }
watch = ["stop"]
[events.stop]
function = "s - x"
[jumps.bounce]
v = "-(0.5 - q^2)*v"
[[transitions]]
mode = "free"
event = "stop"
jump = "bounce"
next = "free"
[sections.start]
state = "theta"
value = 0
)";
    run("name = \"s\"\nmodel = \"" + model_path + R"("
[runs.free]
kind = "continue"
along = { s = [0.1, 3] }
direction = "down"
[runs.ladder]
kind = "ladder"
start = { run = "free", point = "GR1" }
along = { s = [0.1, 3] }
[runs.onset]
kind = "curve"
start = { run = "ladder", point = "CH1" }
along = { s = [0.8, 0.9], q = [-0.12, 0.12] }
direction = "both"
)");
    std::filesystem::remove(model_path);
    const ResultFile file(path_, ResultFile::Access::read);
    std::vector<std::pair<double, double>> places;
    for (const OrbitRecord& record : file.orbits("onset", false))
        places.emplace_back(record.point.solution.orbit.parameters[0], record.point.solution.orbit.parameters[1]);
    ASSERT_GT(places.size(), 10U);
    // It ends at both bounds of q, with the same s: the model is even in q. At e = 0.5 it is that of the test above.
    const auto by_q = [](const auto& one, const auto& other) { return one.second < other.second; };
    const auto [first, last] = std::minmax_element(places.begin(), places.end(), by_q);
    EXPECT_NEAR(first->second, -0.12, 1e-15);
    EXPECT_NEAR(last->second, 0.12, 1e-15);
    EXPECT_NEAR(first->first, last->first, 1e-10);
    const double least = std::min_element(places.begin(), places.end())->first;
    EXPECT_NEAR(least, 0.883314285620, 1e-4); // at the turn, which lies between two points
    EXPECT_GT(least, 0.883314285620 - 1e-10);
}

TEST_F(LadderRun, OfFewContactsHasALimitOrTellsWhyNot) {
    // A fast force: contacts do not accumulate, though one grazing follows the other.
    run(R"(
name = "s"
model = "impact-oscillator"
set = { zeta = 0.05, omega = 2.4, e = 0.7, sigma = 0.02, amplitude = 1 }
[runs.free]
kind = "continue"
along = { sigma = [-1, 1] }
direction = "down"
[runs.ladder]
kind = "ladder"
start = { run = "free", point = "GR1" }
along = { sigma = [-1, 1] }
)");
    const ResultFile file(path_, ResultFile::Access::read);
    const auto orbits = file.orbits("ladder", true);
    ASSERT_GT(orbits.size(), 1u);
    EXPECT_EQ(orbits.back().part, "limit");
    if (orbits.back().point.type == PointType::chatter)
        EXPECT_TRUE(std::isfinite(orbits.back().point.bracket.second));
    else
        EXPECT_THAT(orbits.back().point.detail, HasSubstr("no limit: "));
}

TEST_F(LadderRun, OnsetIsFollowedUntilThereIsNoneOrItIsNotFound) {
    const std::string curve = R"(
[runs.onset]
kind = "curve"
start = { run = "ladder", point = "CH1" }
along = { zeta = [0.3, 0.7], sigma = [0.1, 3] }
direction = "both"
)";
    run(free_text + ladder_text + curve);
    {
        const ResultFile file(path_, ResultFile::Access::read);
        for (const OrbitRecord& record : file.orbits("onset", false)) {
            EXPECT_FALSE(record.point.solution.orbit.starts.empty());
            EXPECT_TRUE(std::isfinite(record.point.parameter));
        }
    }
    const auto with = [&](const std::string& more, const std::string& start) {
        return refusal(free_text + ladder_text +
                       "[runs.onset]\nkind = \"curve\"\nstart = { run = \"ladder\", point = \"CH1\"" + start + " }\n" +
                       more);
    };
    const std::string along = "along = { zeta = [0.3, 0.7], sigma = [0.1, 3] }\n";
    EXPECT_THAT(with(along, ", onto = \"PD\""), HasSubstr("it is no point of type PD"));
    EXPECT_THAT(with(along + "stop = [\"SN\"]", ""), HasSubstr("it meets no other points"));
    EXPECT_THAT(with(along + "monitors = { reach = { maximum = \"x\", report = 0.5 } }", ""),
                HasSubstr("cannot be fixed"));
    EXPECT_THAT(with("along = { zeta = [0.6, 0.7], sigma = [0.1, 3] }", ""), HasSubstr("lies outside of the bounds"));
    EXPECT_THAT(refusal(free_text + ladder_text + R"(
[runs.orbits]
kind = "continue"
direction = "up"
start = { run = "ladder", point = "CH1" }
along = { sigma = [0.1, 3] }
)"),
                HasSubstr("no orbit begins there"));
}

TEST_F(LadderRun, IsRefusedWithoutAGrazing) {
    const auto with = [&](const std::string& text) {
        return refusal(free_text + "[runs.l]\nkind = \"ladder\"\n" + text);
    };
    const std::string start = "start = { run = \"free\", point = \"GR1\" }\n", along = "along = { sigma = [0.1, 3] }\n";
    EXPECT_THAT(with(along), HasSubstr("does not say at which point the ladder begins"));
    EXPECT_THAT(with(start), HasSubstr("does not say what is followed"));
    EXPECT_THAT(with(start + along + "rungs = 1"), HasSubstr("give a whole number from 2 to 1000"));
    EXPECT_THAT(with(start + along + "stop = [\"GR\"]"), HasSubstr("runs of kind \"ladder\" have no `stop`"));
    EXPECT_THAT(with(start + along + "set = { e = 0.6 }"), HasSubstr("have no `set`"));
    EXPECT_THAT(with(start + "along = { sigma = [2, 3] }"), HasSubstr("lies outside of its bounds"));
    EXPECT_THAT(with("start = { run = \"free\", point = \"EP1\" }\n" + along), HasSubstr("touches nothing"));
    // Nothing grazes again between these bounds.
    EXPECT_THAT(with(start + "along = { sigma = [1.04, 3] }\nrungs = 5"), HasSubstr("no ladder begins there: bound"));
}

} // namespace graze::ladder_run_test
