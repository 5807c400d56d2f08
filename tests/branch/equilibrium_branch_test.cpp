// Branches of equilibria and curves of their special points against closed forms: normal forms, textbook models.

#include "follow.hpp"

#include "graze/branch/curve_start.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::equilibrium_branch_test {

using namespace graze::testing;
using std::numbers::pi;

/// An equilibrium of a model near its initial state.
Orbit at_rest(const Model& model) {
    Orbit candidate{
        signature_of_rest(model.initial_mode), model.parameter_values(), {model.initial_state()}, {0.0}, {}};
    const OrbitSolution solution = solve_orbit(System(model), candidate);
    EXPECT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
    return solution.orbit;
}

Branch branch_of(const Model& model, const std::string& parameter, double least, double greatest, int direction = 1) {
    return follow_branch(System(model), at_rest(model), in_parameter(model, parameter, least, greatest, direction));
}

Model plane(const std::string& parameters, const std::string& states, const std::string& rates) {
    return OneMode{.parameters = parameters, .states = states, .rates = rates}.model();
}

TEST(EquilibriumBranch, PlateHasItsFoldAtPullInInAnyUnits) {
    for (const double gap : {1.0, 1e-9, 1e6})
        for (const double time : {1.0, 1e-6}) {
            const double k = 1 / (time * time), volt = std::sqrt(4 * k * std::pow(gap, 3) / 27);
            const Model model =
                plane(fmt::format("V = {:.17g}\nk = {:.17g}\nd = {:.17g}\nc = {:.17g}", 0.1 * volt, k, gap, 0.3 / time),
                      "q = 0\nv = 0", "q = 'v', v = '-c*v - k*q + V^2/(d - q)^2'");
            const Branch branch = branch_of(model, "V", 0.05 * volt, 2 * volt);
            EXPECT_EQ(names(branch), "SN BD") << gap << ' ' << time << ' ' << branch.detail;
            ASSERT_FALSE(branch.special.empty());
            const SpecialPoint& fold = branch.special[0];
            EXPECT_NEAR(fold.parameter / volt, 1, 1e-12);
            EXPECT_NEAR(fold.solution.orbit.starts[0][0] / gap, 1.0 / 3, 1e-10);
            EXPECT_TRUE(branch.points.front().stable);
            EXPECT_FALSE(branch.points.back().stable);
            const Branch curve = curve_of(model, fold, in_parameter(model, "k", 0.5 * k, 2 * k), "V", 0, 4 * volt, 1);
            EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
            EXPECT_GT(curve.points.size(), 5U);
            for (const BranchPoint& point : curve.points)
                EXPECT_NEAR(value_of(model, point.solution, "V") /
                                std::sqrt(4 * point.parameter * std::pow(gap, 3) / 27),
                            1, 1e-10);
        }
}

TEST(EquilibriumBranch, LorenzHasItsPitchforkAndHopfPoints) {
    const Model model = plane("sigma = 10\nrho = 0.5\nbeta = '8/3'", "x = 0\ny = 0\nz = 0",
                              "x = 'sigma*(y - x)', y = 'x*(rho - z) - y', z = 'x*y - beta*z'");
    const Branch trivial = branch_of(model, "rho", 0, 30);
    EXPECT_EQ(names(trivial), "BP BD") << trivial.detail;
    ASSERT_FALSE(trivial.special.empty());
    EXPECT_NEAR(trivial.special[0].parameter, 1, 1e-9);
    const auto others = branches_at(System(model), trivial.special[0], in_parameter(model, "rho", 0, 30));
    ASSERT_EQ(others.size(), 2U);
    for (const BranchStart& other : others) {
        const Branch bent = follow(model, other, in_parameter(model, "rho", 0, 30));
        EXPECT_EQ(names(bent), "HB BD") << bent.detail;
        for (const BranchPoint& point : bent.points) // x = y = +-sqrt(beta (rho - 1))
            EXPECT_NEAR(std::pow(point.solution.orbit.starts[0][0], 2), 8.0 / 3 * (point.parameter - 1), 1e-10);
    }
    Model moved = model;
    moved.set_parameter("rho", 10);
    for (const auto& [state, value] : {std::pair("x", 4.0), std::pair("y", 4.0), std::pair("z", 9.0)})
        moved.set_initial(state, value);
    const Branch branch = branch_of(moved, "rho", 5, 30);
    EXPECT_EQ(names(branch), "HB BD") << branch.detail;
    const double rho = 10 * (10 + 8.0 / 3 + 3) / (10 - 8.0 / 3 - 1), omega = std::sqrt(8.0 / 3 * (10 + rho));
    ASSERT_FALSE(branch.special.empty());
    EXPECT_NEAR(branch.special[0].parameter, rho, 1e-11);
    EXPECT_NEAR(branch.special[0].solution.eigenvalues[0].imag(), omega, 1e-10);
    EXPECT_NE(branch.special[0].detail.find("subcritical"), std::string::npos) << branch.special[0].detail;
    // The cycles are unstable and lead to smaller rho.
    const BranchSettings settings = in_parameter(moved, "rho", 16, 30);
    const auto starts = branches_at(System(moved), branch.special[0], settings);
    ASSERT_EQ(starts.size(), 1U);
    EXPECT_LT(starts[0].orbit.parameters[moved.independent_parameter("rho").place()], rho);
    const Branch cycles = follow(moved, starts[0], settings);
    EXPECT_EQ(cycles.outcome, BranchOutcome::bound) << cycles.detail;
    EXPECT_LT(cycles.points.back().parameter, 16.1);
    EXPECT_NEAR(cycles.points.front().solution.orbit.period(), 2 * pi / omega, 1e-2);
    for (const BranchPoint& point : cycles.points)
        EXPECT_FALSE(point.stable);
}

/// z' = (beta + i w) z + sigma z |z|^2 in the plane.
const char* const focus_rates = "x = 'beta*x - w*y + sigma*x*(x^2 + y^2) - x*(x^2 + y^2)^2', "
                                "y = 'w*x + beta*y + sigma*y*(x^2 + y^2) - y*(x^2 + y^2)^2'";

TEST(EquilibriumBranch, FirstLyapunovCoefficientIsThatOfTheNormalForm) {
    for (const double sigma : {-1.0, 0.7})
        for (const double w : {1.0, 250.0}) {
            const Model model =
                plane(fmt::format("beta = -1\nw = {}\nsigma = {}", w, sigma), "x = 0\ny = 0", focus_rates);
            const Branch branch = branch_of(model, "beta", -2, 2);
            EXPECT_EQ(names(branch), "HB BD") << branch.detail;
            EXPECT_NEAR(branch.special[0].parameter, 0, 1e-14);
            // |x|^2 = 2 |z|^2 for an eigenvector of norm 1: l1 = 2 sigma/w.
            EXPECT_NE(branch.special[0].detail.find(fmt::format("coefficient {:.10g}:", 2 * sigma / w)),
                      std::string::npos)
                << branch.special[0].detail;
        }
}

TEST(EquilibriumBranch, BrusselatorsCyclesBeginAtItsHopfPoint) {
    const Model model = plane("a = 1.5\nb = 1", "x = 1\ny = 1", "x = '1 - (b + 1)*x + a*x^2*y', y = 'b*x - a*x^2*y'");
    const Branch branch = branch_of(model, "b", 0.5, 4);
    EXPECT_EQ(names(branch), "HB BD") << branch.detail;
    const SpecialPoint& hopf = branch.special[0];
    EXPECT_NEAR(hopf.parameter, 2.5, 1e-13);
    EXPECT_NEAR(hopf.solution.eigenvalues[0].imag(), std::sqrt(1.5), 1e-13);
    const BranchSettings settings = in_parameter(model, "b", 2, 3);
    const auto starts = branches_at(System(model), hopf, settings);
    ASSERT_EQ(starts.size(), 1U);
    const Branch cycles = follow(model, starts[0], settings);
    EXPECT_EQ(names(cycles), "BD") << cycles.detail;
    EXPECT_NEAR(cycles.points.back().parameter, 3, 1e-12);
    EXPECT_TRUE(cycles.points.back().stable);
    // Back along the cycles, to the same point.
    BranchSettings back = settings;
    back.direction = -1;
    const Branch shrinking = follow_branch(System(model), cycles.points.back().solution.orbit, back);
    EXPECT_EQ(shrinking.outcome, BranchOutcome::shrunk) << shrinking.detail;
    EXPECT_NEAR(shrinking.special.back().parameter, 2.5, 1e-9);
    // And from there to the equilibria.
    const auto rest = branches_at(System(model), shrinking.special.back(), in_parameter(model, "b", 0.5, 4));
    ASSERT_EQ(rest.size(), 2U);
    EXPECT_EQ(names(follow(model, rest[0], in_parameter(model, "b", 0.5, 4))), "BD");
}

TEST(EquilibriumBranch, CuspIsFoundOnItsCurve) {
    const Model model = plane("a = -1\nb = 1", "x = -1", "x = 'a + b*x - x^3'");
    const Branch branch = branch_of(model, "a", -3, 3);
    EXPECT_EQ(names(branch), "SN SN BD") << branch.detail;
    EXPECT_NEAR(branch.special[0].parameter, std::sqrt(4.0 / 27), 1e-13);
    EXPECT_NEAR(branch.special[1].parameter, -std::sqrt(4.0 / 27), 1e-13);
    const Branch curve = curve_of(model, branch.special[0], in_parameter(model, "b", -2, 2, -1), "a", -3, 3, -1);
    ASSERT_EQ(of_type(curve, PointType::cusp).size(), 1U) << names(curve) << ' ' << curve.detail;
    EXPECT_NEAR(of_type(curve, PointType::cusp)[0].parameter, 0, 1e-12);
    EXPECT_NEAR(value_of(model, of_type(curve, PointType::cusp)[0].solution, "a"), 0, 1e-12);
    for (const BranchPoint& point : curve.points) {
        const double a = value_of(model, point.solution, "a");
        EXPECT_NEAR(27 * a * a, 4 * std::pow(point.parameter, 3), 1e-11);
    }
}

TEST(EquilibriumBranch, BogdanovTakensPointLiesOnBothCurves) {
    // x' = y, y' = a + b x + x^2 - x y: folds at 4 a = b^2, Hopf points at a = 0, b < 0.
    const Model model = plane("a = -1\nb = -1", "x = -0.6\ny = 0", "x = 'y', y = 'a + b*x + x^2 - x*y'");
    const Branch branch = branch_of(model, "a", -2, 1);
    EXPECT_EQ(names(branch), "HB SN BD") << branch.detail;
    EXPECT_NEAR(branch.special[0].parameter, 0, 1e-13);
    EXPECT_NEAR(branch.special[1].parameter, 0.25, 1e-13);
    const Branch hopf = curve_of(model, branch.special[0], in_parameter(model, "b", -2, 1), "a", -3, 3, 1);
    EXPECT_EQ(names(hopf), "BT") << hopf.detail;
    EXPECT_EQ(hopf.outcome, BranchOutcome::stopped);
    EXPECT_NEAR(hopf.special[0].parameter, 0, 1e-12);
    const Branch folds = curve_of(model, branch.special[1], in_parameter(model, "b", -2, 1), "a", -3, 3, 1);
    ASSERT_EQ(of_type(folds, PointType::takens_bogdanov).size(), 1U) << names(folds) << ' ' << folds.detail;
    const SpecialPoint point = of_type(folds, PointType::takens_bogdanov)[0];
    EXPECT_NEAR(point.parameter, 0, 1e-12);
    // From the point, the curve of Hopf points leads one way only.
    SpecialPoint kept = as_type(point, PointType::hopf);
    int ways = 0;
    for (const int direction : {1, -1}) {
        const Branch again = curve_of(model, kept, in_parameter(model, "b", -2, 1), "a", -3, 3, direction);
        ways += again.points.size() > 1 ? 1 : 0;
        for (const BranchPoint& one : again.points)
            EXPECT_NEAR(value_of(model, one.solution, "a"), 0, 1e-10);
    }
    EXPECT_EQ(ways, 1);
}

TEST(EquilibriumBranch, CurvesBeginAtABogdanovTakensPointInOtherCoordinates) {
    // The same equations with x + y in place of y.
    const Model model =
        plane("a = -1\nb = -1", "x = -0.618\ny = 0", "x = 'x + y', y = 'a + b*x + x^2 - x*(x + y) - (x + y)'");
    const Branch branch = branch_of(model, "a", -3, 3);
    ASSERT_EQ(names(branch), "HB SN BD") << branch.detail;
    const BranchSettings along = in_parameter(model, "a", -3, 3);
    for (const PointType type : {PointType::hopf, PointType::fold}) {
        const std::size_t place = type == PointType::hopf ? 0 : 1;
        const Branch first = curve_of(model, branch.special[place], along, "b", -3, 3, 1);
        auto found = of_type(first, PointType::takens_bogdanov);
        if (found.empty())
            found = of_type(curve_of(model, branch.special[place], along, "b", -3, 3, -1), PointType::takens_bogdanov);
        ASSERT_FALSE(found.empty()) << names(first);
        for (const PointType other : {PointType::hopf, PointType::fold}) {
            std::size_t points = 0;
            for (const int direction : {1, -1})
                points = std::max(
                    points, curve_of(model, as_type(found[0], other), along, "b", -3, 3, direction).points.size());
            EXPECT_GT(points, 3U) << short_name(type) << ' ' << short_name(other);
        }
    }
}

TEST(EquilibriumBranch, BautinPointLiesOnTheCurveOfHopfPoints) {
    const Model model = plane("beta = -1\nw = 1\nsigma = -1", "x = 0\ny = 0", focus_rates);
    const Branch branch = branch_of(model, "beta", -2, 2);
    const Branch curve = curve_of(model, branch.special[0], in_parameter(model, "sigma", -2, 2), "beta", -3, 3, 1);
    ASSERT_EQ(of_type(curve, PointType::generalised_hopf).size(), 1U) << names(curve) << ' ' << curve.detail;
    EXPECT_NEAR(of_type(curve, PointType::generalised_hopf)[0].parameter, 0, 1e-12);
}

TEST(EquilibriumBranch, ZeroHopfAndDoubleHopfPointsAreFound) {
    const Model zero = plane("a = -1\nb = -0.5", "x = -1\nu = 0\nv = 0",
                             "x = 'a + x^2 + u^2 + v^2', u = '(b + x)*u - 2*v', v = '2*u + (b + x)*v'");
    const Branch branch = branch_of(zero, "a", -2, 1);
    EXPECT_EQ(names(branch), "SN HB BD") << branch.detail; // from x = -1 over x = 0 to x = 0.5
    EXPECT_NEAR(branch.special[1].parameter, -0.25, 1e-12);
    const Branch folds = curve_of(zero, branch.special[0], in_parameter(zero, "b", -2, 2), "a", -3, 3, 1);
    ASSERT_EQ(of_type(folds, PointType::zero_hopf).size(), 1U) << names(folds) << ' ' << folds.detail;
    EXPECT_NEAR(of_type(folds, PointType::zero_hopf)[0].parameter, 0, 1e-12);
    const Branch hopf = curve_of(zero, branch.special[1], in_parameter(zero, "b", -2, 2), "a", -3, 3, 1);
    ASSERT_EQ(of_type(hopf, PointType::zero_hopf).size(), 1U) << names(hopf) << ' ' << hopf.detail;
    EXPECT_NEAR(of_type(hopf, PointType::zero_hopf)[0].parameter, 0, 1e-12);

    const Model pairs = plane("a = -1\nb = -1", "x = 0\ny = 0\nu = 0\nv = 0",
                              "x = 'a*x - y - x*(x^2 + y^2)', y = 'x + a*y - y*(x^2 + y^2)', "
                              "u = 'b*u - 1.5*v - u*(u^2 + v^2)', v = '1.5*u + b*v - v*(u^2 + v^2)'");
    const Branch along = branch_of(pairs, "a", -2, 2);
    EXPECT_EQ(names(along), "HB BD") << along.detail;
    const Branch curve = curve_of(pairs, along.special[0], in_parameter(pairs, "b", -2, 2), "a", -3, 3, 1);
    ASSERT_EQ(of_type(curve, PointType::double_hopf).size(), 1U) << names(curve) << ' ' << curve.detail;
    EXPECT_NEAR(of_type(curve, PointType::double_hopf)[0].parameter, 0, 1e-12);
}

TEST(EquilibriumBranch, BranchPointsAreLocatedWhereARowOfTheEquationsVanishes) {
    for (const double unit : {1e-9, 1.0, 1e6}) {
        const Model model = plane("r = -1", "x = 0", fmt::format("x = 'r*x - x^3/{:.17g}'", unit * unit));
        const Branch trivial = branch_of(model, "r", -2, 2);
        ASSERT_EQ(names(trivial), "BP BD") << unit;
        EXPECT_NEAR(trivial.special[0].parameter, 0, 1e-12);
    }
}

TEST(EquilibriumBranch, HopfPointBesideAFoldIsFound) {
    // x' = y, y' = b - e x + x^2 - x y: a Hopf point at b = 0 where e > 0, and a fold at b = e^2/4.
    for (const double e : {0.02, 0.01, 1e-3}) {
        const Model model =
            plane(fmt::format("b = -1\ne = {:.17g}", e), "x = -1\ny = 0", "x = 'y', y = 'b - e*x + x^2 - x*y'");
        const Branch branch = branch_of(model, "b", -2, 1);
        EXPECT_EQ(names(branch), "HB SN BD") << e << ' ' << branch.detail;
        if (branch.special.size() == 3) {
            EXPECT_NEAR(branch.special[0].parameter, 0, 1e-12);
            EXPECT_NEAR(branch.special[1].parameter, e * e / 4, 1e-12);
        }
    }
}

TEST(EquilibriumBranch, TwoEigenvaluesThatCrossAtOnceAreTold) {
    const Model model = plane("p = -1", "x = 0\ny = 0", "x = 'p*x - x^3', y = 'p*y - y^3'");
    const Branch branch = branch_of(model, "p", -2, 2);
    ASSERT_EQ(names(branch), "BP BD") << branch.detail;
    EXPECT_FALSE(branch.special[0].located);
    EXPECT_NEAR(branch.special[0].parameter, 0, 1e-6);
    EXPECT_NE(branch.special[0].detail.find("from 0 to 2"), std::string::npos) << branch.special[0].detail;
}

/// Two linear fields that meet at x = 0. @param right, left rates
Model two_fields(const std::string& parameters, const std::string& right, const std::string& left, double x) {
    return TwoModes{.parameters = parameters,
                    .states = fmt::format("x = {}", x),
                    .first = {"right", right, "leave", "x"},
                    .second = {"left", left, "back", "-x"},
                    .kind = "barrier"}
        .model();
}

TEST(EquilibriumBranch, BoundaryEquilibriaPersistOrFold) {
    const Model persists = two_fields("mu = 1", "x = 'mu - x'", "x = 'mu - 2*x'", 1);
    const Branch on = branch_of(persists, "mu", -1, 2, -1);
    EXPECT_EQ(names(on), "BE BD") << on.detail;
    EXPECT_NEAR(on.special[0].parameter, 0, 1e-14);
    EXPECT_NE(on.special[0].detail.find("persists"), std::string::npos) << on.special[0].detail;
    EXPECT_NEAR(on.points.back().solution.orbit.starts[0][0], -0.5, 1e-13);
    const Model folds = two_fields("mu = 1", "x = 'mu - x'", "x = 'mu + x'", 1);
    const Branch back = branch_of(folds, "mu", -1, 2, -1);
    EXPECT_EQ(names(back), "BE BD") << back.detail;
    EXPECT_NE(back.special[0].detail.find("nonsmooth fold"), std::string::npos) << back.special[0].detail;
    EXPECT_NEAR(back.points.back().solution.orbit.starts[0][0], -2, 1e-13);
    EXPECT_FALSE(back.points.back().stable);
    // The curve in two parameters: mu = c where the surface is x = c.
    const Model moved = TwoModes{.parameters = "mu = 1\nc = 0",
                                 .states = "x = 1",
                                 .first = {"right", "x = 'mu - x'", "leave", "x - c"},
                                 .second = {"left", "x = 'mu + x - 2*c'", "back", "c - x"},
                                 .kind = "barrier"}
                            .model();
    const Branch at = branch_of(moved, "mu", -1, 2, -1);
    const Branch curve = curve_of(moved, at.special[0], in_parameter(moved, "c", -2, 2), "mu", -5, 5, 1);
    EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
    for (const BranchPoint& point : curve.points)
        EXPECT_NEAR(value_of(moved, point.solution, "mu"), point.parameter, 1e-12);
}

/// Two fields that push towards x = 0 from either side; from the left with (1, 3).
Model sliding(const std::string& right) {
    return model_from("[parameters]\nmu = 1\n[states]\nx = 1\ny = 1\n[modes.left]\nrates = { x = 1, y = 3 }\n"
                      "[modes.right]\nrates = { x = '" +
                      right +
                      "', y = 'x - y' }\n[events]\nline = 'x'\n[slides.along]\nsurface = 'line'\n"
                      "between = ['left', 'right']\n[initial]\nmode = 'right'\n");
}

TEST(EquilibriumBranch, PersistsAsAnEquilibriumOfSliding) {
    // For x > 0 an equilibrium at (mu, mu); for mu < 0 sliding by the share l = 1/(1 - mu) of the right field.
    const Branch branch = branch_of(sliding("mu - x"), "mu", -2, 2, -1);
    ASSERT_EQ(names(branch), "BE BD") << branch.detail;
    EXPECT_NEAR(branch.special[0].parameter, 0, 1e-14);
    EXPECT_NE(branch.special[0].detail.find("persists as an equilibrium of mode 'along'"), std::string::npos)
        << branch.special[0].detail;
    const OrbitSolution& last = branch.points.back().solution;
    EXPECT_NEAR(last.orbit.starts[0][0], 0, 1e-14);
    EXPECT_NEAR(last.orbit.starts[0][1], 6, 1e-12); // y = -3 mu
    ASSERT_EQ(last.eigenvalues.size(), 1U);
    EXPECT_NEAR(last.eigenvalues[0].real(), -1.0 / 3, 1e-13); // -l
    EXPECT_TRUE(is_stable(last));
}

TEST(EquilibriumBranch, MeetsAnEquilibriumOfSlidingInANonsmoothFold) {
    const Branch branch = branch_of(sliding("x - mu"), "mu", -2, 2, -1);
    ASSERT_EQ(names(branch), "BE BD") << branch.detail;
    EXPECT_NE(branch.special[0].detail.find("nonsmooth fold with an equilibrium of mode 'along'"), std::string::npos)
        << branch.special[0].detail;
    EXPECT_NEAR(branch.points.back().parameter, 2, 1e-14);
    EXPECT_NEAR(branch.points.back().solution.orbit.starts[0][1], 6, 1e-12); // y = 3 mu
    EXPECT_TRUE(branch.points.back().stable);
    EXPECT_FALSE(branch.points.front().stable);
}

TEST(EquilibriumBranch, NoPointOfAPairIsMissed) {
    // Two folds, or two Hopf points, at a distance of 1e-3 to 1e-6 from each other.
    for (const double apart : {1e-3, 1e-4, 1e-6}) {
        const Model folds = plane(fmt::format("a = -1\ne = {:.17g}", apart), "x = -1", "x = 'a + x^3/3 - e^2*x'");
        const Branch branch = branch_of(folds, "a", -2, 2);
        EXPECT_EQ(of_type(branch, PointType::fold).size(), 2U) << apart << ' ' << names(branch);
        const Model pairs = plane(fmt::format("a = -1\ne = {:.17g}", apart), "x = 0\ny = 0",
                                  "x = '(e^2 - a^2)*x - y - x*(x^2 + y^2)', y = 'x + (e^2 - a^2)*y - y*(x^2 + y^2)'");
        const Branch twice = branch_of(pairs, "a", -1, 1);
        EXPECT_EQ(of_type(twice, PointType::hopf).size(), 2U) << apart << ' ' << names(twice);
    }
}

} // namespace graze::equilibrium_branch_test
