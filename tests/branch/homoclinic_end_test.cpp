// Branches of growing period end at homoclinic orbits, and curves of these: models whose homoclinic orbits are known in
// closed form, and a published value.

#include "follow.hpp"

#include "graze/model/named_value.hpp"
#include "orbit/solve_homoclinic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <string>

namespace graze::homoclinic_end_test {

using namespace graze::testing;

/// Returns the homoclinic orbit in which a branch ends, and checks that it ends there and what it says.
SpecialPoint end_of(const Branch& branch) {
    EXPECT_EQ(branch.outcome, BranchOutcome::homoclinic) << name_of(branch.outcome) << ' ' << branch.detail;
    if (branch.special.empty() || branch.special.back().type != PointType::homoclinic) {
        ADD_FAILURE() << names(branch);
        return {};
    }
    const SpecialPoint& end = branch.special.back();
    EXPECT_TRUE(is_homoclinic(end.solution.orbit.signature));
    EXPECT_TRUE(end.solution.certificate.admissible) << end.solution.certificate.reason;
    EXPECT_TRUE(end.solution.multipliers.empty());
    EXPECT_EQ(branch.points.back().parameter, end.parameter);
    EXPECT_FALSE(branch.points.back().stable);
    return end;
}

/// Checks the parameter against its exact value, and that the error that is told holds.
/// @param largest_told error, in units of the tolerance
void expect_value(const SpecialPoint& end, double exact, double tolerance, double largest_told = 10) {
    EXPECT_NEAR(end.parameter, exact, tolerance) << end.detail;
    const auto at = end.detail.find("+- ");
    ASSERT_NE(at, std::string::npos) << end.detail;
    const double error = std::stod(end.detail.substr(at + 3));
    EXPECT_LE(std::abs(end.parameter - exact), error) << end.detail;
    EXPECT_LE(error, largest_told * tolerance) << end.detail;
}

/// x'' + 2 d x' = x with a wall at x = 1 that returns e times the speed. The lines x' = l x with l^2 + 2 d l = 1 lead
/// from the saddle to the wall and back: a homoclinic orbit where e times the positive l is minus the negative one.
Model saddle_and_wall(double damping, double restitution) {
    return OneMode{.parameters = fmt::format("d = {:.17g}\ne = {:.17g}", damping, restitution),
                   .states = "x = 1\nv = -0.5",
                   .rates = "x = 'v', v = 'x - 2*d*v'",
                   .stops = {{"wall", "1 - x", "v = '-e*v'", "impact"}}}
        .model();
}

double exact_restitution(double damping) {
    const double root = std::sqrt(1 + damping * damping);
    return (root + damping) / (root - damping);
}

/// The motion with one impact every T units of time, from the closed form x = a exp(l T) + b exp(m T).
struct ImpactEvery {
    ImpactEvery(double damping, double period) {
        const double root = std::sqrt(1 + damping * damping), l = root - damping, m = -root - damping,
                     far = std::exp(l * period), near = std::exp(m * period);
        const double leaving = (l * near - m * far - (l - m)) / (far - near), // after the impact
            a = (-leaving - m) / (l - m), b = (leaving + l) / (l - m);
        speed = leaving;
        restitution = leaving / (a * l * far + b * m * near);
    }
    double speed = 0, restitution = 0;
};

Branch branch_at_wall(double damping) {
    constexpr double period = 3;
    const ImpactEvery first(damping, period);
    const Model model = saddle_and_wall(damping, first.restitution);
    const int direction = exact_restitution(damping) > first.restitution ? 1 : -1;
    return follow_branch(System(model), given_orbit(model, "impact", {{1, -first.speed}}, {period}),
                         in_parameter(model, "e", 0.01, 100, direction));
}

TEST(HomoclinicEnd, OrbitsThatHitAWallBecomeHomoclinicToALinearSaddle) {
    for (const double damping : {0.3, -0.3, 1.2, 0.01}) {
        const Branch branch = branch_at_wall(damping);
        EXPECT_EQ(names(branch), "HC") << damping << branch.detail;
        const SpecialPoint end = end_of(branch);
        const double exact = exact_restitution(damping), root = std::sqrt(1 + damping * damping);
        expect_value(end, exact, 1e-12 * exact);
        const Orbit& orbit = end.solution.orbit;
        ASSERT_EQ(orbit.segments(), 2U);
        EXPECT_EQ(to_string(saddle_and_wall(damping, 1), orbit.signature), "impact saddle");
        // It hits the wall on the one line and leaves it on the other.
        EXPECT_NEAR(orbit.starts[0][1], (root - damping) * orbit.starts[0][0], 1e-12);
        EXPECT_NEAR(orbit.starts[1][1], -root - damping, 1e-11);
        ASSERT_EQ(end.solution.eigenvalues.size(), 2U);
        EXPECT_NEAR(end.solution.eigenvalues[0].real(), root - damping, 1e-12);
        EXPECT_NEAR(end.solution.eigenvalues[1].real(), -root - damping, 1e-12);
        EXPECT_NE(end.detail.find(fmt::format("saddle quantity {:.6g}", -2 * damping)), std::string::npos)
            << end.detail;
    }
}

TEST(HomoclinicEnd, CurveAtAWallIsThatOfTheClosedForm) {
    const SpecialPoint end = end_of(branch_at_wall(0.3));
    const Model model = saddle_and_wall(0.3, 1);
    for (const int direction : {1, -1}) {
        const Branch curve =
            curve_of(model, end, in_parameter(model, "d", -1, 2), "e", std::nullopt, std::nullopt, direction);
        EXPECT_EQ(names(curve), "BD") << curve.detail;
        EXPECT_EQ(curve.outcome, BranchOutcome::bound);
        EXPECT_GT(curve.points.size(), 5U);
        for (const BranchPoint& point : curve.points) {
            const double d = value_of(model, point.solution, "d"), e = value_of(model, point.solution, "e");
            EXPECT_NEAR(e, exact_restitution(d), 1e-11 * exact_restitution(d)) << d;
            EXPECT_TRUE(point.solution.certificate.admissible);
            ASSERT_EQ(point.solution.eigenvalues.size(), 2U);
            EXPECT_NEAR(point.solution.eigenvalues[0].real(), std::sqrt(1 + d * d) - d, 1e-11);
        }
        EXPECT_NEAR(curve.points.back().parameter, direction > 0 ? 2 : -1, 1e-12);
    }
}

/// B. Sandstede's planar system (A. R. Champneys and Yu. A. Kuznetsov, Int. J. Bifurcation and Chaos 4, 1994): for m =
/// 0 the curve x^2 (1 - x) = y^2 is a homoclinic orbit to the saddle 0 with the eigenvalues a + b and a - b, whatever
/// they are.
Model cubic_loop(double a, double b, double m) {
    return OneMode{.parameters = fmt::format("a = {:.17g}\nb = {:.17g}\nm = {:.17g}", a, b, m),
                   .states = "x = 0.9\ny = 0",
                   .rates = "x = 'a*x + b*y - a*x^2 + m*x*(2 - 3*x)', y = 'b*x + a*y - 1.5*b*x^2 - 1.5*a*x*y - 2*m*y'",
                   .more = section("s", "y")}
        .model();
}

TEST(HomoclinicEnd, CubicLoopIsExactForAllEigenvalues) {
    for (const auto& [a, m] : {std::pair(-0.4, 0.02), {-0.7, 0.03}, {-0.1, 0.004}}) {
        // Inside the loop there is a stable orbit between m = 0 and the Hopf point at -a/12.
        const Model model = cubic_loop(a, 1, m);
        const Branch branch =
            follow_branch(System(model), settled(model, "s").orbit, in_parameter(model, "m", -1, 1, m > 0 ? -1 : 1));
        // The error that is told is that at twice the distances, which for a = -0.7 is 2^7.7 times larger.
        expect_value(end_of(branch), 0, 3e-12, 200);
    }
}

TEST(HomoclinicEnd, CurveOfTheCubicLoopStaysWhereItIs) {
    const Model model = cubic_loop(-0.4, 1, 0.02);
    const Branch branch = follow_branch(System(model), settled(model, "s").orbit, in_parameter(model, "m", -1, 1, -1));
    const SpecialPoint end = end_of(branch);
    for (const int direction : {1, -1}) {
        const Branch curve =
            curve_of(model, end, in_parameter(model, "a", -0.8, 0.8), "m", std::nullopt, std::nullopt, direction);
        EXPECT_EQ(names(curve), "BD") << curve.detail;
        EXPECT_NEAR(curve.points.back().parameter, 0.8 * direction, 1e-12);
        for (const BranchPoint& point : curve.points) {
            EXPECT_NEAR(value_of(model, point.solution, "m"), 0, 1e-10) << point.parameter;
            ASSERT_EQ(point.solution.eigenvalues.size(), 2U);
            EXPECT_NEAR(point.solution.eigenvalues[0].real(), 1 + point.parameter, 1e-9);
        }
    }
}

TEST(HomoclinicEnd, CurveFindsWhereTheLoopTouchesAWall) {
    // The loop y^2 = x^2 (1 - x) is highest at x = 2/3.
    const auto below_wall = [](double wall) {
        return OneMode{.parameters = fmt::format("m = 0.02\nwall = {:.17g}", wall),
                       .states = "x = 0.9\ny = 0",
                       .rates = "x = '-0.4*x + y + 0.4*x^2 + m*x*(2 - 3*x)', "
                                "y = 'x - 0.4*y - 1.5*x^2 + 0.6*x*y - 2*m*y'",
                       .stops = {{"ceiling", "wall - y", "y = '-y'", "impact"}},
                       .more = section("s", "y")}
            .model();
    };
    const Model model = below_wall(0.6);
    const SpecialPoint end =
        end_of(follow_branch(System(model), settled(model, "s").orbit, in_parameter(model, "m", -1, 1, -1)));
    const Branch curve = curve_of(model, end, in_parameter(model, "wall", 0.1, 1), "m", std::nullopt, std::nullopt, -1);
    EXPECT_EQ(names(curve), "GR") << curve.detail;
    EXPECT_EQ(curve.outcome, BranchOutcome::unphysical);
    ASSERT_FALSE(curve.special.empty());
    EXPECT_NEAR(curve.special[0].parameter, std::sqrt(4.0 / 27), 1e-10);
}

/// x'' = x - x^3 - v (h + m) with the energy h of the oscillator without friction: the loops x = sqrt(2) sech(t) and
/// their images stay for m = 0. Outside of them there is a stable orbit for m < 0, with a symmetry, inside one for m >
/// 0.
Model figure_eight(double m, double x) {
    return OneMode{.parameters = fmt::format("m = {:.17g}", m),
                   .states = fmt::format("x = {:.17g}\nv = 0", x),
                   .definitions = "h = 'v^2/2 - x^2/2 + x^4/4'",
                   .rates = "x = 'v', v = 'x - x^3 - v*(h + m)'",
                   .more = section("s", "v", "falling") + "[symmetries.turn]\nmap = { x = '-x', v = '-v' }\n"}
        .model();
}

TEST(HomoclinicEnd, OrbitsInsideAndOutsideTheFigureEightBecomeItsLoops) {
    for (const auto& [m, x] : {std::pair(0.1, 1.2), {-0.1, 1.5}}) {
        const Model model = figure_eight(m, x);
        const Branch branch =
            follow_branch(System(model), settled(model, "s").orbit, in_parameter(model, "m", -1, 1, m > 0 ? -1 : 1));
        const SpecialPoint end = end_of(branch);
        expect_value(end, 0, 1e-11);
        EXPECT_FALSE(end.solution.orbit.symmetry);
        // From a small x at its beginning to one at its end, sqrt(2) sech(t) takes log(8 / x^2).
        const double begin = std::abs(end.solution.orbit.starts[0][0]);
        EXPECT_NEAR(begin, std::abs(end.solution.orbit.starts[0][1]), 1e-8 * begin);
        EXPECT_NEAR(end.solution.orbit.return_time(), std::log(8 / (begin * begin)), 1e-4);
    }
}

/// A pendulum with friction as above: it turns over from one upper position to the next for m = 0, and for m < 0 all
/// the time.
TEST(HomoclinicEnd, PendulumTurnsOverFromItsUpperPositionToTheNext) {
    const Model model = OneMode{.parameters = "m = -0.1",
                                .states = "q = { initial = 0, period = '2*pi' }\nv = 2.1",
                                .definitions = "h = 'v^2/2 - cos(q) - 1'",
                                .rates = "q = 'v', v = '-sin(q) - v*(h + m)'",
                                .more = "[sections.below]\nstate = 'q'\nvalue = 0\n"}
                            .model();
    BranchSettings settings = in_parameter(model, "m", -1, 1, 1);
    Monitor& fastest = settings.monitors.emplace_back();
    fastest.name = "fastest";
    fastest.kind = Monitor::Kind::maximum;
    fastest.expression = named_value(model, "v", {}).value;
    const Branch branch = follow_branch(System(model), settled(model, "below").orbit, settings);
    const SpecialPoint end = end_of(branch);
    expect_value(end, 0, 1e-11);
    ASSERT_EQ(end.monitors.size(), 1U); // of the homoclinic orbit, not of the last periodic one
    EXPECT_NEAR(end.monitors[0], 2, 1e-11);
    EXPECT_NE(end.detail.find("q = 3.14159"), std::string::npos) << end.detail;
    // v = 2 cos(q/2) = 2 sech(t) takes log(16 / v^2).
    const double begin = std::abs(end.solution.orbit.starts[0][1]);
    EXPECT_NEAR(end.solution.orbit.return_time(), std::log(16 / (begin * begin)), 1e-4);
}

/// A saddle x' = l x with a decaying spiral of (y, z) and a jump at x = 1 to (m + c y, 1, 0): orbits of period T exist
/// at m = exp(-l T) - c exp(-a T) cos(w T), and at m = 0 a homoclinic one.
Model spiral(double l, double a, double w, double c, double m) {
    return OneMode{.parameters =
                       fmt::format("l = {:.17g}\na = {:.17g}\nw = {:.17g}\nc = {:.17g}\nm = {:.17g}", l, a, w, c, m),
                   .states = "x = 0.1\ny = 1\nz = 0",
                   .rates = "x = 'l*x', y = '-a*y - w*z', z = 'w*y - a*z'",
                   .stops = {{"gate", "1 - x", "x = 'm + c*y'\ny = 1\nz = 0", "back"}}}
        .model();
}

TEST(HomoclinicEnd, WindingBranchOfASaddleFocusEndsAtItsCentre) {
    // Where the spiral decays more slowly than the saddle grows, the branch has infinitely many folds on its way.
    for (const auto& [l, a] : {std::pair(1.0, 0.4), {1.0, 1.7}}) {
        const double w = 2, c = 0.1, period = 2,
                     m = std::exp(-l * period) - c * std::exp(-a * period) * std::cos(w * period);
        const Model model = spiral(l, a, w, c, m);
        const Orbit orbit = given_orbit(model, "back", {{std::exp(-l * period), 1, 0}}, {period});
        const Branch branch = follow_branch(System(model), orbit, in_parameter(model, "m", -1, 1, -1));
        const SpecialPoint end = end_of(branch);
        expect_value(end, 0, 1e-12);
        EXPECT_EQ(of_type(branch, PointType::fold).size() > 2, a < l) << names(branch);
        ASSERT_EQ(end.solution.eigenvalues.size(), 3U);
        EXPECT_LT(std::abs(end.solution.eigenvalues[1] - std::complex(-a, w)), 1e-12);
        for (const int direction : {1, -1}) {
            const Branch curve =
                curve_of(model, end, in_parameter(model, "w", 1, 3), "m", std::nullopt, std::nullopt, direction);
            EXPECT_EQ(names(curve), "BD") << curve.detail;
            for (const BranchPoint& point : curve.points)
                EXPECT_NEAR(value_of(model, point.solution, "m"), 0, 1e-12) << point.parameter;
        }
    }
}

Model lorenz(double rho) {
    return OneMode{.parameters = fmt::format("rho = {:.17g}\nsigma = 10\nbeta = '8/3'", rho),
                   .states = "x = 8\ny = 8\nz = 20",
                   .rates = "x = 'sigma*(y - x)', y = 'x*(rho - z) - y', z = 'x*y - beta*z'"}
        .model();
}

// C. Sparrow, "The Lorenz Equations", Springer 1982, and many later: orbits that begin at the Hopf points, at
// sigma (sigma + beta + 3) / (sigma - beta - 1), become homoclinic at rho = 13.926557.
TEST(HomoclinicEnd, LorenzOrbitsBecomeHomoclinicAtThePublishedValue) {
    const Model model = lorenz(20);
    const System system(model);
    const OrbitSolution rest =
        solve_orbit(system, {signature_of_rest(0), model.parameter_values(), {{7.1, 7.1, 19}}, {0.0}, {}});
    const BranchSettings up = in_parameter(model, "rho", 15, 30);
    const auto hopf = of_type(follow_branch(system, rest.orbit, up), PointType::hopf);
    ASSERT_EQ(hopf.size(), 1U);
    BranchSettings down = in_parameter(model, "rho", 5, 30, -1);
    const Branch cycles = follow(model, branches_at(system, hopf[0], down).at(0), down);
    const SpecialPoint end = end_of(cycles);
    EXPECT_NEAR(end.parameter, 13.926557, 1e-6) << end.detail;
    EXPECT_LT(end.solution.error.value_or(1), 1e-10);
    // In sigma and rho both ways.
    const Branch curve = curve_of(model, end, in_parameter(model, "sigma", 5, 15), "rho", 1, 100, 1);
    EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
}

// Yu. A. Kuznetsov, "Elements of Applied Bifurcation Theory", section 8.4: from a Bogdanov-Takens point
// the homoclinic orbits are at p = -6/25 q^2 + o(q^2).
TEST(HomoclinicEnd, CurveEndsAtTheBogdanovTakensPointAsInTheNormalForm) {
    const Model model = OneMode{.parameters = "p = -0.18\nq = -1",
                                .states = "x = -0.3\ny = 0",
                                .rates = "x = 'y', y = 'p + q*x + x^2 - x*y'",
                                .more = section("s", "y", "falling")}
                            .model();
    // The Hopf point is at p = 0, where x = 0; cycles exist for p < 0 down to the homoclinic orbit.
    const System system(model);
    const OrbitSolution rest = solve_orbit(system, {signature_of_rest(0), {-0.1, -1}, {{-0.09, 0}}, {0.0}, {}});
    const auto hopf = of_type(follow_branch(system, rest.orbit, in_parameter(model, "p", -0.2, 0.1)), PointType::hopf);
    ASSERT_EQ(hopf.size(), 1U);
    EXPECT_NEAR(hopf[0].parameter, 0, 1e-12);
    BranchSettings down = in_parameter(model, "p", -1, 1, -1);
    const SpecialPoint end = end_of(follow(model, branches_at(system, hopf[0], down).at(0), down));
    const Branch curve =
        curve_of(model, end, in_parameter(model, "q", -1.5, -0.01), "p", std::nullopt, std::nullopt, 1);
    EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
    // The next term is of the order of q^3 (with sqrt(-q) as the small parameter, its even powers).
    const BranchPoint& last = curve.points.back();
    const double q = value_of(model, last.solution, "q"), p = value_of(model, last.solution, "p");
    EXPECT_NEAR(q, -0.01, 1e-12);
    EXPECT_NEAR(p / (q * q), -0.24, 0.3 * std::abs(q));
}

TEST(HomoclinicEnd, HomoclinicOrbitsAreFollowedInTwoParametersOnly) {
    const SpecialPoint end = end_of(branch_at_wall(0.3));
    const Model model = saddle_and_wall(0.3, 1);
    EXPECT_THROW(OrbitBranch(System(model), end.solution.orbit, in_parameter(model, "e")), InputError);
    EXPECT_THROW(solve_orbit(System(model), end.solution.orbit), InputError);
    SpecialPoint wrong = end;
    wrong.type = PointType::grazing;
    EXPECT_THROW(curve_of(model, wrong, in_parameter(model, "d"), "e", std::nullopt, std::nullopt, 1), InputError);
}

} // namespace graze::homoclinic_end_test
