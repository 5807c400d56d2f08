// Torus points of the forced van der Pol oscillator in the plane of frequency and force, by Liouville's formula.

#include "maps.hpp"

#include "graze/branch/curve_start.hpp"
#include "graze/model/named_value.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace graze::van_der_pol_curve_test {

using namespace graze::testing;

constexpr double growth = 0.3;

Model van_der_pol() {
    return driven("F = 2\nomega = 1.2", "0.3*(1 - x^2)*v - x + F*cos(theta)", "omega");
}

double omega_of(const Model& model, const OrbitSolution& solution) {
    return value_of(model, solution, "omega");
}

/// The product of multipliers is exp(growth * integral of 1 - x^2): one where the mean of x^2 is 1. The multipliers
/// come from the matrix of the equations, the mean from the motion.
void expect_torus(const Model& model, const OrbitSolution& solution) {
    Monitor square;
    square.name = "square";
    square.kind = Monitor::Kind::mean;
    square.expression = named_value(model, "x^2", {}).value;
    OrbitMonitors monitors(System(model), solution.orbit.signature, {square});
    EXPECT_NEAR(monitors(solution.orbit)[0], 1, 1e-10) << omega_of(model, solution);
}

TEST(VanDerPolCurves, TorusPointsConnectResonances) {
    const Model model = van_der_pol();
    const Branch branch =
        follow_branch(System(model), settled(model, "start").orbit, in_parameter(model, "F", 0.05, 3, -1));
    const auto torus = of_type(branch, PointType::torus);
    ASSERT_EQ(torus.size(), 1U) << names(branch);
    // By averaging the amplitude is 2^(1/2) there and the effective growth is halved, up to errors of its square.
    const double w = 1.2, averaged = std::sqrt(2) * std::hypot(1 - w * w, 0.5 * growth * w);
    EXPECT_NEAR(torus[0].parameter, averaged, growth * growth * averaged);
    std::string met;
    std::vector<SpecialPoint> found;
    for (const int way : {-1, 1}) {
        const Branch curve = curve_of(model, torus[0], in_parameter(model, "omega", 0.9, 3.3), "F", 0.05, 30, way);
        EXPECT_EQ(curve.outcome, way < 0 ? BranchOutcome::stopped : BranchOutcome::bound)
            << names(curve) << ' ' << curve.detail;
        for (const BranchPoint& one : curve.points)
            expect_torus(model, one.solution);
        met += names(curve) + ' ';
        found.insert(found.end(), curve.special.begin(), curve.special.end());
    }
    // The argument of the pair follows the natural frequency, which is 1 up to the square of the growth: resonances at
    // a quarter and a third of a turn. Half a turn is not a resonance, because the orbit is symmetric and its half map
    // has the pair i, -i there.
    ASSERT_EQ(met, "R1 R4 R3 R3 BD ");
    const double turns[] = {1, 4.0 / 3, 3.0 / 2, 3};
    for (std::size_t i = 1; i < std::size(turns); ++i)
        EXPECT_NEAR(omega_of(model, found[i].solution) / turns[i], 1, growth * growth) << i;
}

TEST(VanDerPolCurves, FoldsMeetTorusPointsInAOneToOneResonance) {
    const Model model = van_der_pol();
    const Branch branch =
        follow_branch(System(model), settled(model, "start").orbit, in_parameter(model, "F", 0.02, 3, -1));
    const auto torus = of_type(branch, PointType::torus);
    ASSERT_EQ(torus.size(), 1U) << names(branch);
    const BranchSettings in_omega = in_parameter(model, "omega", 0.8, 3);
    std::vector<SpecialPoint> meetings;
    for (const int way : {1, -1})
        for (const SpecialPoint& one :
             of_type(curve_of(model, torus[0], in_omega, "F", 0.02, 10, way), PointType::resonance_1))
            meetings.push_back(one);
    ASSERT_FALSE(meetings.empty());
    for (const SpecialPoint& meeting : meetings) {
        expect_torus(model, meeting.solution);
        // Continue along the folds, and back.
        std::size_t come_back = 0;
        for (const int way : {1, -1}) {
            BranchSettings along = in_omega;
            along.steps = 8;
            const Branch away = curve_of(model, as_type(meeting, PointType::fold), along, "F", 0.02, 10, way);
            if (away.points.size() < 3)
                continue;
            EXPECT_LT(nearest_multiplier(away.points.back().solution, 1), 1e-6);
            SpecialPoint fold = meeting;
            fold.type = PointType::fold;
            fold.solution = away.points.back().solution;
            fold.parameter = away.points.back().parameter;
            for (const int back : {1, -1}) {
                const Branch curve = curve_of(model, fold, in_omega, "F", 0.02, 10, back);
                for (const SpecialPoint& one : of_type(curve, PointType::resonance_1))
                    if (std::abs(one.parameter - meeting.parameter) < 1e-3) {
                        ++come_back;
                        EXPECT_NEAR(one.parameter, meeting.parameter, 1e-9);
                        EXPECT_NEAR(value_of(model, one.solution, "F"), value_of(model, meeting.solution, "F"), 1e-9);
                    }
            }
        }
        EXPECT_GE(come_back, 1U);
    }
}

} // namespace graze::van_der_pol_curve_test
