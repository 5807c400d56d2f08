// The conditions at the ends of homoclinic orbits: derivatives against differences.

#include "orbit/homoclinic_ends.hpp"

#include "orbit/saddle_focus.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace graze::homoclinic_ends_test {

using namespace graze::testing;

TEST(HomoclinicEnds, ConditionsAgreeWithDifferences) {
    const Model model = focus();
    const std::vector<double> values = model.parameter_values(), begin{0.45, 0.18, 0.15}, end{0.41, 0.2, 0.1};
    const std::vector<ParameterId> free{model.independent_parameter("p"), model.independent_parameter("q")};
    HomoclinicEnds ends(System(model), 0, free);
    ends.keep_distances(begin, end, values, Eigen::Vector3d(1, 0.5, 2));
    ASSERT_TRUE(ends.set_parameters(values)) << ends.problem();
    EXPECT_NEAR(ends.departs(begin).value, 0, 1e-15);
    EXPECT_NEAR(ends.approaches(end).value, 0, 1e-15);
    const Eigen::VectorXd departs = ends.departs(begin).gradient, approaches = ends.approaches(end).gradient;
    constexpr double step = 1e-6;
    const auto differences = [&](const auto& value) {
        Eigen::VectorXd result(5);
        for (std::size_t i = 0; i < 5; ++i) {
            const auto at = [&](double change) {
                std::vector<double> parameters = values, first = begin, last = end;
                if (i < 3)
                    first[i] += change, last[i] += change;
                else
                    parameters[free[i - 3].place()] += change;
                EXPECT_TRUE(ends.set_parameters(parameters));
                return value(first, last);
            };
            result[static_cast<Eigen::Index>(i)] = (at(step) - at(-step)) / (2 * step);
        }
        return result;
    };
    EXPECT_LT((differences([&](const auto& first, const auto&) { return ends.departs(first).value; }) - departs).norm(),
              1e-8);
    EXPECT_LT(
        (differences([&](const auto&, const auto& last) { return ends.approaches(last).value; }) - approaches).norm(),
        1e-8);
    ends.set_parameters(values);
    EXPECT_FALSE(ends.have_turned());
}

} // namespace graze::homoclinic_ends_test
