// All equilibria of a mode in a box of states, against closed forms.

#include "orbit/all_equilibria.hpp"

#include "base/message_of.hpp"
#include "orbits.hpp"
#include "trajectory/model_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace graze::all_equilibria_test {

using namespace graze::testing;
using ::testing::HasSubstr;

EquilibriumSearch found_in(const Model& model, const std::vector<StateBounds>& within) {
    return all_equilibria(System(model), model.initial_mode, within, model.initial_state(), model.parameter_values(),
                          {});
}

/// A plate on a spring attracted across a gap: below the pull-in voltage it has two equilibria before the pole.
Model plate(double gap, double voltage) {
    return OneMode{.parameters =
                       fmt::format("V = {:.17g}\nd = {:.17g}", voltage * std::sqrt(4 * std::pow(gap, 3) / 27), gap),
                   .states = "q = 0\nv = 0",
                   .rates = "q = 'v', v = '-0.3*v - q + V^2/(d - q)^2'"}
        .model();
}

TEST(AllEquilibria, OfAPlateAreTwoBelowPullInAndNoneAbove) {
    for (const double gap : {1.0, 1e-9, 1e6}) {
        const std::vector<StateBounds> box{{0, 0, 0.99 * gap}, {1, -gap, gap}};
        const EquilibriumSearch below = found_in(plate(gap, 0.9), box);
        EXPECT_TRUE(below.complete);
        ASSERT_EQ(below.found.size(), 2U) << gap;
        EXPECT_TRUE(below.undecided.empty());
        for (const OrbitSolution& one : below.found) { // q (1 - q)^2 = 0.81 * 4/27, in units of the gap
            const double q = one.orbit.starts[0][0] / gap;
            EXPECT_NEAR(q * (1 - q) * (1 - q), 0.81 * 4 / 27, 1e-14);
        }
        EXPECT_TRUE(is_stable(below.found[0]));
        EXPECT_FALSE(is_stable(below.found[1]));
        const EquilibriumSearch above = found_in(plate(gap, 1.01), box);
        EXPECT_TRUE(above.complete);
        EXPECT_TRUE(above.found.empty() && above.undecided.empty());
    }
}

TEST(AllEquilibria, LeavesUndecidedHowManyThereAreAtAFold) {
    const EquilibriumSearch search = found_in(plate(1, 1), {{0, 0, 0.99}, {1, -1, 1}});
    EXPECT_TRUE(search.complete);
    EXPECT_EQ(search.found.size() + search.undecided.size(), 1U);
    ASSERT_EQ(search.undecided.size(), 1U);
    EXPECT_NEAR(search.undecided[0].orbit.starts[0][0], 1.0 / 3, 1e-6);
}

TEST(AllEquilibria, OfAPendulumAreCountedOncePerTurn) {
    const Model model = OneMode{.parameters = "g = 9.81",
                                .states = "phi = { initial = 0.5, period = '2*pi' }\nv = 0",
                                .rates = "phi = 'v', v = '-g*sin(phi) - 0.1*v'"}
                            .model();
    const EquilibriumSearch search = found_in(model, {{1, -1, 1}});
    EXPECT_TRUE(search.complete);
    EXPECT_EQ(search.found.size() + search.undecided.size(), 2U);
}

TEST(AllEquilibria, NeedARangeOfEachStateThatMoves) {
    EXPECT_THAT(message_of([] {
                    found_in(plate(1, 0.9), {{0, 0, 0.9}});
                }),
                HasSubstr("the box has no range of state 'v', which moves in mode 'free'; give one: v = "));
}

TEST(AllEquilibria, AreNoneWhereAStateMovesSteadily) {
    const Model model = OneMode{.parameters = "c = 1", .states = "x = 0\ny = 0", .rates = "x = 'c', y = '-y'"}.model();
    const EquilibriumSearch search = found_in(model, {{1, -1, 1}});
    EXPECT_TRUE(search.complete);
    EXPECT_TRUE(search.found.empty());
    EXPECT_EQ(search.problem, "state 'x' moves steadily in mode 'free'");
}

} // namespace graze::all_equilibria_test
