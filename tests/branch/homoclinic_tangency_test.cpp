// Branches of orbits that are homoclinic to a cycle, up to the tangencies of its manifolds, and curves of these: closed
// forms, independent computations, and Melnikov's function.

#include "orbit/cycle_homoclinics.hpp"
#include "orbit/saddle_cycles.hpp"

#include "base/message_of.hpp"
#include "follow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graze::homoclinic_tangency_test {

using namespace graze::testing;

Branch branch_of(const Model& model, const Orbit& homoclinic, const BranchSettings& settings) {
    return follow_branch(System(model), homoclinic, settings);
}

/// The first tangency along the branch of an orbit.
SpecialPoint tangency_of(const Model& model, const Orbit& homoclinic, BranchSettings settings) {
    settings.stop_at = {PointType::homoclinic_tangency};
    const Branch branch = branch_of(model, homoclinic, settings);
    const auto found = of_type(branch, PointType::homoclinic_tangency);
    if (found.empty()) {
        ADD_FAILURE() << branch.detail;
        return {};
    }
    EXPECT_TRUE(found.front().located);
    return found.front();
}

TEST(HomoclinicTangency, IsWhereTheManifoldsTouchThroughAContact) {
    const Model model = gated_saddle(0.2);
    const auto found = homoclinic_orbits(System(model), origin_of(model));
    for (const OrbitSolution& one : found)
        for (const int direction : {1, -1}) {
            const SpecialPoint point = tangency_of(model, one.orbit, in_parameter(model, "c", -0.7, 0.7, direction));
            EXPECT_NEAR(point.parameter, direction * 0.5, 1e-12);
            EXPECT_NE(point.detail.find("the multipliers of its cycle are 3.51359"), std::string::npos) << point.detail;
        }
}

TEST(HomoclinicTangency, IsFollowedInTwoParameters) {
    const Model model = gated_saddle(0.2);
    const Orbit orbit = homoclinic_orbits(System(model), origin_of(model)).front().orbit;
    const SpecialPoint point = tangency_of(model, orbit, in_parameter(model, "c", -0.7, 0.7));
    for (const int direction : {1, -1}) {
        const Branch curve =
            curve_of(model, point, in_parameter(model, "c", 0.1, 0.9, direction), "A", 0.2, 0.8, direction);
        EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
        EXPECT_GT(curve.points.size(), 5U);
        for (const BranchPoint& one : curve.points)
            EXPECT_NEAR(one.parameter, value_of(model, one.solution, "A"), 1e-12);
    }
}

/// Tangencies of the manifolds of the fixed point of Henon's map at b = 0.3. Independently, both manifolds as power
/// series of their own linear dynamics (60 terms in 40 digits), and Newton's method for a, and for the places on both,
/// from T^n(U(t)) = S(s) with parallel tangents, give
///     1.30504546483796966, 1.15356981117714964.
TEST(HomoclinicTangency, IsThatOfHenonsMap) {
    const Model model = henon_map(1.4, 0.3);
    std::vector<double> tangencies;
    for (const OrbitSolution& one : homoclinic_orbits(System(model), saddle_of_henon(model, 1.4, 0.3)))
        tangencies.push_back(tangency_of(model, one.orbit, in_parameter(model, "a", 1, 1.5, -1)).parameter);
    for (const double exact : {1.30504546483796966, 1.15356981117714964})
        EXPECT_TRUE(std::ranges::any_of(tangencies, [&](double one) { return std::abs(one - exact) < 3e-12; }))
            << exact;
}

/// x'' + d x' - x + x^3 = F cos(t): manifolds touch at F/d = 4 cosh(pi/2)/(3 sqrt(2) pi) as d goes to zero (Melnikov's
/// function; J. Guckenheimer and P. Holmes, Nonlinear Oscillations, Dynamical Systems, and Bifurcations of Vector
/// Fields, section 4.5), and the next term is d^2: the orbits at -d go backwards in time.
TEST(HomoclinicTangency, IsThatOfMelnikovWhereForcesAreSmall) {
    const double limit = 4 * std::cosh(std::numbers::pi / 2) / (3 * std::numbers::sqrt2 * std::numbers::pi);
    const Model model = driven("d = 0.1\nF = 0.1", "x - x^3 - d*v + F*cos(theta)");
    const OrbitSolution cycle =
        solve_orbit(System(model), given_orbit(model, "start", {{-0.05, 0, 0}}, {2 * std::numbers::pi}));
    ASSERT_EQ(cycle.outcome, OrbitOutcome::converged);
    std::optional<SpecialPoint> point;
    for (const OrbitSolution& one : homoclinic_orbits(System(model), cycle.orbit)) {
        const SpecialPoint here = tangency_of(model, one.orbit, in_parameter(model, "F", 0.01, 0.2, -1));
        if (!point || here.parameter < point->parameter) // the first one, of the primary orbits
            point = here;
    }
    ASSERT_TRUE(point);
    const Branch curve = curve_of(model, *point, in_parameter(model, "F", 1e-3, 0.2, -1), "d", 0.0125, 0.2, -1);
    EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
    const auto excess = [&](const BranchPoint& one) {
        const double d = value_of(model, one.solution, "d");
        return (one.parameter / d - limit) / (d * d);
    };
    ASSERT_GT(curve.points.size(), 5U);
    EXPECT_NEAR(value_of(model, curve.points.back().solution, "d"), 0.0125, 1e-12);
    EXPECT_NEAR(curve.points.back().parameter / 0.0125, limit, 1e-5);
    EXPECT_NEAR(excess(curve.points.back()), excess(curve.points.front()),
                0.02 * std::abs(excess(curve.points.front())));
}

TEST(HomoclinicTangency, LeadsToNoOtherBranch) {
    const Model model = gated_saddle(0.2);
    const Orbit orbit = homoclinic_orbits(System(model), origin_of(model)).front().orbit;
    SpecialPoint point = tangency_of(model, orbit, in_parameter(model, "c", -0.7, 0.7));
    point.type = PointType::grazing;
    EXPECT_NE(message_of([&] {
                  branches_at(System(model), point, in_parameter(model, "c"));
              }).find("no other branch is followed from an orbit that is homoclinic to a cycle"),
              std::string::npos);
}

} // namespace graze::homoclinic_tangency_test
