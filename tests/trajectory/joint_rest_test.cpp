// Contacts followed by their gaps until all rest, against closed forms and an independent simulation.

#include "trajectory/joint_rest.hpp"

#include "closed_form.hpp"
#include "stack_of_balls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace graze;
using namespace graze::testing;

namespace joint_rest_test {

NearbyContacts contacts_of(const Stack& stack) {
    NearbyContacts result;
    for (std::size_t i = 0; i < stack.size(); ++i) {
        result.gap.push_back(stack.gap[i]);
        result.rate.push_back(stack.velocity[i] - (i > 0 ? stack.velocity[i - 1] : 0));
        result.acceleration.push_back(i > 0 ? 0 : -stack.gravity);
        result.restitution.push_back(stack.restitution[i]);
        for (std::size_t j = 0; j < stack.size(); ++j)
            result.response.push_back(i == j ? 1 / stack.mass[i] + (i > 0 ? 1 / stack.mass[i - 1] : 0)
                                      : i + 1 == j || j + 1 == i ? -1 / stack.mass[std::min(i, j)]
                                                                 : 0);
    }
    return result;
}

/// One ball: impacts at a geometric series of times, sqrt(2 h/g) (1 + e)/(1 - e) in all.
TEST(JointRest, OfOneBall) {
    for (const double e : {0.0, 0.5, 0.9, 0.999, 0.999999}) {
        const JointRest rest = joint_rest(contacts_of({{1}, {e}, {1}, {0}}), 1000);
        ASSERT_EQ(rest.fate, JointRest::Fate::rest);
        EXPECT_NEAR(rest.duration, std::sqrt(2 / 9.81) * (1 + e) / (1 - e), 1e-14 * rest.duration);
    }
}

/// Without losses nothing comes to rest; without forces two contacts that separate do not return.
TEST(JointRest, SaysWhereItIsNot) {
    EXPECT_EQ(joint_rest(contacts_of({{1, 2}, {1, 1}, {1, 1}, {0, 0}}), 10000).fate, JointRest::Fate::undecided);
    EXPECT_EQ(joint_rest(contacts_of({{1, 1}, {0.5, 0.5}, {1, 1}, {1, 2}, 0}), 10000).fate, JointRest::Fate::leaves);
    EXPECT_EQ(joint_rest(contacts_of({{1, 1}, {0.5, 0.5}, {1, 1}, {0, 0}, -9.81}), 10000).fate,
              JointRest::Fate::leaves);
}

/// Two balls that fly towards a wall without gravity: up to e = 3 - 2 sqrt(2) infinitely many impacts bring both to
/// rest at it, and beyond they fly back. The impulses are those that take away all momentum.
TEST(JointRest, CollapsesAtAWall) {
    for (const double e : {0.01, 0.1, 0.17}) {
        const Stack stack{{1, 1}, {e, e}, {1, 0.5}, {-1, -2}, 0};
        const JointRest rest = joint_rest(contacts_of(stack), 10000);
        ASSERT_EQ(rest.fate, JointRest::Fate::rest) << e;
        const double expected = static_cast<double>(StackReference(stack).rest());
        EXPECT_NEAR(rest.duration, expected, 1e-12 * expected);
        EXPECT_NEAR(rest.impulses[0], 3, 1e-14);
        EXPECT_NEAR(rest.impulses[1], 2, 1e-14);
    }
    EXPECT_EQ(joint_rest(contacts_of({{1, 1}, {0.18, 0.18}, {1, 0.5}, {-1, -2}, 0}), 10000).fate,
              JointRest::Fate::leaves);
}

TEST(JointRestSlow, OfRandomStacksIsThatOfAnIndependentSimulation) {
    Random random(7);
    int compared = 0;
    for (int i = 0; i < 200; ++i) {
        Stack stack;
        const std::size_t balls = random.chance(0.6) ? 2 : 3;
        const bool equal = random.chance(0.4);
        for (std::size_t k = 0; k < balls; ++k) {
            stack.mass.push_back(equal ? 1 : random.log_uniform(1e-3, 1e3));
            stack.restitution.push_back(random.uniform(0, 0.9));
            stack.gap.push_back(random.chance(0.1) ? 0 : random.uniform(0.1, 1));
            stack.velocity.push_back(random.chance(0.5) ? 0 : random.uniform(-1, 1));
        }
        const double expected = known_rest(stack);
        if (expected < 0)
            continue;
        const JointRest rest = joint_rest(contacts_of(stack), 3'000'000);
        EXPECT_NE(rest.fate, JointRest::Fate::leaves) << i << '\n' << stack.model();
        if (rest.fate != JointRest::Fate::rest)
            continue;
        ++compared;
        EXPECT_NEAR(rest.duration, expected, 1e-11 * expected) << i << '\n' << stack.model();
    }
    EXPECT_GT(compared, 150);
}

} // namespace joint_rest_test
