// Normal forms and points of codimension two: for maps against derivatives by hand, for an impacting motion against the
// opening of the bifurcating branch.

#include "follow.hpp"
#include "impact_oscillator.hpp"
#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace graze::normal_form_test {

using namespace graze::testing;
using Complex = std::complex<double>;
using std::numbers::pi;

/// Returns the number after the last `=` of a detail.
double coefficient_of(const SpecialPoint& point) {
    return std::stod(point.detail.substr(point.detail.rfind('=') + 1));
}

TEST(NormalForm, FlipOfTheLogisticMapIsSupercritical) {
    const Model model = map_model("r = 2.5", {"r*x*(1 - x)", "0.1*y"});
    const Branch branch =
        follow_branch(System(model), fixed_point(model, {0.6, 0}), in_parameter(model, "r", 1.5, 3.4));
    ASSERT_EQ(names(branch), "PD BD") << name_of(branch.outcome) << branch.detail << branch.points.size();
    EXPECT_NEAR(branch.special[0].parameter, 3, 1e-12);
    // f'' = -2 r and f''' = 0: c = (f'' / 2)^2 + f''' / 6.
    EXPECT_NE(branch.special[0].detail.find("supercritical"), std::string::npos) << branch.special[0].detail;
    EXPECT_NEAR(coefficient_of(branch.special[0]), 9, 1e-4);
}

TEST(NormalForm, CubicTermsMayMakeFlipsSubcritical) {
    // x -> -(1 + p) x + q x^2 + s x^3: c = q^2 + s.
    for (const double s : {-2.0, -0.5, 1.0}) {
        const Model model =
            map_model(fmt::format("p = -0.2\nq = 1.0\ns = {}", s), {"-(1 + p)*x + q*x^2 + s*x^3", "0.1*y"});
        const Branch branch =
            follow_branch(System(model), fixed_point(model, {0, 0}), in_parameter(model, "p", -0.5, 0.5));
        ASSERT_EQ(names(branch), "PD BD");
        EXPECT_NEAR(coefficient_of(branch.special[0]), 1 + s, 1e-5);
        EXPECT_EQ(branch.special[0].detail.starts_with("super"), 1 + s > 0) << branch.special[0].detail;
    }
}

TEST(NormalForm, CoefficientsScaleWithTheUnits) {
    // In units of length L: x -> L f(x / L), which divides the coefficient by L^2.
    for (const double length : {1e-9, 1e-3, 1e4, 1e9}) {
        const Model model = map_model(fmt::format("r = 2.5\nL = {:.17g}", length), {"r*x*(1 - x/L)", "0.1*y"});
        const Branch branch =
            follow_branch(System(model), fixed_point(model, {0.6 * length, 0}), in_parameter(model, "r", 1.5, 3.4));
        ASSERT_EQ(names(branch), "PD BD") << length;
        EXPECT_NEAR(coefficient_of(branch.special[0]) * length * length, 9, 1e-4) << length;
    }
}

TEST(NormalForm, FoldsTellOnWhichSideTwoOrbitsExist) {
    // u -> u + b p + a u^2 with u = x - 1, which drives y: the critical vector is (1, r) with r = 0.3/0.9, and w is
    // measured by its length.
    const double length = std::hypot(1, 0.3 / 0.9);
    for (const double a : {1.0, -0.7})
        for (const double b : {1.0, -2.0}) {
            const double side = a * b < 0 ? 1 : -1, start = 1 + std::sqrt(-b * side * 0.04 / a);
            const Model model = map_model(fmt::format("p = {:.17g}\na = {}\nb = {}", side * 0.04, a, b),
                                          {"x + b*p + a*(x - 1)^2", "2 + 0.1*(y - 2) + 0.3*(x - 1)"});
            BranchSettings settings = in_parameter(model, "p", -1, 1);
            settings.direction = -static_cast<int>(side);
            const Branch branch =
                follow_branch(System(model), fixed_point(model, {start, 2 + (start - 1) * 0.3 / 0.9}), settings);
            ASSERT_EQ(of_type(branch, PointType::fold).size(), 1U) << names(branch) << branch.detail;
            const SpecialPoint fold = of_type(branch, PointType::fold)[0];
            EXPECT_NEAR(coefficient_of(fold), std::abs(a) / length, 1e-5) << fold.detail;
            EXPECT_TRUE(fold.detail.starts_with(side > 0 ? "two orbits at greater p" : "two orbits at smaller p"))
                << fold.detail;
        }
}

TEST(NormalForm, CuspsHaveTheCoefficientOfTheirMap) {
    // u -> u + p + q u + s u^3 + 2 u v, v -> 0.1 v + 0.9 k u^2 with u = x - 1 and v = y - 2: on the centre manifold
    // v = k u^2 to that order, so that c = s + 2 k.
    for (const double s : {-1.0, 0.5}) {
        const Model model =
            map_model(fmt::format("p = -0.1\nq = -0.3\ns = {}\nk = 0.1", s),
                      {"x + p + q*(x - 1) + s*(x - 1)^3 + 2*(x - 1)*(y - 2)", "2 + 0.1*(y - 2) + 0.9*k*(x - 1)^2"});
        const double c = s + 0.2; // q + 3 c u^2 = 0 at the folds
        Model with = model;
        with.set_parameter("q", c < 0 ? 0.3 : -0.3);
        const double u = std::sqrt(0.1 / std::abs(c)), q = c < 0 ? 0.3 : -0.3;
        with.set_parameter("p", -(q * u + c * u * u * u) * 0.99);
        BranchSettings settings = in_parameter(with, "p", -1, 1);
        Branch branch;
        SpecialPoint fold;
        for (const int direction : {1, -1}) {
            settings.direction = direction;
            branch = follow_branch(System(with), fixed_point(with, {1 + u * 1.05, 2 + 0.1 * u * u}), settings);
            if (!of_type(branch, PointType::fold).empty())
                fold = of_type(branch, PointType::fold)[0];
        }
        ASSERT_EQ(fold.type, PointType::fold) << names(branch) << branch.detail;
        for (const int way : {1, -1}) {
            const Branch curve = curve_of(with, fold, in_parameter(with, "q", -1, 1), "p", -1, 1, way);
            for (const SpecialPoint& cusp : of_type(curve, PointType::cusp)) {
                EXPECT_NEAR(cusp.parameter, 0, 1e-9);
                EXPECT_NEAR(coefficient_of(cusp), c, 1e-5) << cusp.detail;
                fold.located = false; // found
            }
        }
        EXPECT_FALSE(fold.located) << "no cusp";
    }
}

TEST(NormalForm, GeneralisedFlipIsFoundWhereTheCoefficientVanishes) {
    const Model model = map_model("p = -0.2\nq = 1.0\ns = -2", {"-(1 + p)*x + q*x^2 + s*x^3", "0.1*y"});
    BranchSettings settings = in_parameter(model, "p", -0.5, 0.5);
    const Branch branch = follow_branch(System(model), fixed_point(model, {0, 0}), settings);
    ASSERT_EQ(names(branch), "PD BD");
    const Branch curve = curve_of(model, branch.special[0], settings, "s", -3, 0.5, 1);
    EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
    ASSERT_EQ(of_type(curve, PointType::generalised).size(), 1U) << names(curve);
    EXPECT_NEAR(value_of(model, of_type(curve, PointType::generalised)[0].solution, "s"), -1, 1e-9);
}

TEST(NormalForm, FoldsOfDoubledOrbitsEndInTheGeneralisedFlip) {
    // x -> -(1 + p) x - s x^3 - x^5: orbits x, -x with p + s x^2 + x^4 = 0, which fold at p = s^2/4, x^2 = -s/2, for s
    // < 0; flips at p = 0, with the coefficient s.
    const Model model = map_model("p = -0.2\ns = -0.4", {"-(1 + p)*x - s*x^3 - x^5", "0.1*y + 0.2*x^2"});
    const BranchSettings settings = in_parameter(model, "p", -0.5, 0.5);
    const Branch branch = follow_branch(System(model), fixed_point(model, {0, 0}), settings);
    const auto flips = of_type(branch, PointType::flip);
    ASSERT_EQ(flips.size(), 1U);
    const BranchSettings in_s = in_parameter(model, "s", -1, 0.5);
    const auto found = of_type(curve_of(model, flips[0], in_s, "p", -0.3, 0.3, 1), PointType::generalised);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].parameter, 0, 1e-9);
    const Branch doubled = follow(model, branches_at(System(model), flips[0], settings).at(0), settings);
    const auto folds = of_type(doubled, PointType::fold);
    ASSERT_EQ(folds.size(), 1U) << names(doubled);
    EXPECT_NEAR(folds[0].parameter, 0.04, 1e-11);
    const Branch curve = curve_of(model, folds[0], in_s, "p", -0.3, 0.3, 1);
    for (const BranchPoint& one : curve.points) {
        const bool is_end = &one == &curve.points.back(); // where the equations are singular
        EXPECT_NEAR(value_of(model, one.solution, "p"), one.parameter * one.parameter / 4, is_end ? 1e-9 : 1e-11);
    }
    // It ends in the repeated single orbit.
    EXPECT_EQ(curve.outcome, BranchOutcome::returned);
    EXPECT_NEAR(curve.points.back().parameter, found[0].parameter, 1e-8);
}

/// Henon's map x -> y, y -> a - b x - y^2, with fixed points y of trace -2 y and determinant b.
Model henon(double a, double b) {
    return map_model(fmt::format("a = {:.17g}\nb = {:.17g}", a, b), {"y", "a - b*x - y^2"});
}

TEST(NormalForm, HenonsMapHasItsResonances) {
    const double b = 0.3, y = 0.2, a = y * y + (1 + b) * y;
    const Model model = henon(a, b);
    BranchSettings settings = in_parameter(model, "a", -2, 5);
    BranchSettings down = settings;
    down.direction = -1;
    const Branch up = follow_branch(System(model), fixed_point(model, {y, y}), settings),
                 back = follow_branch(System(model), fixed_point(model, {y, y}), down);
    const auto flips = of_type(up, PointType::flip), folds = of_type(back, PointType::fold);
    ASSERT_EQ(flips.size(), 1U);
    ASSERT_EQ(folds.size(), 1U);
    EXPECT_NEAR(flips[0].parameter, 0.75 * (1 + b) * (1 + b), 1e-12);
    EXPECT_NEAR(folds[0].parameter, -0.25 * (1 + b) * (1 + b), 1e-12);
    const Branch of_flips = curve_of(model, flips[0], settings, "b", -0.5, 1.5, 1),
                 of_folds = curve_of(model, folds[0], settings, "b", -0.5, 1.5, -1);
    for (const BranchPoint& one : of_flips.points) {
        const double at = value_of(model, one.solution, "b");
        EXPECT_NEAR(one.parameter, 0.75 * (1 + at) * (1 + at), 1e-12 * (1 + one.parameter));
    }
    const auto second = of_type(of_flips, PointType::resonance_2);
    ASSERT_EQ(second.size(), 1U) << names(of_flips);
    EXPECT_NEAR(value_of(model, second[0].solution, "b"), 1, 1e-10);
    EXPECT_NEAR(second[0].parameter, 3, 1e-10);
    const auto first = of_type(of_folds, PointType::resonance_1);
    ASSERT_EQ(first.size(), 1U) << names(of_folds);
    EXPECT_NEAR(value_of(model, first[0].solution, "b"), 1, 1e-10);
    EXPECT_NEAR(first[0].parameter, -1, 1e-10);
    // From the resonance along the folds and flips.
    SpecialPoint along = first[0];
    along.type = PointType::fold;
    const Branch folds_again = curve_of(model, along, settings, "b", -0.5, 1.5, 1);
    EXPECT_GT(folds_again.points.size(), 5U) << folds_again.detail;
    for (const BranchPoint& on : folds_again.points)
        EXPECT_NEAR(on.parameter, -0.25 * std::pow(1 + value_of(model, on.solution, "b"), 2), 1e-11);
    SpecialPoint point = second[0];
    point.type = PointType::flip;
    const Branch flips_again = curve_of(model, point, settings, "b", -0.5, 1.5, 1);
    EXPECT_GT(flips_again.points.size(), 5U) << flips_again.detail;
    for (const BranchPoint& on : flips_again.points)
        EXPECT_NEAR(on.parameter, 0.75 * std::pow(1 + value_of(model, on.solution, "b"), 2), 1e-11);
}

/// A map near z -> (1 + p) e^(i w) z + c_1 z |z|^2 in nonlinearly transformed coordinates.
Model spiral(double p, double w) {
    return map_model(fmt::format("p = {:.17g}\nw = {:.17g}\nk = -0.4", p, w),
                     {"(1 + p)*(cos(w)*x - sin(w)*y) + k*x*(x^2 + y^2) + 0.5*x^2 - 0.2*x*y",
                      "(1 + p)*(sin(w)*x + cos(w)*y) + k*y*(x^2 + y^2) + 0.3*x^2 + 0.1*y^2"});
}

/// Returns its coefficient from the second and third derivatives (Kuznetsov 2004, section 4.7), with q = (1, -i) /
/// sqrt(2).
double coefficient_of_spiral(double w, double k) {
    const Complex i(0, 1), mu = std::exp(i * w);
    using Pair = std::array<Complex, 2>;
    const double s = 1 / std::numbers::sqrt2;
    const Pair q{s, -i * s}, r{s, i * s};
    const auto second = [](const Pair& u, const Pair& v) -> Pair {
        return {u[0] * v[0] - 0.2 * (u[0] * v[1] + u[1] * v[0]), 0.6 * u[0] * v[0] + 0.2 * u[1] * v[1]};
    };
    const auto third = [k](const Pair& a, const Pair& b, const Pair& c) -> Pair {
        // Of k x (x^2 + y^2) and k y (x^2 + y^2).
        const auto one = [&](std::size_t m) {
            const std::size_t n = 1 - m;
            return k *
                   (6.0 * a[m] * b[m] * c[m] + 2.0 * (a[m] * b[n] * c[n] + a[n] * b[m] * c[n] + a[n] * b[n] * c[m]));
        };
        return {one(0), one(1)};
    };
    // (factor - A)^-1 for A = [cos, -sin; sin, cos].
    const auto solve = [&](Complex factor, const Pair& right) -> Pair {
        const Complex d = factor - std::cos(w), o = std::sin(w), determinant = d * d + o * o;
        return {(d * right[0] - o * right[1]) / determinant, (o * right[0] + d * right[1]) / determinant};
    };
    const Pair cubic = third(q, q, r), mean = second(q, solve(1, second(q, r))),
               double_angle = second(r, solve(mu * mu, second(q, q)));
    // For a rotation the adjoint vector is q; the product is with the conjugate.
    Complex sum = 0;
    for (std::size_t m : {0, 1})
        sum += std::conj(q[m]) * (cubic[m] + 2.0 * mean[m] + double_angle[m]);
    return (std::conj(mu) * sum).real() / 2;
}

TEST(NormalForm, TorusHasTheCoefficientOfItsMap) {
    for (const double w : {0.7, 1.1, 2.4}) {
        const Model model = spiral(-0.1, w);
        const Branch branch =
            follow_branch(System(model), fixed_point(model, {0, 0}), in_parameter(model, "p", -0.3, 0.3));
        ASSERT_EQ(names(branch), "NS BD") << w;
        EXPECT_NEAR(branch.special[0].parameter, 0, 1e-12);
        const double expected = coefficient_of_spiral(w, -0.4);
        EXPECT_NEAR(coefficient_of(branch.special[0]), expected, 2e-6 * (1 + std::abs(expected))) << w;
        EXPECT_EQ(branch.special[0].detail.starts_with("super"), expected < 0);
    }
}

TEST(NormalForm, GeneralisedTorusIsFoundWhereTheCoefficientVanishes) {
    // Radii r -> (1 + p) r + s r^3 - r^5 with rotation by 0.9: torus bifurcation at p = 0, stable torus for s < 0.
    const std::string g = "(1 + p + s*(x^2 + y^2) - (x^2 + y^2)^2)";
    const Model model =
        map_model("p = -0.1\ns = -0.5", {g + "*(cos(0.9)*x - sin(0.9)*y)", g + "*(sin(0.9)*x + cos(0.9)*y)"});
    const BranchSettings settings = in_parameter(model, "p", -0.3, 0.3);
    const Branch branch = follow_branch(System(model), fixed_point(model, {0, 0}), settings);
    ASSERT_EQ(names(branch), "NS BD");
    EXPECT_NEAR(coefficient_of(branch.special[0]), -1, 1e-5); // 2 s, as r^2 = 2 |w|^2
    const Branch curve = curve_of(model, branch.special[0], in_parameter(model, "s", -1, 1), "p", -0.3, 0.3, 1);
    ASSERT_EQ(names(curve), "GT BD") << curve.detail;
    EXPECT_NEAR(curve.special[0].parameter, 0, 1e-9);
    EXPECT_NEAR(value_of(model, curve.special[0].solution, "p"), 0, 1e-12);
    for (const BranchPoint& one : curve.points)
        EXPECT_NEAR(value_of(model, one.solution, "p"), 0, 1e-12);
}

TEST(NormalForm, TorusCurveHasAllResonancesOfAGeneralisedHenonMap) {
    // x -> y, y -> a - b x - y^2 + r x y: at fixed points y the trace is (r - 2) y and the determinant b - r y.
    const double r = -0.1, y = 0.2, b = 0.5, a = y * (1 + b) + (1 - r) * y * y;
    const Model model = map_model(fmt::format("a = {:.17g}\nb = 0.5\nr = -0.1", a), {"y", "a - b*x - y^2 + r*x*y"});
    BranchSettings settings = in_parameter(model, "b", -2, 4);
    const Branch branch = follow_branch(System(model), fixed_point(model, {y, y}), settings);
    const auto torus = of_type(branch, PointType::torus);
    ASSERT_EQ(torus.size(), 1U) << names(branch);
    const auto at_trace = [&](double trace) { return trace / (r - 2); };
    std::string both;
    for (const int direction : {1, -1}) {
        const Branch curve = curve_of(model, torus[0], settings, "a", -5, 5, direction);
        EXPECT_EQ(curve.outcome, BranchOutcome::stopped) << names(curve) << curve.detail;
        for (const BranchPoint& one : curve.points) {
            const double at = one.solution.orbit.starts[0][0], determinant = one.parameter - r * at;
            EXPECT_NEAR(determinant, 1, 1e-11);
            EXPECT_NEAR(value_of(model, one.solution, "a"), at * (1 + one.parameter) + (1 - r) * at * at, 1e-11);
        }
        for (const SpecialPoint& point : curve.special) {
            both += std::string(short_name(point.type)) + " ";
            const double traces[] = {2, -2, -1, 0};
            const auto which = static_cast<std::size_t>(point.type) - static_cast<std::size_t>(PointType::resonance_1);
            ASSERT_LT(which, 4U) << short_name(point.type);
            EXPECT_NEAR(point.solution.orbit.starts[0][0], at_trace(traces[which]), 1e-7) << short_name(point.type);
        }
    }
    for (const char* one : {"R1", "R2", "R3", "R4"})
        EXPECT_NE(both.find(one), std::string::npos) << one << " in " << both;
    EXPECT_EQ(both.size(), 12U) << both;
}

TEST(NormalForm, TorusCurvesBeginAtResonancesOnTheSideOfTheComplexPair) {
    // Henon's map above: the determinant b is 1 all along, and a = y^2 + 2 y with the trace -2 y between -2 and 2.
    const double b = 0.3, y = 0.2, a = y * y + (1 + b) * y;
    const Model model = henon(a, b);
    const BranchSettings settings = in_parameter(model, "a", -2, 5);
    for (const bool at_one : {true, false}) {
        BranchSettings along = settings;
        along.direction = at_one ? -1 : 1;
        const Branch branch = follow_branch(System(model), fixed_point(model, {y, y}), along);
        const auto points = of_type(branch, at_one ? PointType::fold : PointType::flip);
        ASSERT_EQ(points.size(), 1U);
        const Branch curve = curve_of(model, points[0], settings, "b", -0.5, 1.5, at_one ? -1 : 1);
        const auto resonances = of_type(curve, at_one ? PointType::resonance_1 : PointType::resonance_2);
        ASSERT_EQ(resonances.size(), 1U) << names(curve);
        SpecialPoint start = resonances[0];
        start.type = PointType::torus;
        std::size_t followed = 0;
        for (const int way : {1, -1}) {
            const Branch torus = curve_of(model, start, settings, "b", -0.5, 1.5, way);
            EXPECT_EQ(torus.outcome, BranchOutcome::stopped) << torus.detail;
            if (torus.points.size() == 1) {
                EXPECT_EQ(torus.detail, "in this direction the two multipliers are real");
                continue;
            }
            ++followed;
            // From one resonance over 1:3 and 1:4 to the other.
            EXPECT_EQ(names(torus), at_one ? "R4 R3 R2" : "R3 R4 R1");
            for (const BranchPoint& one : torus.points) {
                const double at = one.solution.orbit.starts[0][0];
                EXPECT_NEAR(value_of(model, one.solution, "b"), 1, 1e-11);
                EXPECT_NEAR(one.parameter, at * at + 2 * at, 1e-11);
                EXPECT_LT(std::abs(at), 1 + 1e-9);
            }
        }
        EXPECT_EQ(followed, 1U);
    }
}

TEST(NormalForm, CoefficientPredictsTheOpeningOfDoubledOrbits) {
    const Model model = oscillator_model(Oscillator(), 0.02);
    BranchSettings settings = in_parameter(model, "sigma", -1, 1);
    const Branch branch = follow_branch(System(model), settled(model, "phase0", 400).orbit, settings);
    const auto flips = of_type(branch, PointType::flip);
    ASSERT_EQ(flips.size(), 1U);
    const double c = coefficient_of(flips[0]);
    const BranchStart start = branches_at(System(model), flips[0], settings).front();
    settings.steps = 6;
    settings.continuation.largest_step = 2e-3;
    const Branch doubled = follow(model, start, settings);
    ASSERT_GE(doubled.points.size(), 4U);
    double nearest = 1, farthest = 0;
    for (const BranchPoint& one : doubled.points) {
        // w^2 = (|mu| - 1) / c, where mu is the multiplier of the original orbit.
        const Orbit& orbit = one.solution.orbit;
        double square = 0;
        for (std::size_t i = 0; i < model.states.size(); ++i) {
            double twice = orbit.starts[1][i] - orbit.starts[0][i];
            if (model.states[i].period)
                twice = std::remainder(twice, 2 * pi);
            square += 0.25 * twice * twice;
        }
        Orbit left = flips[0].solution.orbit;
        left.parameters = orbit.parameters;
        const OrbitSolution there = solve_orbit(System(model), left);
        ASSERT_EQ(there.outcome, OrbitOutcome::converged) << there.detail;
        double growth = -1;
        for (const Complex multiplier : there.multipliers)
            growth = std::max(growth, std::abs(multiplier) - 1);
        const double off = std::abs(growth / (c * square) - 1);
        EXPECT_LT(off, 0.2) << one.parameter;
        nearest = std::min(nearest, off);
        farthest = std::max(farthest, off);
    }
    EXPECT_LT(nearest, 0.01) << farthest;
}

} // namespace graze::normal_form_test
