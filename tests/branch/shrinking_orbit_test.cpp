// Branches of free oscillations that shrink to an equilibrium end there: at values known from normal forms, the
// Routh-Hurwitz criterion or scaling.

#include "follow.hpp"
#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::shrinking_orbit_test {

using namespace graze::testing;
using std::numbers::pi;

/// r' = r (mu - c r^2 - d r^4) about (mu a, 0), theta' = 1.3 + 0.2 mu + 0.5 r^2.
Model normal_form(double c, double d, double mu, double radius, double a = 0) {
    return OneMode{.parameters = fmt::format("mu = {:.17g}", mu),
                   .states = fmt::format("x = {:.17g}\ny = 0", radius + mu * a),
                   .definitions = fmt::format("u = 'x - mu*{}'\ns = 'u^2 + y^2'\ngrowth = 'mu - {}*s - {}*s^2'\n"
                                              "turn = '1.3 + 0.2*mu + 0.5*s'",
                                              a, c, d),
                   .rates = "x = 'growth*u - turn*y', y = 'turn*u + growth*y'",
                   .more = section("right", "y")}
        .model();
}

Orbit circle(const Model& model, double mu, double radius, double a = 0) {
    return given_orbit(model, "right", {{radius + mu * a, 0}}, {2 * pi / (1.3 + 0.2 * mu + 0.5 * radius * radius)});
}

Branch down_from(const Model& model, const Orbit& orbit, const std::string& parameter, double least, double greatest,
                 double largest_step = 0.05) {
    BranchSettings settings = in_parameter(model, parameter, least, greatest, -1);
    settings.continuation.largest_step = largest_step;
    return follow_branch(System(model), orbit, settings);
}

void expect_hopf(const Branch& branch, const Model& model, double parameter, double period) {
    EXPECT_EQ(branch.outcome, BranchOutcome::shrunk) << name_of(branch.outcome) << branch.detail;
    ASSERT_FALSE(branch.special.empty());
    const SpecialPoint& end = branch.special.back();
    EXPECT_EQ(end.type, PointType::hopf);
    EXPECT_NEAR(end.parameter, parameter, 1e-10 * (1 + std::abs(parameter)));
    EXPECT_NEAR(end.solution.orbit.period(), period, 1e-8 * period);
    // The error estimate holds.
    ASSERT_TRUE(end.solution.error);
    const std::string detail = end.detail;
    const double error = std::stod(detail.substr(detail.find("+-") + 3));
    EXPECT_LE(std::abs(end.parameter - parameter), error) << detail;
    EXPECT_LT(error, 1e-9 * (1 + std::abs(parameter))) << detail;
    EXPECT_EQ(branch.points.back().parameter, end.parameter);
    EXPECT_EQ(end.solution.orbit.parameters[model.independent_parameter("mu").place()], end.parameter);
}

TEST(ShrinkingOrbit, EndsAtTheHopfPointOfANormalForm) {
    for (const double a : {0.0, 3.0})
        for (const double largest : {0.05, 0.4, 0.013}) {
            const Model model = normal_form(1, 0, 0.25, 0.5, a);
            const Branch branch = down_from(model, circle(model, 0.25, 0.5, a), "mu", -1, 1, largest);
            EXPECT_EQ(names(branch), "HB");
            expect_hopf(branch, model, 0, 2 * pi / 1.3);
            for (std::size_t k = 0; k + 1 < branch.points.size(); ++k) {
                const BranchPoint& point = branch.points[k];
                const double u = point.solution.orbit.starts[0][0] - a * point.parameter;
                EXPECT_GT(u, 0); // no part is followed twice
                EXPECT_NEAR(u * u, point.parameter, 1e-9);
                // The multiplier is exp(-2 mu T), which counts as 1 from 1 - 1e-8 on: up to mu = 1e-9.
                EXPECT_TRUE(point.stable || point.parameter < 2e-9);
            }
        }
}

TEST(ShrinkingOrbit, FoldBeforeTheHopfPointIsFound) {
    // mu = -c r^2 + r^4 has a fold at r^2 = c/2.
    for (const double c : {1.0, 0.1, 0.01}) {
        const double radius = std::sqrt(2 * c), mu = -c * radius * radius + std::pow(radius, 4);
        const Model model = normal_form(-c, 1, mu, radius);
        const Branch branch = down_from(model, circle(model, mu, radius), "mu", -10, 10);
        ASSERT_EQ(names(branch), "SN HB") << c;
        EXPECT_NEAR(branch.special[0].parameter, -c * c / 4, 1e-10);
        expect_hopf(branch, model, 0, 2 * pi / 1.3);
    }
}

TEST(ShrinkingOrbit, EndsWhereTheRouthHurwitzCriterionPredicts) {
    // A relief valve (C. Hos and A. R. Champneys, Physica D 241, 2012) has a Hopf point where (k + g)(k g + 1) = g + h.
    constexpr double k = 1.25, beta = 20, delta = 10;
    const auto lack = [](double y) {
        const double root = std::sqrt(y + delta), g = beta * y / (2 * root), h = beta * root;
        return (k + g) * (k * g + 1) - g - h;
    };
    double low = 0.1, high = 10;
    for (int i = 0; i < 200; ++i)
        (lack(0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
    const double flow = low * std::sqrt(low + delta), g = beta * low / (2 * std::sqrt(low + delta));
    const Model model = OneMode{.parameters = "mu = 8",
                                .states = "y1 = 2.4\ny2 = 0\ny3 = 13",
                                .rates = "y1 = 'y2', y2 = '-1.25*y2 - (y1 + 10) + y3', y3 = '20*(mu - y1*sqrt(y3))'",
                                .stops = {{"seat", "y1", "y2 = '-0.8*y2'"}},
                                .more = section("highest", "y2", "falling")}
                            .model();
    BranchSettings settings = in_parameter(model, "mu", 1, 20);
    const Branch branch = follow_branch(System(model), settled(model, "highest").orbit, settings);
    EXPECT_EQ(names(branch), "HB");
    EXPECT_NEAR(flow, 8.491118, 5e-7);
    expect_hopf(branch, model, flow, 2 * pi / std::sqrt(k * g + 1));
}

TEST(ShrinkingOrbit, OrbitsProportionalToTheParameterEndOnASurface) {
    // Growing about x = mu on the right of x = 0 and decaying on its left, all in proportion to mu.
    const Model model = TwoModes{.parameters = "mu = 1",
                                 .states = "x = 1\nv = 1",
                                 .first = {"right", "x = 'v', v = 'mu - x + 0.2*v'", "leave_right", "x"},
                                 .second = {"left", "x = 'v', v = 'mu - x - 0.6*v'", "leave_left", "-x"},
                                 .more = section("rightmost", "v", "falling")}
                            .model();
    const OrbitSolution first = settled(model, "rightmost");
    const Branch branch = down_from(model, first.orbit, "mu", -1, 2);
    EXPECT_EQ(names(branch), "HB");
    expect_hopf(branch, model, 0, first.orbit.period());
    EXPECT_NE(branch.special.back().detail.find("on the surface of event"), std::string::npos);
}

TEST(ShrinkingOrbit, BranchWithAClockDoesNotEnd) {
    // A force p cos(theta) on a linear oscillator: at p = 0 only the clock moves, and the branch continues through.
    const Model model = driven("mu = 0.5", "mu*cos(theta) - 0.4*v - 4*x");
    const Branch branch = down_from(model, settled(model, "start").orbit, "mu", -0.5, 1);
    EXPECT_EQ(names(branch), "BD");
    EXPECT_EQ(branch.outcome, BranchOutcome::bound);
}

} // namespace graze::shrinking_orbit_test
