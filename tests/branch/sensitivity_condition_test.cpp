// The gradient, by differences, of the condition at the boundary between classes of touches.

#include "branch/sensitivity_condition.hpp"

#include "conditions.hpp"

#include <array>
#include <cmath>
#include <iostream>

namespace graze::sensitivity_condition_test {

using namespace graze::testing;

struct Touching {
    Model model;
    SpecialPoint point;
};

Touching touching(Model model, const char* parameter, double greatest) {
    SpecialPoint point = first_touch(model, "phase0", in_parameter(model, parameter, {}, greatest));
    return {std::move(model), std::move(point)};
}

/// Returns the largest scaled error of the gradient relative to its largest entry, against eighth-order differences
/// with much larger steps.
double error_of_gradient(const Touching& touch, std::vector<ParameterId> free) {
    const Simulation simulation(System(touch.model), {}, {}, integration(1e-14));
    Shooting equations(simulation, touch.point.solution.orbit, std::move(free));
    const Eigen::VectorXd unknowns = equations.unknowns_of(touch.point.solution.orbit);
    OrbitEvaluation at = equations.evaluation();
    EXPECT_TRUE(equations.evaluate(unknowns, at));
    auto condition = SensitivityCondition::of_touch(equations, at, touch.point);
    if (!condition || !condition->evaluate(equations, at)) {
        ADD_FAILURE() << "there is no condition";
        return 1;
    }
    const Eigen::RowVectorXd gradient = condition->gradient();
    const Eigen::VectorXd scales = equations.scales();
    double greatest = 0, error = 0;
    for (Eigen::Index i = 0; i < unknowns.size(); ++i) {
        constexpr double step = 2e-3;
        constexpr std::array<double, 4> weights{4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
        double difference = 0;
        for (std::size_t k = 0; k < weights.size(); ++k)
            for (const double sign : {1.0, -1.0}) {
                Eigen::VectorXd there = unknowns;
                there[i] += sign * static_cast<double>(k + 1) * step * scales[i];
                OrbitEvaluation beside = equations.evaluation();
                EXPECT_TRUE(equations.evaluate(there, beside));
                EXPECT_TRUE(condition->evaluate(equations, beside));
                difference += sign * weights[k] * condition->value() / step;
            }
        greatest = std::max(greatest, std::abs(difference));
        error = std::max(error, std::abs(gradient[i] * scales[i] - difference));
    }
    return error / greatest;
}

/// As documented in docs/method.md.
TEST(SensitivityCondition, GradientIsAccurateToEightDigits) {
    const Model oscillator = shipped_with("impact-oscillator", {{"sigma", 0.5}, {"amplitude", 0.1}, {"omega", 1.2}});
    const Model mems = started(shipped_with("mems-switch", {{"V", 0.15}}), {{"q", 0}});
    const std::vector<std::pair<Touching, std::array<const char*, 2>>> all{
        {touching(oscillator, "amplitude", 1), {"zeta", "omega"}}, {touching(mems, "V", 0.4), {"zeta", "omega"}}};
    for (const auto& [touch, parameters] : all) {
        const double error = error_of_gradient(touch, {touch.model.independent_parameter(parameters[0]),
                                                       touch.model.independent_parameter(parameters[1])});
        std::cout << touch.model.name << ": " << error << '\n';
        EXPECT_LT(error, 1e-8) << touch.model.name;
    }
}

} // namespace graze::sensitivity_condition_test
