// Passages of folds: normal form, simulation, closed forms.

#include "graze/trip/fold_passage.hpp"

#include "branch/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::fold_passage_test {

using namespace graze::testing;
using std::numbers::pi;

/// Returns the first fold of a branch.
SpecialPoint fold_of(const Model& model, const Orbit& orbit, const BranchSettings& settings) {
    const std::vector<SpecialPoint> folds = of_type(follow_branch(System(model), orbit, settings), PointType::fold);
    EXPECT_FALSE(folds.empty());
    return folds.at(0);
}

/// u -> u + b p + a u^2 with u = x - 1 in a unit of length, and a driven state.
Model normal_form(double a, double b, double p, double length) {
    return map_model(fmt::format("p = {:.17g}\na = {}\nb = {}\nL = {:.17g}", p, a, b, length),
                     {"x + L*(b*p + a*(x/L - 1)^2)", "2*L + 0.1*(y - 2*L) + 0.3*(x - L)"});
}

struct Passing {
    Model model;
    FoldPassage fold;
};
Passing passing(double a, double b, double length) {
    const double side = a * b < 0 ? 1 : -1, u = -std::copysign(std::sqrt(0.04 * std::abs(b / a)), a);
    Model model = normal_form(a, b, side * 0.04, length);
    BranchSettings settings = in_parameter(model, "p", -1, 1);
    settings.direction = -static_cast<int>(side);
    const SpecialPoint point =
        fold_of(model, fixed_point(model, {length * (1 + u), length * (2 + u * 0.3 / 0.9)}), settings);
    FoldPassage fold = fold_passage(System(model), point, settings.parameter);
    return {std::move(model), std::move(fold)};
}

TEST(FoldPassage, HasTheCoefficientsOfItsMapInAnyUnits) {
    // The critical vector is (1, 1/3) in x and y, of length hypot(1, 1/3): w is u times that.
    const double stretch = std::hypot(1, 0.3 / 0.9);
    for (const double length : {1e-9, 1.0, 1e6})
        for (const double a : {1.0, -0.7})
            for (const double b : {1.0, -2.0}) {
                SCOPED_TRACE(fmt::format("{} {} {}", length, a, b));
                const FoldPassage fold = passing(a, b, length).fold;
                EXPECT_NEAR(fold.value, 0, 1e-10);
                // The orbit of the fold is known to the square root of round-off.
                EXPECT_NEAR(fold.coefficient * stretch * length / std::abs(a), 1, 1e-6);
                EXPECT_NEAR(fold.rate / (stretch * length * b) * std::copysign(1, a), 1, 1e-6);
                EXPECT_EQ(fold.side, a * b > 0 ? 1 : -1);
                EXPECT_EQ(fold.cycle, 1);
                EXPECT_TRUE(fold.attracting);
                EXPECT_NEAR(fold.critical[0] / (length * std::copysign(1, a)), 1 / stretch / length, 1e-6 / length);
                EXPECT_NEAR(cycles_of_passage(fold, fold.side * 1e-6), pi / std::sqrt(std::abs(a * b) * 1e-6), 0.1);
            }
}

TEST(FoldPassage, CyclesAgreeWithSimulationAndTheIteratedMap) {
    for (const double length : {1e-6, 1.0}) {
        const Passing one = passing(-0.7, 2, length);
        double before = 0;
        for (int decade = 2; decade <= 7; ++decade) {
            SCOPED_TRACE(decade);
            const double overshoot = one.fold.side * std::pow(10, -decade);
            TripOptions options;
            options.cycles = 100'000;
            const SimulatedPassage simulated =
                simulated_passage(System(one.model), one.fold, overshoot, {}, true, options);
            ASSERT_TRUE(simulated.passed);
            // Direct iteration of the map for w = |a| u up to the same gate.
            double w = -0.05, last = w;
            int cycles = 0;
            for (; w < 0.05; ++cycles) {
                last = w;
                w += 1.4 * std::abs(overshoot + one.fold.value) + w * w;
            }
            EXPECT_NEAR(simulated.cycles, cycles - 1 + (0.05 - last) / (w - last), 1e-3 * simulated.cycles + 1e-6);
            EXPECT_NEAR(simulated.time, simulated.cycles, 1e-9 * simulated.cycles);
            const double gated = cycles_of_passage(one.fold, overshoot, -one.fold.gate, one.fold.gate);
            // Discrete cycles instead of a continuous rate: about one cycle.
            EXPECT_NEAR(simulated.cycles, gated, 1);
            // The whole passage is longer by the parts beyond the gates, 2/(a gate) = 40 cycles.
            const double whole = cycles_of_passage(one.fold, overshoot);
            EXPECT_NEAR(whole, pi / std::sqrt(1.4 * std::abs(overshoot)), 1e-6 * whole);
            EXPECT_NEAR(whole - simulated.cycles, 40, decade > 3 ? 1.5 : 36);
            if (decade > 5) {
                EXPECT_NEAR(whole / before, std::sqrt(10.0), 1e-9);
            }
            before = whole;
        }
    }
}

TEST(FoldPassage, HenonAndLogisticMapsHaveTheirCoefficients) {
    // x -> y, y -> a - b x - y^2 has fixed points y^2 + (1 + b) y = a, with a fold at y = -(1 + b)/2; with v along (1,
    // 1) from there and the other multiplier b, the adjoint (-b, 1)/(1 - b): v' = v + (da - v^2)/(1 - b).
    const double b = 0.3, y = 0.2;
    const Model henon =
        map_model(fmt::format("a = {:.17g}\nb = {:.17g}", y * y + (1 + b) * y, b), {"y", "a - b*x - y^2"});
    BranchSettings settings = in_parameter(henon, "a", -2, 5);
    settings.direction = -1;
    const SpecialPoint point = fold_of(henon, fixed_point(henon, {y, y}), settings);
    const FoldPassage fold = fold_passage(System(henon), point, settings.parameter);
    EXPECT_NEAR(fold.coefficient * std::abs(fold.rate), 1 / ((1 - b) * (1 - b)), 1e-5);
    EXPECT_EQ(fold.side, -1);
    TripOptions options;
    options.cycles = 50'000;
    for (const double overshoot : {-1e-4, -1e-6}) {
        const SimulatedPassage simulated = simulated_passage(System(henon), fold, overshoot, {}, true, options);
        ASSERT_TRUE(simulated.passed);
        EXPECT_NEAR(simulated.cycles, cycles_of_passage(fold, overshoot, -fold.gate, fold.gate), 3);
    }
    // The period 3 of the logistic map is born at r = 1 + 8^(1/2): of its third iterate, by differences.
    const Model logistic = map_model("r = 3.84", {"r*x*(1 - x)", "0.1*y"});
    const double r = 1 + std::sqrt(8.0);
    const auto thrice = [](double growth, double x) {
        for (int i = 0; i < 3; ++i)
            x = growth * x * (1 - x);
        return x;
    };
    double x = 0.5;
    for (int i = 0; i < 3000; ++i)
        x = thrice(3.84, x);
    Orbit orbit{parse_signature(logistic, "map^3"), logistic.parameter_values(), {}, {1, 1, 1}, {}};
    for (int i = 0; i < 3; ++i) {
        orbit.starts.push_back({x, 0, 0});
        x = 3.84 * x * (1 - x);
    }
    BranchSettings down = in_parameter(logistic, "r", 3.7, 3.9);
    down.direction = -1;
    const FoldPassage third = fold_passage(System(logistic), fold_of(logistic, orbit, down), down.parameter);
    EXPECT_NEAR(third.value, r, 1e-12);
    EXPECT_EQ(third.side, -1);
    EXPECT_EQ(third.cycle, 3);
    const double at = third.orbit.starts.front()[0], h = 1e-4;
    const double second = (thrice(r, at + h) - 2 * thrice(r, at) + thrice(r, at - h)) / (2 * h * h),
                 by_r = (thrice(r + h, at) - thrice(r - h, at)) / (2 * h);
    EXPECT_NEAR(third.coefficient, std::abs(second),
                1e-4 * third.coefficient); // differences of order h^2, and their round-off
    EXPECT_NEAR(third.coefficient * third.rate, second * by_r, 1e-4 * third.coefficient * std::abs(third.rate));
    const SimulatedPassage simulated = simulated_passage(System(logistic), third, -1e-7, {}, true, options);
    ASSERT_TRUE(simulated.passed);
    EXPECT_NEAR(simulated.cycles, cycles_of_passage(third, -1e-7, -third.gate, third.gate), 3);
}

TEST(FoldPassage, PointsWithoutPassageAreRefused) {
    const Passing one = passing(1, 1, 1);
    const auto expect_refusal = [](const auto& call, const std::string& what) {
        try {
            call();
            ADD_FAILURE() << "accepted";
        } catch (const InputError& error) {
            EXPECT_NE(error.problem().find(what), std::string::npos) << error.problem();
        }
    };
    expect_refusal([&] { cycles_of_passage(one.fold, -1e-3); }, "there are two orbits");
    expect_refusal([&] { cycles_of_passage(one.fold, 0); }, "at the fold itself");
    expect_refusal([&] { cycles_of_passage(one.fold, std::nan("")); }, "");
    const Branch branch = follow_branch(System(one.model), one.fold.orbit, in_parameter(one.model, "p", -1, 1));
    expect_refusal([&] { fold_passage(System(one.model), branch.special.back(), one.fold.parameter); }, "is no fold");
}

} // namespace graze::fold_passage_test
