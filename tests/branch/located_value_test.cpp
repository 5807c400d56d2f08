#include "graze/branch/located_value.hpp"

#include "driven_oscillator.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace graze::located_value_test {

using namespace graze::testing;

SpecialPoint mems_grazing(Model& model) {
    model = started(shipped_with("mems-switch", {{"V", 0.15}}), {{"q", 0}});
    return first_touch(model, "phase0", in_parameter(model, "V", {}, 0.4));
}

TEST(LocatedValue, TouchAndItsDerivativesHaveTheirClosedFormInAnyUnits) {
    for (const auto& [length, time, mass] :
         {std::array{1.0, 1.0, 1.0}, {1e-9, 1e-9, 1e-12}, {1e6, 1e6, 1e9}, {1e-6, 1e-3, 1e6}, {1e6, 1e-6, 1e-9}}) {
        const DrivenOscillator known{length, time, mass};
        const Model model = known.model();
        const ParameterId force = model.independent_parameter("F");
        LocatedValue touch(System(model), known.grazing(model), force, parameters_but(model, force));
        EXPECT_NEAR(touch.value() / known.force(), 1, 1e-12);
        const auto derivatives = known.derivatives();
        ASSERT_EQ(touch.derivatives().size(), derivatives.size());
        for (std::size_t i = 0; i < derivatives.size(); ++i) // the integration's tolerance is 1e-13
            EXPECT_NEAR(touch.derivatives()[i] * touch.values()[i] / known.force(),
                        derivatives[i] * touch.values()[i] / known.force(), 1e-11)
                << i << ' ' << length;
        // Far from there it is exact too.
        DrivenOscillator other = known;
        other.m *= 1.07;
        other.c *= 0.8;
        other.k *= 0.95;
        other.omega *= 1.02;
        other.sigma *= 1.2;
        const LocatedSolution found = touch(std::vector{other.m, other.c, other.k, other.omega, other.sigma, 0.3});
        ASSERT_TRUE(found.found) << found.problem;
        EXPECT_TRUE(found.admissible) << found.problem;
        EXPECT_LE(found.parts, 4U);
        EXPECT_NEAR(found.value / other.force(), 1, 1e-12);
    }
}

TEST(LocatedValue, PathIsDividedWhereOneStepIsTooLong) {
    const DrivenOscillator known;
    const Model model = known.model();
    const ParameterId force = model.independent_parameter("F");
    LocatedValue touch(System(model), known.grazing(model), force, {model.independent_parameter("omega")});
    DrivenOscillator other = known;
    other.omega = 0.4; // through the resonance at 1.27
    const LocatedSolution found = touch(std::vector{other.omega});
    ASSERT_TRUE(found.found) << found.problem;
    EXPECT_GT(found.parts, 1U);
    EXPECT_NEAR(found.value / other.force(), 1, 1e-11);
    // Earlier calls do not matter.
    const LocatedSolution near = touch(std::vector{1.71});
    LocatedValue fresh(System(model), known.grazing(model), force, {model.independent_parameter("omega")});
    EXPECT_EQ(near.value, fresh(std::vector{1.71}).value);
    EXPECT_EQ(found.value, fresh(std::vector{other.omega}).value);

    LocatedValueOptions impatient;
    impatient.halvings = 0;
    const LocatedSolution none =
        LocatedValue(System(model), known.grazing(model), force, {model.independent_parameter("omega")},
                     impatient)(std::vector{other.omega});
    EXPECT_FALSE(none.found);
    EXPECT_FALSE(none.problem.empty());
    EXPECT_EQ(none.parts, 0U);
}

TEST(LocatedValue, MemsSwitchHasThePublishedValueAndDerivativesOfDifferences) {
    Model model;
    const SpecialPoint point = mems_grazing(model);
    const ParameterId voltage = model.independent_parameter("V");
    LocatedValue touch(System(model), point, voltage, parameters_but(model, voltage));
    EXPECT_NEAR(touch.value(), 0.2013662121541341, 1e-12);
    const std::vector<std::string> names = model.independent_parameters();
    for (std::size_t i = 0; i < touch.others().size(); ++i) {
        // Central differences with Richardson's extrapolation: h is small against the width of the resonance, zeta. The
        // remaining error is round-off of V with standard deviation 4.4e-16; divided by h / 4 = 2.5e-6 and amplified
        // 1.4 times it is 1.8e-10, of which four standard deviations are allowed.
        const double step = 5e-4 * touch.values()[i];
        const auto difference = [&](double h) {
            double sides[2] = {0, 0};
            for (const int side : {0, 1}) {
                std::vector<double> values = touch.values();
                values[i] += side == 0 ? -h : h;
                const LocatedSolution found = touch(values);
                EXPECT_TRUE(found.found && found.admissible) << found.problem;
                sides[side] = found.value;
            }
            return (sides[1] - sides[0]) / (2 * h);
        };
        const double once = difference(step), half = difference(step / 2), quarter = difference(step / 4);
        const double better = (4 * half - once) / 3, best = (4 * quarter - half) / 3;
        EXPECT_NEAR((16 * best - better) / 15, touch.derivatives()[i], 7e-10) << names[touch.others()[i].place()];
    }
}

TEST(LocatedValue, MicroactuatorHasTheDerivativesThatDimensionsDemand) {
    // alpha V^2 / d^2 is a force: V scales with d^(3/2) when all lengths do, with the square root of all forces, and
    // with alpha^(-1/2).
    const Model model = shipped_with("impact-microactuator", {{"V", 0.1}});
    const BranchSettings settings = in_parameter(model, "V", 0, 3);
    const LocatedValue touch(System(model), first_touch(model, "longest", settings, 4000), settings.parameter,
                             parameters_but(model, settings.parameter));
    const std::vector<std::string> names = model.independent_parameters();
    const auto relative = [&](const std::vector<std::string>& of) {
        double sum = 0;
        for (std::size_t i = 0; i < touch.others().size(); ++i)
            for (const std::string& name : of)
                if (names[touch.others()[i].place()] == name)
                    sum += touch.derivatives()[i] * touch.values()[i] / touch.value();
        return sum;
    };
    EXPECT_NEAR(relative({"d", "delta"}), 1.5, 1e-10);
    EXPECT_NEAR(relative({"k", "c", "m1", "m2", "N"}), 0.5, 1e-10);
    EXPECT_NEAR(relative({"alpha"}), -0.5, 1e-11);
}

TEST(LocatedValue, TouchIsFollowedIntoAnotherSegment) {
    Model model;
    const SpecialPoint point = mems_grazing(model);
    const ParameterId voltage = model.independent_parameter("V"), frequency = model.independent_parameter("omega");
    LocatedValue touch(System(model), point, voltage, {frequency});
    // Below 0.976 the touch comes before the voltage is switched on.
    const LocatedSolution found = touch(std::vector{0.96});
    ASSERT_TRUE(found.found) << found.problem;
    EXPECT_TRUE(found.admissible) << found.problem;
    // The same from the branch at that frequency.
    model.set_parameter("omega", 0.96);
    model.set_parameter("V", 0.1);
    const SpecialPoint there = first_touch(model, "phase0", in_parameter(model, "V", {}, 0.4));
    const auto mode_of = [](const SpecialPoint& one) { return one.solution.orbit.signature[one.segment].mode; };
    EXPECT_NE(mode_of(there), mode_of(point));
    EXPECT_NEAR(found.value, there.parameter, 1e-12);
    // The object is unchanged.
    EXPECT_EQ(touch(std::vector{1.01}).value,
              LocatedValue(System(load_model("mems-switch")), point, voltage, {frequency})(std::vector{1.01}).value);
}

TEST(LocatedValue, FoldsAndFlipsAreFollowedToo) {
    // x' = p - x^2 + a y, y' = -y: a fold at p = b (of a shift); as an orbit of a phase.
    const Model model = OneMode{.parameters = "p = 0.5\nb = 0.3\nr = 2",
                                .states = "x = 1",
                                .rates = "x = 'p - b^2/r - (x - b)^2'",
                                .clock = "1"}
                            .model();
    const BranchSettings settings = in_parameter(model, "p", -1, 1, -1);
    const Branch branch = follow_branch(System(model), settled(model, "start").orbit, settings);
    const auto fold = std::find_if(branch.special.begin(), branch.special.end(),
                                   [](const auto& one) { return one.type == PointType::fold; });
    ASSERT_NE(fold, branch.special.end());
    LocatedValue value(System(model), *fold, settings.parameter, parameters_but(model, settings.parameter));
    EXPECT_NEAR(value.value(), 0.045, 1e-12); // b^2 / r
    EXPECT_NEAR(value.derivatives()[0], 0.3, 1e-10);
    EXPECT_NEAR(value.derivatives()[1], -0.0225, 1e-10);
    const LocatedSolution found = value(std::vector{0.5, 1.0});
    ASSERT_TRUE(found.found) << found.problem;
    EXPECT_NEAR(found.value, 0.25, 1e-12);
}

TEST(LocatedValue, ImpossibleArgumentsAreRefused) {
    const DrivenOscillator known;
    const Model model = known.model();
    const ParameterId force = model.independent_parameter("F"), restitution = model.independent_parameter("e");
    const SpecialPoint point = known.grazing(model);
    EXPECT_THROW(LocatedValue(System(model), point, force, {force}), InputError);
    EXPECT_THROW(LocatedValue(System(model), point, force, {restitution, restitution}), InputError);
    EXPECT_THROW(LocatedValue(System(model), point, force, {ParameterId(99)}), InputError);
    EXPECT_THROW(LocatedValue(System(model), point, restitution, {force}), InputError); // moves nothing
    SpecialPoint regular = point;
    regular.type = PointType::regular;
    EXPECT_THROW(LocatedValue(System(model), regular, force, {}), InputError);
    LocatedValueOptions wrong;
    wrong.halvings = 1000;
    EXPECT_THROW(LocatedValue(System(model), point, force, {}, wrong), InputError);
    LocatedValue touch(System(model), point, force, {});
    EXPECT_NEAR(touch.value() / known.force(), 1, 1e-12);
    EXPECT_THROW(touch(std::vector{1.0}), InputError);
    LocatedValue of_mass(System(model), point, force, {model.independent_parameter("m")});
    EXPECT_THROW(of_mass(std::vector{std::nan("")}), InputError);
    // Without mass there is no solution, and the failure has a reason.
    EXPECT_FALSE(of_mass(std::vector{0.0}).found);
    EXPECT_FALSE(of_mass(std::vector{0.0}).problem.empty());
}

} // namespace graze::located_value_test
