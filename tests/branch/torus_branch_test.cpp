#include "graze/branch/torus_branch.hpp"

#include "base/message_of.hpp"
#include "birkhoff.hpp"
#include "follow.hpp"
#include "maps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace graze::torus_branch_test {

using namespace graze::testing;
using ::testing::HasSubstr;

constexpr double pi = std::numbers::pi;

/// z = u + i v with z' = (p + i w) z - (1 + i b) z |z|^2 about the orbit x = cos(theta), y = sin(2 theta)/3: its tori
/// are circles |z|^2 = p that turn at w - b p, and deviations from them decay at 2 p.
std::string about_orbit(double w, double b) {
    return fmt::format("p = -0.1\nw = {}\nb = {}", w, b);
}
OneMode normal_form(double w, double b) {
    return {.parameters = about_orbit(w, b),
            .states = "x = 1\ny = 0",
            .definitions = "u = 'x - cos(theta)'\nv = 'y - sin(2*theta)/3'",
            .rates = "x = 'p*u - w*v - (u - b*v)*(u^2 + v^2) - sin(theta)', "
                     "y = 'w*u + p*v - (v + b*u)*(u^2 + v^2) + 2*cos(2*theta)/3'",
            .clock = "1"};
}

Monitor extreme(const Model& model, const std::string& state, Monitor::Kind kind) {
    Monitor monitor;
    monitor.name = state;
    monitor.kind = kind;
    monitor.expression = model.symbol(state);
    return monitor;
}

/// The torus point of the branch of the orbit that motions settle on.
SpecialPoint torus_point(const Model& model, const BranchSettings& settings) {
    const auto found = of_type(follow_branch(System(model), settled(model, "start").orbit, settings), PointType::torus);
    EXPECT_EQ(found.size(), 1U);
    return found.at(0);
}

std::vector<TorusPoint> all_of(TorusBranch& branch) {
    std::vector<TorusPoint> points;
    for (bool going = branch.start(); going; going = branch.step())
        points.push_back(branch.point());
    return points;
}

TEST(TorusBranch, NormalFormHasItsClosedForm) {
    constexpr double w = 0.3, b = 0.7;
    const Model model = normal_form(w, b).model();
    BranchSettings settings = in_parameter(model, "p", -0.1, 0.2);
    const SpecialPoint point = torus_point(model, settings);
    settings.monitors = {extreme(model, "x", Monitor::Kind::maximum), extreme(model, "y", Monitor::Kind::minimum)};
    TorusBranch branch(System(model), point, settings);
    const std::vector<TorusPoint> points = all_of(branch);
    EXPECT_EQ(branch.outcome(), TorusOutcome::bound) << branch.detail();
    ASSERT_GT(points.size(), 5U);
    EXPECT_LT(points.size(), 60U);
    EXPECT_NEAR(points.back().parameter, 0.2, 1e-12);
    for (const TorusPoint& one : points) {
        const double p = one.parameter, radius = std::sqrt(p);
        EXPECT_NEAR(one.torus.rotation, w - b * p, 1e-10) << p;
        for (const double turns : {0.0, 0.13, 0.57, 0.91}) {
            const std::vector<double> state = one.torus.state_at(turns);
            EXPECT_NEAR(std::hypot(state[0] - 1, state[1]), radius, 1e-10 * radius) << p;
        }
        EXPECT_NEAR(one.facts.growth, std::exp(-4 * pi * p), 1e-10);
        EXPECT_TRUE(one.stable);
        EXPECT_LT(one.facts.defect, 1e-10);
        EXPECT_NEAR(one.monitors[0], 1 + radius, 1e-9);
        EXPECT_NEAR(one.monitors[1], -1. / 3 - radius, 1e-9);
    }
    // From 0.3 to 0.16 the rotation number passes resonances, which do not matter here.
    std::string passed;
    for (const TorusPoint& one : points)
        for (const PhaseLocking& locking : one.passed) {
            const Resonance& resonance = locking.resonance;
            passed += fmt::format("{}/{} ", resonance.numerator, resonance.denominator);
            EXPECT_EQ(locking.known, PhaseLocking::Width::bounded) << locking.problem;
            EXPECT_NEAR(locking.parameter, (w - resonance.value()) / b, 1e-11);
            EXPECT_LT(locking.width, 1e-11);
            EXPECT_TRUE(locking.ends.empty());
        }
    EXPECT_EQ(passed, "2/7 3/11 1/4 2/9 1/5 2/11 1/6 ");
}

TEST(TorusBranch, BoundsMayBeginAtTheTorusPoint) {
    const Model model = normal_form(0.3, 0.7).model();
    BranchSettings settings = in_parameter(model, "p", -0.1, 0.2);
    const SpecialPoint point = torus_point(model, settings);
    settings.least = point.parameter + 1e-13;
    TorusBranch branch(System(model), point, settings);
    ASSERT_FALSE(all_of(branch).empty()) << branch.detail();
    EXPECT_EQ(branch.outcome(), TorusOutcome::bound);
    EXPECT_EQ(branch.point().parameter, 0.2);
}

/// With the other sign of the cubic terms the tori are unstable, and are where the orbit is stable.
TEST(TorusBranch, UnstableToriAreFollowedAlike) {
    OneMode parts = normal_form(0.21, 0.3);
    parts.rates = "x = 'p*u - w*v + (u - b*v)*(u^2 + v^2) - sin(theta)', "
                  "y = 'w*u + p*v + (v + b*u)*(u^2 + v^2) + 2*cos(2*theta)/3'";
    const Model model = parts.model();
    BranchSettings settings = in_parameter(model, "p", -0.15, 0.1);
    TorusBranch branch(System(model), torus_point(model, settings), settings);
    const std::vector<TorusPoint> points = all_of(branch);
    EXPECT_EQ(branch.outcome(), TorusOutcome::bound) << branch.detail();
    ASSERT_GT(points.size(), 5U);
    EXPECT_NEAR(points.back().parameter, -0.15, 1e-12);
    for (const TorusPoint& one : points) {
        EXPECT_NEAR(one.torus.rotation, 0.21 - 0.3 * one.parameter, 1e-10);
        EXPECT_NEAR(one.facts.growth, std::exp(-4 * pi * one.parameter), 1e-8);
        EXPECT_FALSE(one.stable);
    }
}

/// x = cos(theta) + sqrt(p) cos(phase) first touches a wall at 1 + c where p = c^2.
TEST(TorusBranch, EndsWhereTheTorusGrazes) {
    constexpr double c = 0.35;
    OneMode parts = normal_form(0.3, 0.7);
    parts.stops = {{"wall", fmt::format("{} - x", 1 + c), "y = '-y'", "wall"}};
    const Model model = parts.model();
    BranchSettings settings = in_parameter(model, "p", -0.1, 0.5);
    TorusBranch branch(System(model), torus_point(model, settings), settings);
    const std::vector<TorusPoint> points = all_of(branch);
    EXPECT_EQ(branch.outcome(), TorusOutcome::unphysical);
    EXPECT_THAT(branch.detail(), HasSubstr("the torus grazes"));
    EXPECT_THAT(branch.detail(), HasSubstr("wall"));
    ASSERT_FALSE(points.empty());
    EXPECT_TRUE(points.back().facts.admissible);
    EXPECT_NEAR(points.back().parameter, c * c, 1e-7);
}

/// The same about x = 0.3 cos(theta), y = 0.3 sin(theta), with sections at several phases of the force: where the
/// section lies at the farthest point, the motions that touch begin or end there.
TEST(TorusBranch, ExtremesDoNotDependOnTheSection) {
    constexpr double c = 0.3;
    for (const double phase : {0.0, 1e-3, 3.0})
        for (const double wall : {0.5, 0.9}) {
            const Model model = OneMode{.parameters = "p = -0.2",
                                        .states = "x = 0.1\ny = 0.05",
                                        .definitions = "u = 'x - 0.3*cos(theta)'\nv = 'y - 0.3*sin(theta)'",
                                        .rates = "x = 'p*u - (1.3 + 0.4*(u^2 + v^2))*v - u*(u^2 + v^2) - "
                                                 "0.3*sin(theta)', y = 'p*v + (1.3 + 0.4*(u^2 + v^2))*u - "
                                                 "v*(u^2 + v^2) + 0.3*cos(theta)'",
                                        .clock = "1",
                                        .stops = {{"wall", fmt::format("{} - x", wall), "y = '-y'", "wall"}},
                                        .more = at_phase(phase)}
                                    .model();
            BranchSettings settings = in_parameter(model, "p", -0.5, 1);
            const SpecialPoint point = torus_point(model, settings);
            settings.monitors = {extreme(model, "x", Monitor::Kind::maximum),
                                 extreme(model, "y", Monitor::Kind::minimum)};
            TorusBranch branch(System(model), point, settings);
            const std::vector<TorusPoint> points = all_of(branch);
            EXPECT_EQ(branch.outcome(), TorusOutcome::unphysical) << branch.detail();
            ASSERT_GT(points.size(), 5U);
            EXPECT_NEAR(points.back().parameter, (wall - c) * (wall - c), 1e-8) << phase << ' ' << wall;
            for (const TorusPoint& one : points) {
                const double farthest = c + std::sqrt(one.parameter);
                EXPECT_NEAR(one.monitors[0], farthest, 1e-10) << phase << ' ' << one.parameter;
                EXPECT_NEAR(one.monitors[1], -farthest, 1e-10) << phase << ' ' << one.parameter;
            }
        }
}

/// A ball that bounces every two units of time, during which (x, y) turns by `turn` about 0. The bounce turns it back,
/// and puts its distance z from (0.4, 0) to z (1 + p - |z|^2) exp(i beta): circles |z|^2 = p. A wall at the angle
/// `angle` is first touched by sqrt(p) + 0.4 cos(the least angle between it and those from 0 to `turn`): at the start
/// or the end of the flight, or within it.
Model turning_flight(double turn, double angle, double wall) {
    constexpr double beta = 1.1;
    return OneMode{
        .parameters = fmt::format("p = -0.05\nturn = {}\nangle = {}\nwall = {}\nbeta = {}", turn, angle, wall, beta),
        .states = "h = 0\ns = 1\nx = 0.41\ny = 0.02",
        .definitions = "u = 'x*cos(turn) + y*sin(turn) - 0.4'\nv = 'y*cos(turn) - x*sin(turn)'\n"
                       "f = '1 + p - u^2 - v^2'",
        .rates = "h = 's', s = '-1', x = '-turn/2*y', y = 'turn/2*x'",
        .stops = {{"floor", "h",
                   "s = '1'\nx = '0.4 + f*(u*cos(beta) - v*sin(beta))'\ny = 'f*(u*sin(beta) + v*cos(beta))'", "floor"},
                  {"wall", "wall - x*cos(angle) - y*sin(angle)", "y = '-y'", "wall"}}}
        .model();
}

TEST(TorusBranch, GrazesAtTheStartAndTheEndOfFlightsToo) {
    constexpr double turn = 0.9, wall = 0.6;
    for (const double angle : {-0.4, 0.0, 0.4, 0.91, 1.4}) {
        const Model model = turning_flight(turn, angle, wall);
        const BranchSettings settings = in_parameter(model, "p", -0.1, 0.3);
        const Branch orbits =
            follow_branch(System(model), given_orbit(model, "floor", {{0, 1, 0.4, 0}}, {2}), settings);
        const auto found = of_type(orbits, PointType::torus);
        ASSERT_EQ(found.size(), 1U) << names(orbits);
        TorusBranch branch(System(model), found[0], settings);
        const std::vector<TorusPoint> points = all_of(branch);
        EXPECT_EQ(branch.outcome(), TorusOutcome::unphysical) << branch.detail();
        EXPECT_THAT(branch.detail(), HasSubstr("wall"));
        ASSERT_FALSE(points.empty());
        const double aside = angle < 0 ? -angle : std::max(angle - turn, 0.0), radius = wall - 0.4 * std::cos(aside);
        EXPECT_NEAR(points.back().parameter, radius * radius, 1e-7) << angle;
    }
}

/// (x, y) turns about a cycle that is its own image after half a period: z' = (p + i (0.3 + 0.1 |z|^2)) z - z |z|^2.
TEST(TorusBranch, OfASymmetricOrbitIsThatOfItsWholeReturn) {
    for (const std::string& symmetry :
         {std::string(), std::string("[symmetries.turned]\nmap = { u = '-u', v = '-v', x = '-x', y = '-y' }")}) {
        const Model model =
            OneMode{.parameters = "p = -0.2",
                    .states = "u = 1\nv = 0.1\nx = 1.1\ny = 0.1",
                    .definitions = "c = '1 - u^2 - v^2'\na = 'x - u'\nb = 'y - v'\nr = 'a^2 + b^2'",
                    .rates = "u = '-v + u*c', v = 'u + v*c', x = '-v + u*c + p*a - (0.3 + 0.1*r)*b - a*r', "
                             "y = 'u + v*c + p*b + (0.3 + 0.1*r)*a - b*r'",
                    .more = section("start", "v") + symmetry}
                .model();
        BranchSettings settings = in_parameter(model, "p", -0.5, 0.6);
        const SpecialPoint point = torus_point(model, settings);
        EXPECT_EQ(point.solution.orbit.symmetry.has_value(), !symmetry.empty());
        settings.monitors = {extreme(model, "x", Monitor::Kind::maximum)};
        TorusBranch branch(System(model), point, settings);
        const std::vector<TorusPoint> points = all_of(branch);
        EXPECT_EQ(branch.outcome(), TorusOutcome::bound) << branch.detail();
        ASSERT_GT(points.size(), 5U);
        for (const TorusPoint& one : points) {
            const double p = one.parameter;
            EXPECT_NEAR(one.torus.rotation, 0.3 + 0.1 * p, 1e-10) << p << symmetry;
            EXPECT_NEAR(one.facts.growth, std::exp(-4 * pi * p), 1e-9) << p << symmetry;
            EXPECT_NEAR(one.motion.period(), 2 * pi, 1e-9);
            EXPECT_NEAR(one.monitors[0], 1 + std::sqrt(p), 1e-9);
        }
    }
}

/// States that are zero on the orbit have no extent there: their unit is that of the nonlinear terms, whatever it is.
TEST(TorusBranch, OfAStateThatRestsHaveTheSizeOfTheirNonlinearTerms) {
    for (const double unit : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
        const Model model = OneMode{.parameters = fmt::format("p = -0.1\nunit = {}", unit),
                                    .states = "x = 0\ny = 0\nq = 0.5",
                                    .definitions = "r = '(x/unit)^2 + (y/unit)^2'",
                                    .rates = "x = 'p*x - 0.3*y - (x - 0.7*y)*r', y = '0.3*x + p*y - (y + 0.7*x)*r', "
                                             "q = 'cos(theta) - q'",
                                    .clock = "1"}
                                .model();
        BranchSettings settings = in_parameter(model, "p", -0.1, 0.2);
        const SpecialPoint point = torus_point(model, settings);
        settings.monitors = {extreme(model, "x", Monitor::Kind::maximum)};
        TorusBranch branch(System(model), point, settings);
        const std::vector<TorusPoint> points = all_of(branch);
        ASSERT_EQ(branch.outcome(), TorusOutcome::bound) << unit << branch.detail();
        EXPECT_LT(points.size(), 60U);
        for (const TorusPoint& one : points) {
            const double p = one.parameter;
            EXPECT_NEAR(one.torus.rotation, 0.3 - 0.7 * p, 1e-10) << unit << ' ' << p;
            EXPECT_NEAR(one.facts.growth, std::exp(-4 * pi * p), 1e-9) << unit << ' ' << p;
            EXPECT_NEAR(one.monitors[0], unit * std::sqrt(p), 1e-9 * unit) << unit << ' ' << p;
        }
    }
}

/// The delayed logistic map (x, y) -> (a x (1 - y), x), whose fixed point 1 - 1/a has a torus point at a = 2 with the
/// multipliers exp(+-i pi/3), against its own iteration.
TEST(TorusBranch, DelayedLogisticMapTurnsAsItsIteration) {
    const Model model = map_model("a = 1.9", {"a*x*(1 - y)", "x"});
    BranchSettings settings = in_parameter(model, "a", 1.8, 2.1);
    const Branch orbits = follow_branch(System(model), fixed_point(model, {1 - 1 / 1.9, 1 - 1 / 1.9}), settings);
    const auto found = of_type(orbits, PointType::torus);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].parameter, 2, 1e-9);
    TorusBranch branch(System(model), found[0], settings);
    const std::vector<TorusPoint> points = all_of(branch);
    EXPECT_EQ(branch.outcome(), TorusOutcome::bound) << branch.detail();
    ASSERT_GT(points.size(), 4U);
    for (const TorusPoint& one : points) {
        const double a = one.parameter, centre = 1 - 1 / a;
        const std::vector<double> start = one.torus.state_at(0.3);
        double x = start[0], y = start[1];
        constexpr std::size_t returns = 20000;
        const double rotation = rotation_number(
            [&] {
                const std::pair before(x - centre, y - centre);
                const double next = a * x * (1 - y);
                y = x;
                x = next;
                return before;
            },
            returns);
        // The angle may be counted in the other sense than that of the circle. The mean converges slowly near the
        // resonance 1/6, from which the branch begins.
        if (one.torus.rotation > 0.1664)
            continue;
        EXPECT_NEAR(std::min(rotation, 1 - rotation), one.torus.rotation, 1e-10) << a;
        const std::vector<double> after = one.torus.state_at(0.3 + (returns + 1) * one.torus.rotation);
        EXPECT_NEAR(x, after[0], 1e-6) << a;
        EXPECT_NEAR(y, after[1], 1e-6) << a;
        EXPECT_LT(one.facts.growth, 1);
        EXPECT_LT(one.facts.defect, 1e-7);
    }
    EXPECT_GT(points.back().torus.harmonics(), 5U);
}

/// Without force the torus of a van der Pol oscillator is its limit cycle, which the clock meets at any time.
TEST(TorusBranch, VanDerPolComesToItsFreeOscillation) {
    const std::string acceleration = "0.3*(1 - x^2)*v - x + F*cos(theta)";
    const Model model = driven("F = 2\nomega = 1.2", acceleration, "omega");
    BranchSettings settings = in_parameter(model, "F", 0, 2, -1);
    settings.continuation.largest_step = 0.3;
    TorusBranch branch(System(model), torus_point(model, settings), settings);
    const std::vector<TorusPoint> points = all_of(branch);
    ASSERT_EQ(branch.outcome(), TorusOutcome::bound) << branch.detail();
    const TorusPoint& last = points.back();
    EXPECT_NEAR(last.parameter, 0, 1e-12);
    const Model free =
        OneMode{.states = "x = 2\nv = 0", .rates = "x = 'v', v = '0.3*(1 - x^2)*v - x'", .more = section("rising", "x")}
            .model();
    const OrbitSolution cycle = settled(free, "rising");
    const double turns = 2 * pi / 1.2 / cycle.orbit.period();
    EXPECT_NEAR(last.torus.rotation, 1 - turns, 1e-9);
    EXPECT_NEAR(std::log(last.facts.growth), turns * std::log(std::abs(cycle.multipliers[0])), 1e-8);
}

/// Two masses on springs, of which a force moves the first against a stop: one impact per period, whose torus point
/// has the rotation number 0.226.
Model impacting_masses() {
    return OneMode{.parameters = "d = -1.51",
                   .states = "x = -1.51\ny = -2.2\nv = -1.26\nw = 0.1",
                   .rates = "x = 'v', y = 'w', v = 'cos(theta) - 0.6*x - 0.06*v - 0.62*(x - y) - 0.18*(v - w)', "
                            "w = '(0.62*(x - y) + 0.18*(v - w))/1.19'",
                   .clock = "2.87",
                   .stops = {{"stop", "d - x", "v = '-0.8*v'", "impact"}}}
        .model();
}

/// Against a long simulation: it stays on the circle, and turns as it does.
TEST(TorusBranch, ToriOfImpactingMassesAreThoseOfTheirSimulation) {
    const Model model = impacting_masses();
    const BranchSettings settings = in_parameter(model, "d", -1.56, -1.4);
    Model start = model;
    start.set_parameter("d", -1.52);
    const Orbit candidate = given_orbit(start, "impact", {{-1.52, -2.2, -1.26, 0.1, 2.12}}, {2 * pi / 2.87});
    const Branch orbits = follow_branch(System(model), candidate, settings);
    const auto found = of_type(orbits, PointType::torus);
    ASSERT_FALSE(found.empty()) << names(orbits) << orbits.detail;
    BranchSettings of_tori = settings;
    of_tori.steps = 25;
    TorusBranch branch(System(model), found[0], of_tori);
    const std::vector<TorusPoint> points = all_of(branch);
    ASSERT_GT(points.size(), 8U) << branch.detail();
    const Simulation simulation(System(model), {}, {}, {.tolerance = 1e-14});
    for (std::size_t k = 4; k < points.size(); k += 5) {
        const TorusPoint& one = points[k];
        ASSERT_TRUE(one.stable);
        constexpr double returns = 1500;
        const FollowedMotion motion =
            follow_motion(simulation, one.torus.parameters, one.torus.state_at(0), 0, returns * 2 * pi / 2.87);
        ASSERT_EQ(motion.problem, "");
        ASSERT_GT(motion.starts.size(), returns - 10);
        for (std::size_t n = 0; n + 1 < motion.starts.size(); n += 50) {
            const std::vector<double> wanted = one.torus.state_at(static_cast<double>(n) * one.torus.rotation);
            for (std::size_t i = 0; i < 4; ++i)
                EXPECT_NEAR(motion.starts[n][i], wanted[i], 1e-6) << n << ' ' << i;
        }
        std::size_t next = 0;
        const double rotation = rotation_number(
            [&] {
                const std::vector<double>& state = motion.starts[next++];
                return std::pair(state[1] - one.torus.terms[0][1], state[2] - one.torus.terms[0][2]);
            },
            motion.starts.size() - 3);
        EXPECT_NEAR(std::min(rotation, 1 - rotation), one.torus.rotation, 1e-8) << one.parameter;
    }
}

TEST(TorusBranch, EndsWhereMoreHarmonicsAreNeededThanAllowed) {
    const Model model = map_model("a = 1.9", {"a*x*(1 - y)", "x"});
    BranchSettings settings = in_parameter(model, "a", 1.8, 2.4);
    const Branch orbits = follow_branch(System(model), fixed_point(model, {1 - 1 / 1.9, 1 - 1 / 1.9}), settings);
    TorusBranch branch(System(model), of_type(orbits, PointType::torus).at(0), settings, {.harmonics = 12});
    const std::vector<TorusPoint> points = all_of(branch);
    EXPECT_EQ(branch.outcome(), TorusOutcome::not_resolved) << branch.detail();
    EXPECT_THAT(branch.detail(), HasSubstr("more than 12 harmonics"));
    ASSERT_GT(points.size(), 2U);
    EXPECT_LT(points.back().facts.tail, 1e-9);
    EXPECT_LT(points.back().parameter, 2.3);
}

TEST(TorusBranch, RefusesOtherPointsAndNumbers) {
    const Model model = normal_form(0.3, 0.7).model();
    BranchSettings settings = in_parameter(model, "p", -0.1, 0.2);
    SpecialPoint point = torus_point(model, settings);
    const auto refused = [&](const char* words, const TorusResolution& resolution = {}) {
        EXPECT_THAT(message_of([&] { TorusBranch(System(model), point, settings, resolution); }), HasSubstr(words));
    };
    refused("2 harmonics are out of range", {.harmonics = 2});
    refused("the tail", {.tail = 0.5});
    settings.least = 0.05;
    refused("outside the bounds");
    settings.least = -0.1;
    settings.monitors = {extreme(model, "x", Monitor::Kind::mean)};
    refused("no single value on a torus");
    settings.monitors.clear();
    point.type = PointType::flip;
    refused("no tori begin at a point of type PD");
    point.type = PointType::torus;
    point.solution.orbit.parameters[model.independent_parameter("p").place()] = -0.05;
    refused("no complex pair of multipliers on the unit circle");
}

TEST(TorusBranch, RefusesMotionsOfWhichOnlyDistancesReturn) {
    const Model model = shipped_with("spring-walker", {});
    const auto found = orbit_with_signature(System(model), parse_signature(model, "touchdown takeoff"));
    ASSERT_TRUE(found);
    SpecialPoint point;
    point.type = PointType::torus;
    point.solution = *found;
    EXPECT_THAT(message_of([&] { TorusBranch(System(model), point, in_parameter(model, "k", 10000, 18000)); }),
                HasSubstr("only its distance from other states"));
}

TEST(TorusBranch, AskedBeforeItsStartHasNoTorus) {
    const Model model = normal_form(0.3, 0.7).model();
    const BranchSettings settings = in_parameter(model, "p", -0.1, 0.2);
    TorusBranch branch(System(model), torus_point(model, settings), settings);
    EXPECT_FALSE(branch.step());
    EXPECT_EQ(branch.outcome(), TorusOutcome::no_start);
}

} // namespace graze::torus_branch_test
