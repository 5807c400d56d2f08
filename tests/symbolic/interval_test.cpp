#include "graze/symbolic/interval.hpp"

#include "symbolic/interval_operation.hpp"
#include "symbolic/operation_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace graze::interval_test {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double unit = std::numeric_limits<double>::epsilon();

constexpr Operation arithmetic[] = {Operation::add, Operation::subtract, Operation::multiply, Operation::divide,
                                    Operation::power};
constexpr Operation functions[] = {Operation::negate, Operation::sqrt, Operation::exp,  Operation::log,
                                   Operation::sin,    Operation::cos,  Operation::tan,  Operation::asin,
                                   Operation::acos,   Operation::atan, Operation::sinh, Operation::cosh,
                                   Operation::tanh,   Operation::erf};

Interval apply(Operation operation, const Interval& a, const Interval& b = {}) {
    return enclose_operation(operation, a, b, false);
}

/// More digits than the intervals have.
long double exact(Operation operation, long double a, long double b = 0) {
    return testing::OperationList::apply(operation, a, b);
}

/// Ends of all magnitudes and signs; zeros, whole numbers, and intervals without extent too.
class RandomIntervals {
public:
    Interval next() {
        const double a = number(), b = engine_() % 6 == 0 ? a : number();
        return {std::min(a, b), std::max(a, b)};
    }
    double within(const Interval& a) {
        if (engine_() % 8 == 0)
            return engine_() % 2 ? a.lower : a.upper;
        return std::clamp(std::lerp(a.lower, a.upper, share()), a.lower, a.upper);
    }

private:
    double share() { return std::uniform_real_distribution<>(0, 1)(engine_); }
    double number() {
        const double sign = engine_() % 2 ? 1 : -1;
        switch (engine_() % 8) {
        case 0:
            return 0;
        case 1:
            return static_cast<double>(engine_() % 7) - 3;
        case 2:
            return sign * std::exp(60 * share() - 30);
        default:
            return sign * 3 * share();
        }
    }
    std::mt19937 engine_{7};
};

/// Checks that an interval contains a value known to the digits of long double.
void expect_contains(const Interval& bounds, long double value, const char* what, int which) {
    if (std::isnan(value))
        return; // undefined there
    const long double error = 4 * std::numeric_limits<long double>::epsilon() * std::abs(value);
    EXPECT_LE(bounds.lower, value + error) << what << which;
    EXPECT_GE(bounds.upper, value - error) << what << which;
}

TEST(IntervalTest, ContainsWhatOperationsGive) {
    RandomIntervals random;
    for (int trial = 0; trial < 4000; ++trial) {
        const Interval a = random.next(), b = random.next();
        for (const auto operation : arithmetic) {
            const Interval result = apply(operation, a, b);
            EXPECT_FALSE(std::isnan(result.lower) || std::isnan(result.upper));
            for (int sample = 0; sample < 6; ++sample)
                if (const long double value = exact(operation, random.within(a), random.within(b));
                    std::isfinite(value))
                    expect_contains(result, value, "arithmetic ", static_cast<int>(operation));
        }
        for (const auto operation : functions) {
            const Interval result = apply(operation, a);
            EXPECT_FALSE(std::isnan(result.lower) || std::isnan(result.upper));
            for (int sample = 0; sample < 6; ++sample)
                if (const long double value = exact(operation, random.within(a)); std::isfinite(value))
                    expect_contains(result, value, "function ", static_cast<int>(operation));
        }
    }
}

TEST(IntervalTest, IsTight) {
    // At a point, the ends are next to the result for arithmetic, and some units apart for functions; a power with a
    // negative whole exponent is a quotient besides.
    RandomIntervals random;
    for (int trial = 0; trial < 1000; ++trial) {
        const Interval a = Interval::point(random.within({0.1, 0.9})), b = Interval::point(random.within({-3, 3}));
        for (const auto operation : arithmetic)
            EXPECT_LE(apply(operation, a, b).width(),
                      (operation == Operation::power ? 12 : 2) * unit * apply(operation, a, b).magnitude());
        for (const auto operation : functions)
            EXPECT_LE(apply(operation, a).width(), 9 * unit * apply(operation, a).magnitude());
    }
    // Ranges are those of the function, wherever its extremes are.
    const auto range = [](Operation operation, Interval a, double lower, double upper) {
        const Interval result = apply(operation, a);
        EXPECT_NEAR(result.lower, lower, 16 * unit * std::abs(upper)) << static_cast<int>(operation);
        EXPECT_NEAR(result.upper, upper, 16 * unit * std::abs(upper)) << static_cast<int>(operation);
    };
    range(Operation::sin, {0.1, 3}, std::sin(0.1), 1);
    range(Operation::sin, {0.1, 1}, std::sin(0.1), std::sin(1));
    range(Operation::sin, {-2, -1}, -1, std::sin(-1));
    range(Operation::cos, {-1, 2}, std::cos(2), 1);
    range(Operation::cos, {3, 4}, -1, std::cos(4));
    range(Operation::cos, {7, 8}, std::cos(8), std::cos(7));
    range(Operation::tan, {-1, 1.5}, std::tan(-1), std::tan(1.5));
    range(Operation::cosh, {-1, 2}, 1, std::cosh(2));
    range(Operation::acos, {-0.5, 0.25}, std::acos(0.25), std::acos(-0.5));
}

TEST(IntervalTest, ReducesLargeAngles) {
    // Near 1e15 the extremes are still told apart; beyond, an angle may be any.
    const double large = 1e9;
    const Interval here = apply(Operation::sin, Interval::point(large));
    EXPECT_TRUE(here.contains(std::sin(large)));
    EXPECT_LT(here.width(), 1e-14);
    for (const auto operation : {Operation::sin, Operation::cos})
        for (const Interval angle :
             {Interval::point(1e300), Interval{1e17, 2e17}, Interval{-3, 4}, Interval::entire()}) {
            EXPECT_EQ(apply(operation, angle).lower, -1);
            EXPECT_EQ(apply(operation, angle).upper, 1);
        }
    EXPECT_FALSE(apply(Operation::tan, Interval::point(1e300)).bounded());
}

TEST(IntervalTest, SaysWhatIsUndefinedOrUnbounded) {
    // Nowhere defined: empty.
    EXPECT_TRUE(apply(Operation::sqrt, {-2, -1}).empty());
    EXPECT_TRUE(apply(Operation::log, {-2, 0}).empty());
    EXPECT_TRUE(apply(Operation::asin, {2, 3}).empty());
    EXPECT_TRUE(apply(Operation::power, {-2, -1}, {0.5, 0.5}).empty());
    EXPECT_TRUE(apply(Operation::power, {0, 0}, {-1.5, -0.5}).empty());
    EXPECT_TRUE((Interval{1, 2} / Interval{0, 0}).empty());
    EXPECT_TRUE((Interval{1, 2} + apply(Operation::sqrt, {-2, -1})).empty());
    // Defined in part: the values of that part, and the mark that there is another.
    const auto part = [](const Interval& result, double lower, double upper) {
        EXPECT_FALSE(result.continuous);
        EXPECT_LE(result.lower, lower);
        EXPECT_GE(result.upper, upper);
        if (std::isfinite(lower)) {
            EXPECT_NEAR(result.lower, lower, 16 * unit);
        }
        if (std::isfinite(upper)) {
            EXPECT_NEAR(result.upper, upper, 16 * unit);
        }
    };
    part(apply(Operation::sqrt, {-1, 4}), 0, 2);
    part(apply(Operation::log, {-1, 1}), -infinite, 0);
    part(apply(Operation::log, {0, 1}), -infinite, 0);
    part(apply(Operation::acos, {0, 2}), 0, std::numbers::pi / 2);
    part(apply(Operation::tan, {1, 2}), -infinite, infinite);
    part(apply(Operation::power, {-1, 4}, {0.5, 0.5}), 0, 2);
    part(apply(Operation::power, {-1, 2}, {-1, -1}), -infinite, infinite);
    part(apply(Operation::power, {-1, 2}, {-2, -2}), 0.25, infinite);
    part(Interval{1, 2} / Interval{-1, 1}, -infinite, infinite);
    part(Interval{1, 2} / Interval{0, 4}, 0.25, infinite);
    part(Interval{1, 2} / Interval{-4, 0}, -infinite, -0.25);
    // Defined everywhere.
    for (const Interval& result : {apply(Operation::sqrt, {0, 4}), apply(Operation::power, {-2, 3}, {3, 3}),
                                   Interval{1, 2} / Interval{1, 2}, apply(Operation::tan, {-1, 1})})
        EXPECT_TRUE(result.continuous && result.bounded());
    // Overflow is without bound, not undefined, and 0 times it is 0.
    const Interval huge = apply(Operation::exp, {0, 1e6});
    EXPECT_EQ(huge.upper, infinite);
    EXPECT_TRUE((Interval{0, 0} * huge).is_point(0));
    EXPECT_LT(apply(Operation::exp, {1e6, 2e6}).lower, infinite);
    EXPECT_EQ((Interval{-1e300, 1} * Interval{1e300, 1e300}).lower, -infinite);
}

TEST(IntervalTest, KeepsSigns) {
    // An end that is exactly 0 stays, since its quotient would have both signs otherwise.
    EXPECT_EQ((Interval{0, 2} * Interval{3, 4}).lower, 0);
    EXPECT_EQ(enclose_operation(Operation::multiply, {-1, 2}, {-1, 2}, true).lower, 0);
    EXPECT_EQ(apply(Operation::power, {-1, 2}, {2, 2}).lower, 0);
    EXPECT_EQ(apply(Operation::sqrt, {0, 2}).lower, 0);
    EXPECT_EQ(apply(Operation::sin, {0, 1}).lower, 0);
    EXPECT_EQ(apply(Operation::log, {1, 2}).lower, 0);
    // Results too small for a number have a sign, and are not 0.
    const Interval tiny = Interval{1e-200, 1} * Interval{1e-200, 1};
    EXPECT_EQ(tiny.lower, 0);
    EXPECT_LT((Interval{-1e-200, -1e-200} * Interval{1e-200, 1e-200}).lower, 0);
    EXPECT_GT((Interval{1e-200, 1e-200} * Interval{1e-200, 1e-200}).upper, 0);
    // Sums that are numbers are exact.
    EXPECT_TRUE((Interval{1, 1} + Interval{2, 2}).is_point(3));
    EXPECT_FALSE((Interval{1, 1} + Interval{1e-20, 1e-20}).is_point(1));
}

TEST(IntervalTest, QuotientsSkipTheGap) {
    // 1/q for q near 0 is beyond 2 on either side.
    const Interval divisor{-0.5, 0.25};
    const auto met = [&](Interval within, Interval dividend) { return intersect_quotient(within, dividend, divisor); };
    EXPECT_TRUE(met({-1, 1}, {1, 1}).empty());
    EXPECT_NEAR(met({-1, 9}, {1, 1}).lower, 4, 1e-14);
    EXPECT_EQ(met({-1, 9}, {1, 1}).upper, 9);
    EXPECT_NEAR(met({-9, 1}, {1, 1}).upper, -2, 1e-14);
    EXPECT_EQ(met({-9, 9}, {1, 1}).width(), 18); // the hull of two parts
    EXPECT_EQ(met({-1, 1}, {-1, 1}).width(), 2);
    EXPECT_TRUE(intersect_quotient({-1, 1}, {1, 1}, {0, 0}).empty());
}

TEST(IntervalTest, NarrowingLosesNoOperands) {
    RandomIntervals random;
    for (int trial = 0; trial < 4000; ++trial) {
        const Interval a = random.next(), b = random.next();
        const double left = random.within(a), right = random.within(b);
        const auto check = [&](Operation operation, bool same) {
            const Interval value =
                enclose_operation(operation, Interval::point(left), Interval::point(same ? left : right), same);
            if (value.empty() || !value.bounded())
                return;
            const Interval result = hull(value, value * Interval{0.5, 1.25});
            Interval x = a, y = same ? a : b;
            if (operation == Operation::power)
                y = Interval::point(right);
            narrow_operands(operation, result, x, same ? x : y, same);
            EXPECT_TRUE(x.contains(left)) << static_cast<int>(operation) << " " << left << " " << right;
            if (!same) {
                EXPECT_TRUE(y.contains(right)) << static_cast<int>(operation) << " " << left << " " << right;
            }
        };
        for (const auto operation : arithmetic)
            check(operation, false);
        check(Operation::multiply, true);
        for (const auto operation : functions)
            check(operation, true);
    }
}

TEST(IntervalTest, NarrowingInverts) {
    const auto narrowed = [](Operation operation, Interval result, Interval operand, Interval right = {}) {
        narrow_operands(operation, result, operand, right, false);
        return operand;
    };
    const auto expect = [](const Interval& result, double lower, double upper) {
        EXPECT_NEAR(result.lower, lower, 1e-11);
        EXPECT_NEAR(result.upper, upper, 1e-11);
    };
    expect(narrowed(Operation::sqrt, {-1, 2}, {-9, 9}), 0, 4);
    expect(narrowed(Operation::exp, {1, std::exp(2)}, {-9, 9}), 0, 2);
    expect(narrowed(Operation::log, {0, 1}, {-9, 9}), 1, std::numbers::e);
    expect(narrowed(Operation::power, {4, 9}, {-9, 2.5}, {2, 2}), -3, 2.5);
    expect(narrowed(Operation::power, {-8, 27}, {-9, 9}, {3, 3}), -2, 3);
    expect(narrowed(Operation::power, {0.25, 1}, {0, 9}, {-2, -2}), 1, 2);
    expect(narrowed(Operation::power, {8, 27}, {-9, 99}, {1.5, 1.5}), 4, 9);
    EXPECT_TRUE(narrowed(Operation::power, {-2, -1}, {-9, 9}, {2, 2}).empty());
    EXPECT_TRUE(narrowed(Operation::exp, {-2, -1}, {-9, 9}).empty());
    // Beside its pole the tangent has large values only.
    EXPECT_TRUE(narrowed(Operation::tan, {-5, 5}, {1.5, 1.6}).empty());
    EXPECT_FALSE(narrowed(Operation::tan, {-5, 50}, {1.5, 1.6}).empty());
}

} // namespace graze::interval_test
