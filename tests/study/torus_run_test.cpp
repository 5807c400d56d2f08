#include "graze/branch/torus.hpp"
#include "graze/results/located_point.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/results/touching_orbit.hpp"
#include "graze/study/stored_ladder.hpp"

#include "base/message_of.hpp"
#include "study_fixture.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace graze::torus_run_test {

using ::testing::HasSubstr;

constexpr const char* start_of_study = R"(
name = "s"
model = "model.toml"
[runs.orbits]
kind = "continue"
along = { p = [-0.1, 0.2] }
direction = "up"
[runs.tori]
kind = "torus"
start = { run = "orbits", point = "NS1" }
along = { p = [-0.1, 0.2] }
)";

class TorusRun : public testing::StudyFixture {
protected:
    /// About the orbit x = cos(theta), y = sin(2 theta)/3 tori are circles of radius sqrt(p) that turn at 0.3 - 0.7 p.
    TorusRun() {
        const testing::OneMode parts{.parameters = "p = -0.1",
                                     .states = "x = 1\ny = 0",
                                     .definitions = "u = 'x - cos(theta)'\nv = 'y - sin(2*theta)/3'",
                                     .rates = "x = 'p*u - 0.3*v - (u - 0.7*v)*(u^2 + v^2) - sin(theta)', "
                                              "y = '0.3*u + p*v - (v + 0.7*u)*(u^2 + v^2) + 2*cos(2*theta)/3'",
                                     .clock = "1"};
        folder_.write("model.toml", "name = 'circles'\n" + parts.text());
    }
};

TEST_F(TorusRun, StoresARowForEachTorus) {
    testing::expect_complete(run(start_of_study));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto tori = file.orbits("tori", false);
    ASSERT_GT(tori.size(), 5U);
    for (const OrbitRecord& one : tori) {
        const double p = one.point.parameter;
        ASSERT_TRUE(one.torus);
        EXPECT_NEAR(one.torus->rotation, 0.3 - 0.7 * p, 1e-10);
        EXPECT_NEAR(one.torus->growth, std::exp(-4 * 3.14159265358979 * p), 1e-9);
        EXPECT_TRUE(one.stable);
        // The monitors of a branch that has none: the greatest values of the states.
        ASSERT_EQ(one.point.monitors.size(), 2U);
        EXPECT_NEAR(one.point.monitors[0], 1 + std::sqrt(p), 1e-9);
        EXPECT_NEAR(one.point.monitors[1], 1. / 3 + std::sqrt(p), 1e-9);
        ASSERT_EQ(one.torus->circle.size(), 3 * (one.torus->harmonics + 1));
        double squares = 0;
        for (const CircleTerm& term : one.torus->circle)
            if (term.harmonic == 1)
                squares += term.even * term.even + term.odd * term.odd;
        EXPECT_NEAR(squares, 2 * p, 1e-10);
    }
    EXPECT_EQ(tori.front().label, "EP1");
    EXPECT_EQ(tori.back().label, "BD1");
    std::string passed;
    for (const OrbitRecord& one : tori)
        passed += one.point.detail + ' ';
    EXPECT_THAT(passed, HasSubstr("passed the rotation numbers 2/7"));
    EXPECT_THAT(passed, HasSubstr("1/4 (strong)"));
    EXPECT_EQ(file.find_run("tori")->values.size(), 2U);
    const StoredRun stored(file, "tori", {});
    auto rows = stored.rows({.quantities = {"rotation_number"}});
    ASSERT_TRUE(rows.next());
    // Of orbits there is nothing of the kind.
    auto none = file.query("SELECT count(*) FROM branch_orbits WHERE rotation_number IS NOT NULL");
    ASSERT_TRUE(none.next());
    EXPECT_EQ(none.integer(0), 0);
    auto unknown = file.query("SELECT count(*) FROM branch_tori WHERE unstable IS NOT NULL");
    ASSERT_TRUE(unknown.next());
    EXPECT_EQ(unknown.integer(0), 0);
}

TEST_F(TorusRun, ATorusIsNoOrbit) {
    testing::expect_complete(run(start_of_study));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto refused = [&](const auto& use) { return testing::message_of(use); };
    EXPECT_THAT(refused([&] { find_closed_orbit(file, "tori:BD1", {}); }),
                HasSubstr("'tori:BD1' is a torus, whose motions do not close"));
    EXPECT_THAT(refused([&] { find_touching_orbit(file, "tori:BD1", "", {}, {}); }), HasSubstr("is a torus"));
    EXPECT_THAT(refused([&] { located_point(file, "tori:BD1", "", {}, {}); }), HasSubstr("is a torus"));
    EXPECT_THAT(refused([&] { stored_ladder(file, {.point = "tori:BD1"}); }), HasSubstr("is a torus"));
}

TEST_F(TorusRun, AMotionBeginsOnATorus) {
    testing::expect_complete(run(start_of_study + std::string(R"(
[runs.motion]
kind = "simulate"
periods = 3
start = { run = "tori", point = "BD1" }
)")));
}

TEST_F(TorusRun, SaysWhatIsMissing) {
    const std::string text = start_of_study;
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string changed = text;
        return changed.replace(changed.find(from), from.size(), to);
    };
    EXPECT_THAT(refusal(with(", point = \"NS1\"", "")), HasSubstr("does not say at which point the tori begin"));
    EXPECT_THAT(refusal(with("\"NS1\"", "\"EP1\"")), HasSubstr("no tori begin at a point of type EP"));
    EXPECT_THAT(refusal(text + "monitors = { a = { mean = \"x\" } }"), HasSubstr("tori have no others"));
    EXPECT_THAT(refusal(text + "harmonics = 2"), HasSubstr("give a whole number from 3 to 512"));
    EXPECT_THAT(refusal(text + "direction = \"up\""), HasSubstr("have no `direction`"));
    EXPECT_THAT(refusal(text + "[runs.again]\nkind = \"continue\"\nstart = { run = \"tori\", point = \"EP1\" }\n"
                               "along = { p = [-0.1, 0.2] }"),
                HasSubstr("has tori, and no orbits to start from"));
}

} // namespace graze::torus_run_test
