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

/// z -> z (1 + p - |z|^2) exp(i phi) with phi = 2 pi (w + p/10) + 0.3 Im z^5 locks where 2 pi |w + p/10 - 1/5| is below
/// 0.3 p^(5/2): between 0.0985444671866206 and 0.1015698321654422 for w = 0.19.
TEST_F(TorusRun, LockingsAreOrbitsToStartFrom) {
    const std::string turn = "(2*pi*(w + 0.1*p) + 0.3*(5*x^4*y - 10*x^2*y^3 + y^5))";
    const testing::OneMode map{
        .parameters = "p = -0.05\nw = 0.19",
        .states = "x = 0\ny = 0\nclock = 0",
        .rates = "x = 0, y = 0, clock = 1",
        .stops = {{"tick", "1 - clock",
                   "x = '(1 + p - x^2 - y^2)*(x*cos" + turn + " - y*sin" + turn +
                       ")'\ny = '(1 + p - x^2 - y^2)*(x*sin" + turn + " + y*cos" + turn + ")'\nclock = 0",
                   "map"}}};
    folder_.write("model.toml", "name = 'locks'\n" + map.text());
    testing::expect_complete(run(R"(
name = "s"
model = "model.toml"
[runs.orbits]
kind = "continue"
signature = "map"
along = { p = [-0.05, 0.12] }
[runs.tori]
kind = "torus"
start = { run = "orbits", point = "NS1" }
along = { p = [-0.05, 0.12] }
[runs.locked]
kind = "continue"
start = { run = "tori", point = "PL1" }
along = { p = [0, 0.12] }
[runs.edge]
kind = "curve"
start = { run = "tori", point = "PL2" }
along = { w = [0.185, 0.195], p = [0, 0.2] }
[pictures.all]
runs = ["orbits", "tori", "locked"]
y = "max_x"
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    constexpr double begin = 0.0985444671866206, end = 0.1015698321654422;
    std::string labels;
    for (const OrbitRecord& one : file.orbits("tori", true)) {
        labels += one.label + ' ';
        if (one.point.type != PointType::locking)
            continue;
        EXPECT_FALSE(one.torus);
        EXPECT_EQ(one.point.solution.orbit.segments(), 5U);
        EXPECT_NEAR(one.point.parameter, one.label == "PL1" ? begin : end, 1e-13);
        EXPECT_NEAR(one.point.bracket.first, begin, 1e-13);
        EXPECT_NEAR(one.point.bracket.second, end, 1e-13);
        EXPECT_NEAR(one.point.monitors[0], std::sqrt(one.point.parameter), 0.2 * std::sqrt(begin));
        EXPECT_THAT(one.point.detail, HasSubstr("width 0.00302536"));
    }
    EXPECT_EQ(labels, "EP1 PL1 PL2 BD1 ");
    std::size_t folds = 0;
    for (const OrbitRecord& one : file.orbits("locked", true)) {
        const double p = one.point.parameter;
        folds += one.point.type == PointType::fold ? 1 : 0;
        if (one.point.type == PointType::fold) {
            EXPECT_NEAR(p, p < 0.5 * (begin + end) ? begin : end, 1e-12);
        }
    }
    EXPECT_GE(folds, 2U);
    for (const OrbitRecord& one : file.orbits("edge", false)) {
        const auto& [p, w] = std::pair(one.point.solution.orbit.parameters[0], one.point.solution.orbit.parameters[1]);
        EXPECT_NEAR(2 * 3.14159265358979 * (w + 0.1 * p - 0.2), 0.3 * std::pow(p, 2.5), 1e-10) << p;
    }
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
