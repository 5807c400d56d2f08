// Border collisions of maps (H. E. Nusse and J. A. Yorke, 1992) as orbits whose guard changes: the fixed points on both
// sides of the border and their bifurcations have closed forms.

#include "follow.hpp"

#include <cmath>
#include <random>
#include <tuple>

namespace graze::border_collision_test {

using namespace graze::testing;

/// x -> trace x + y + mu, y -> -determinant x, with a trace and a determinant for each side of x = 0.
struct Border {
    double left_trace, left_determinant, right_trace, right_determinant;

    double left_fixed_point(double mu) const { return mu / (1 - left_trace + left_determinant); }
    double right_fixed_point(double mu) const { return mu / (1 - right_trace + right_determinant); }
    bool is_nonsmooth_fold() const {
        return (1 - left_trace + left_determinant) * (1 - right_trace + right_determinant) < 0;
    }
    /// Returns the modulus of the larger multiplier of the fixed point on the left.
    double left_multiplier() const {
        const double discriminant = left_trace * left_trace / 4 - left_determinant;
        return discriminant < 0 ? std::sqrt(left_determinant) : std::abs(left_trace / 2) + std::sqrt(discriminant);
    }
};

Model model_of(const Border& border, double mu) {
    std::string text = fmt::format("[parameters]\nmu = {}\n[states]\nx = {}\ny = 0\ns = 0\n[initial]\nmode = 'right'\n",
                                   mu, border.right_fixed_point(mu));
    for (const auto& [side, trace, determinant] : {std::tuple("right", border.right_trace, border.right_determinant),
                                                   std::tuple("left", border.left_trace, border.left_determinant)})
        text += fmt::format(R"toml(
[modes.{0}]
rates = {{ x = 0, y = 0, s = 1 }}
watch = ["tick_{0}"]
[events.tick_{0}]
function = "1 - s"
[jumps.map_{0}]
x = "{1}*x + y + mu"
y = "-({2})*x"
s = 0
)toml",
                            side, trace, determinant) +
                transition(side, fmt::format("tick_{}", side),
                           "[{ when = 'x >= 0', mode = 'right' }, { mode = 'left' }]", fmt::format("map_{}", side));
    return model_from(text);
}

Branch branch_to_the_left(const Border& border) {
    const double mu = border.right_fixed_point(1) > 0 ? 0.2 : -0.2;
    const Model model = model_of(border, mu);
    const double x = border.right_fixed_point(mu);
    const Orbit orbit = given_orbit(model, "right:tick_right", {{x, -border.right_determinant * x, 0}}, {1});
    const BranchSettings settings = in_parameter(model, "mu", -0.5, 0.5, mu > 0 ? -1 : 1);
    return follow_branch(System(model), orbit, settings);
}

TEST(BorderCollision, BranchLeadsToTheFixedPointBeyondOrBackOnTheOtherOne) {
    std::mt19937 random(29);
    std::uniform_real_distribution<double> trace(-2.5, 2.5), determinant(-0.9, 0.9);
    int folds = 0;
    for (int i = 0; i < 40; ++i) {
        const Border border{trace(random), determinant(random), trace(random), determinant(random)};
        SCOPED_TRACE(fmt::format("case {}", i));
        const Branch branch = branch_to_the_left(border);
        ASSERT_EQ(names(branch), "GU BD") << branch.special.front().detail;
        EXPECT_NEAR(branch.special[0].parameter, 0, 1e-12);
        const double from = branch.points.front().parameter, to = branch.points.back().parameter;
        EXPECT_EQ(border.is_nonsmooth_fold(), from * to > 0);
        folds += border.is_nonsmooth_fold() ? 1 : 0;
        const OrbitSolution& last = branch.points.back().solution;
        ASSERT_EQ(last.orbit.segments(), 1U);
        EXPECT_NEAR(last.orbit.starts[0][0], border.left_fixed_point(to), 1e-11);
        EXPECT_TRUE(last.certificate.admissible) << last.certificate.reason;
        EXPECT_NEAR(std::abs(last.multipliers.front()), border.left_multiplier(), 1e-9);
    }
    EXPECT_GT(folds, 5);
    EXPECT_LT(folds, 35);
}

} // namespace graze::border_collision_test
