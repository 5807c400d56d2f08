#include "graze/design/wish_list.hpp"

#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

namespace graze::wish_list_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double gravity = 9.81;

/// A mass on a spring, in units that make numbers of any size: k = unit kg / s^2, m = unit kg.
struct SpringMass {
    double unit = 1, length = 1;
    bool derivatives = true;

    Want frequency(double least, double most) const {
        return {"frequency", least, most, 1, [*this](std::span<const double> d) {
                    const double f = std::sqrt(d[0] / d[1]) / (2 * std::numbers::pi);
                    WantedValue result{f, {}, {}};
                    if (derivatives)
                        result.gradient = {f / (2 * d[0]), -f / (2 * d[1])};
                    return result;
                }};
    }
    Want deflection(double least, double most) const {
        return {"deflection", least / length, most / length, 1e-3 / length, [*this](std::span<const double> d) {
                    const double x = d[1] * gravity / d[0] / length;
                    WantedValue result{x, {}, {}};
                    if (derivatives)
                        result.gradient = {-x / d[0], x / d[1]};
                    return result;
                }};
    }
    Want mass(double least, double most) const {
        return {"mass", least * unit, most * unit, unit, [](std::span<const double> d) {
                    return WantedValue{d[1], {0, 1}, {}};
                }};
    }
    WishList wishes(std::vector<Want> wants) const {
        return {{{"k", 100 * unit, 10 * unit, 1000 * unit, 100 * unit}, {"m", unit, 0.1 * unit, 10 * unit, unit}},
                std::move(wants)};
    }
};

const SpringMass all_units[] = {{1, 1, true}, {1e-9, 1e-9, true}, {1e6, 1e6, true}, {1e-9, 1e6, false}, {1, 1, false}};

/// Minimum of a function of one variable by golden section, independent of the solver under test.
template <class F>
double least_place(F f, double low, double high) {
    const double ratio = (std::sqrt(5.0) - 1) / 2;
    for (int k = 0; k < 200; ++k) {
        const double a = high - ratio * (high - low), b = low + ratio * (high - low);
        (f(a) < f(b) ? high : low) = f(a) < f(b) ? b : a;
    }
    return (low + high) / 2;
}

TEST(WishList, OneRequiredValueIsMetByTheClosestDesign) {
    // All k = (2 pi f)^2 m have the frequency; the closest to (1, 1), in scales, is on a line through the origin.
    for (const SpringMass& one : all_units) {
        const FoundDesign found = design_for(one.wishes({one.frequency(2, 2)}));
        ASSERT_EQ(found.outcome, WishOutcome::met) << found.reason;
        EXPECT_NEAR(*found.wants[0].value, 2, 1e-9); // the tolerance
        const double slope = std::pow(4 * std::numbers::pi, 2) / 100;
        // An error of 1e-16 in the distance is one of its root, 1e-8, in position.
        const double m = (1 + slope) / (1 + slope * slope);
        EXPECT_NEAR(found.dimensions[1].value / one.unit, m, 1e-6);
        EXPECT_NEAR(found.dimensions[0].value / one.unit, 100 * slope * m, 1e-4);
        EXPECT_NEAR(found.distance, std::abs(slope - 1) / std::hypot(slope, 1), 1e-9);
        EXPECT_TRUE(found.wants[0].binds && found.wants[0].met && found.stationary);
        EXPECT_FALSE(found.dimensions[0].binds || found.dimensions[1].binds);
    }
}

TEST(WishList, WeightsAreDerivativesOfTheDistance) {
    const SpringMass one;
    const FoundDesign found = design_for(one.wishes({one.frequency(2, infinity)}));
    const double step = 1e-4;
    const double above = design_for(one.wishes({one.frequency(2 + step, infinity)})).distance,
                 below = design_for(one.wishes({one.frequency(2 - step, infinity)})).distance;
    EXPECT_NEAR(found.wants[0].weight, (above - below) / (2 * step), 1e-6); // error: third derivative times step^2
}

TEST(WishList, AsManyRequiredValuesAsDimensionsHaveOneDesign) {
    // A deflection of 4 mm fixes k / m, and the mass is given.
    for (const SpringMass& one : all_units) {
        const FoundDesign found = design_for(one.wishes({one.deflection(0.04, 0.04), one.mass(2, 2)}));
        ASSERT_EQ(found.outcome, WishOutcome::met) << found.reason;
        EXPECT_NEAR(found.dimensions[1].value / one.unit, 2, 1e-8);
        EXPECT_NEAR(found.dimensions[0].value / one.unit, 2 * gravity / 0.04, 1e-5); // 1e-9 scales of 1 mm
    }
}

TEST(WishList, RequirementsThatTheStartMeetsKeepTheStart) {
    const SpringMass one;
    const FoundDesign found = design_for(one.wishes({one.frequency(1, 2), one.mass(0, 3)}));
    EXPECT_EQ(found.outcome, WishOutcome::met);
    EXPECT_EQ(found.distance, 0);
    EXPECT_EQ(found.evaluations, 1U);
    EXPECT_FALSE(found.wants[0].binds || found.wants[1].binds);
    const FoundDesign none = design_for(one.wishes({}));
    EXPECT_EQ(none.outcome, WishOutcome::met);
    EXPECT_EQ(none.dimensions[0].value, 100);
}

TEST(WishList, ContradictingRequirementsShareTheViolation) {
    // Both are functions of k / m alone: 2 Hz, whose deflection would be 62 mm, and 40 mm. The largest violation is
    // least where both are violated equally.
    for (const SpringMass& one : all_units) {
        const FoundDesign found =
            design_for(one.wishes({one.frequency(2, 2), one.deflection(0.04, 0.04), one.mass(3, 4)}));
        ASSERT_EQ(found.outcome, WishOutcome::unmet) << found.reason;
        const auto largest = [](double ratio) {
            return std::max(std::abs(std::sqrt(ratio) / (2 * std::numbers::pi) - 2),
                            std::abs(gravity / ratio - 0.04) / 1e-3);
        };
        const double ratio = least_place(largest, 100, 300);
        EXPECT_NEAR(found.violation, largest(ratio), 1e-7);
        EXPECT_NEAR(found.dimensions[0].value / found.dimensions[1].value, ratio, 1e-5);
        EXPECT_TRUE(found.wants[0].binds && found.wants[1].binds && found.stationary);
        EXPECT_NEAR(found.wants[0].weight + found.wants[1].weight, 1, 1e-6);
        // A requirement without a conflict is met, though missing it would not change the largest violation.
        EXPECT_TRUE(found.wants[2].met);
        EXPECT_FALSE(found.wants[2].binds);
        EXPECT_NE(found.reason.find("in the way: 'frequency' (2 is wanted), 'deflection' ("), std::string::npos)
            << found.reason;
    }
}

TEST(WishList, ViolationsAreWeightedByImportance) {
    const auto at = [](std::span<const double> d) { return WantedValue{d[0], {1}, {}}; };
    WishList list{{{"x", 2, 0, 10, 1}}, {{"one", 1, 1, 0, at}, {"three", 3, 3, 0, at}}};
    // (x - 1)/1 = (3 - x)/3, and with the second weighted threefold: x - 1 = 3 - x.
    FoundDesign found = design_for(list);
    EXPECT_EQ(found.outcome, WishOutcome::unmet);
    EXPECT_NEAR(found.dimensions[0].value, 1.5, 1e-9);
    list.wants[1].importance = 3;
    found = design_for(list);
    EXPECT_NEAR(found.dimensions[0].value, 2, 1e-9);
    EXPECT_NEAR(found.violation, 1, 1e-9);
    EXPECT_EQ(words_of(list.wants[1], found.wants[1]),
              "not met: 3 is wanted, 33.3 percent off, counted 3 times, binds");
    EXPECT_EQ(found.reason,
              "no device near this one comes closer; in the way: 'one' (1 is wanted), 'three' (3 is wanted)");
    list.wants[1].importance = 0;
    EXPECT_THROW(design_for(list), InputError);
}

TEST(WishList, ASearchThatEndsEarlyNamesWhatIsMissed) {
    const SpringMass spring;
    WishList list = spring.wishes({spring.frequency(2, 2), spring.deflection(0, 1e-3)});
    list.wants[0].text = "the frequency";
    WishOptions options;
    options.evaluations = 2;
    const FoundDesign found = design_for(list, options);
    ASSERT_EQ(found.outcome, WishOutcome::unfinished);
    EXPECT_NE(
        found.reason.find("2 devices were tried, as many as are allowed; the best of them misses the frequency (2 "
                          "is wanted)"),
        std::string::npos)
        << found.reason;
}

TEST(WishList, ATooNarrowRangeBinds) {
    // The largest k and the least m give sqrt(1000 / 0.1) / 2 pi = 15.9 Hz.
    for (const SpringMass& one : all_units) {
        const FoundDesign found = design_for(one.wishes({one.frequency(20, infinity)}));
        ASSERT_EQ(found.outcome, WishOutcome::unmet) << found.reason;
        EXPECT_TRUE(found.dimensions[0].at_highest && found.dimensions[1].at_lowest);
        EXPECT_TRUE(found.dimensions[0].binds && found.dimensions[1].binds && found.wants[0].binds);
        const double best = std::sqrt(10000.0) / (2 * std::numbers::pi);
        EXPECT_NEAR(found.violation, 20 - best, 1e-9);
        EXPECT_NEAR(found.dimensions[0].weight, best / 20, 1e-3 * best / 20); // f / 2k by 100
        EXPECT_NEAR(found.dimensions[1].weight, best / 0.2, 1e-3 * best / 0.2);
    }
}

TEST(WishList, ADuplicateRequirementChangesNothing) {
    const SpringMass one;
    const FoundDesign found = design_for(one.wishes({one.frequency(2, 2), one.frequency(2, 2), one.frequency(2, 9)}));
    ASSERT_EQ(found.outcome, WishOutcome::met) << found.reason;
    EXPECT_NEAR(found.distance, design_for(one.wishes({one.frequency(2, 2)})).distance, 1e-8);
    EXPECT_TRUE(found.wants[0].binds && found.wants[1].binds && found.wants[2].binds);
}

TEST(WishList, AValueThatJustTouchesItsLimitIsFound) {
    // (x - 1)^2 + (y - 2)^2 <= 0 has one design, at which no multipliers exist.
    const Want touch{"touch", -infinity, 0, 1, [](std::span<const double> d) {
                         const double x = d[0] - 1, y = d[1] - 2;
                         return WantedValue{x * x + y * y, {2 * x, 2 * y}, {}};
                     }};
    const FoundDesign found = design_for({{{"x", 0, -5, 5, 1}, {"y", 0, -5, 5, 1}}, {touch}});
    ASSERT_EQ(found.outcome, WishOutcome::met) << found.reason;
    EXPECT_NEAR(found.dimensions[0].value, 1, 1e-4); // the root of the tolerance is 3e-5
    EXPECT_NEAR(found.dimensions[1].value, 2, 1e-4);
}

TEST(WishList, ALeastViolationInsideTheRangesIsFound) {
    // x^2 + 10 y^2 + 1 <= 0.25: by 0.75 at least.
    const Want bowl{"bowl", -infinity, 0.25, 1, [](std::span<const double> d) {
                        return WantedValue{d[0] * d[0] + 10 * d[1] * d[1] + 1, {2 * d[0], 20 * d[1]}, {}};
                    }};
    const FoundDesign found = design_for({{{"x", 3, -5, 5, 1}, {"y", 2, -5, 5, 1}}, {bowl}});
    ASSERT_EQ(found.outcome, WishOutcome::unmet);
    EXPECT_NEAR(found.violation, 0.75, 1e-9);
    EXPECT_NEAR(found.dimensions[0].value, 0, 1e-5);
    EXPECT_TRUE(found.stationary);
}

TEST(WishList, TheClosestOfSeveralDesignsIsFound) {
    // sin is 0 at all multiples of pi; the closest to 4 is pi. Beyond a maximum the search must restart.
    const auto curve = [](double level) {
        return Want{"curve", level, level, 1, [](std::span<const double> d) {
                        return WantedValue{std::sin(d[0]), {std::cos(d[0])}, {}};
                    }};
    };
    const FoundDesign found = design_for({{{"x", 4, 0, 20, 1}}, {curve(0)}});
    ASSERT_EQ(found.outcome, WishOutcome::met);
    EXPECT_NEAR(found.dimensions[0].value, std::numbers::pi, 1e-8);
    // x^3 - 3 x = 5 is met only beyond the maximum at -1, on whose other side the start lies.
    const Want hill{"hill", 5, 5, 1, [](std::span<const double> d) {
                        return WantedValue{d[0] * d[0] * d[0] - 3 * d[0], {3 * d[0] * d[0] - 3}, {}};
                    }};
    const FoundDesign beyond = design_for({{{"x", -1.5, -3, 3, 1}}, {hill}});
    ASSERT_EQ(beyond.outcome, WishOutcome::met) << beyond.reason;
    EXPECT_NEAR(beyond.dimensions[0].value, 2.279018786165, 1e-9); // by the cubic formula
}

/// sqrt(x - 1), which does not exist below 1; the second dimension has no effect.
Want root(double least, double most) {
    return {"root", least, most, 1, [](std::span<const double> d) {
                if (d[0] < 1)
                    return WantedValue{{}, {}, "there is no root"};
                const double value = std::sqrt(d[0] - 1);
                return WantedValue{value, {1 / (2 * value), 0}, {}};
            }};
}

TEST(WishList, ValuesThatDoNotExistEverywhereAreHandled) {
    for (const double start : {5.0, 1.5, 0.5, -9.5}) { // the last two have no value
        const FoundDesign found = design_for({{{"x", start, -10, 10, 1}, {"y", 0, -1, 1, 1}}, {root(0.1, 0.1)}});
        ASSERT_EQ(found.outcome, WishOutcome::met) << found.reason;
        EXPECT_NEAR(found.dimensions[0].value, 1.01, 1e-8);
        EXPECT_NEAR(found.dimensions[1].value, 0, 1e-6);
    }
}

TEST(WishList, TheEdgeOfExistenceIsReported) {
    // x alone: 1 + x is least at the edge x = 0, beyond which there is no value.
    const Want edge{"edge", -infinity, 0.5, 1, [](std::span<const double> d) {
                        if (d[0] < 0)
                            return WantedValue{{}, {}, "nothing is there"};
                        return WantedValue{1 + d[0], {1}, {}};
                    }};
    const FoundDesign found = design_for({{{"x", 3, -4, 4, 1}}, {edge}});
    EXPECT_EQ(found.outcome, WishOutcome::unmet);
    EXPECT_FALSE(found.stationary);
    EXPECT_NEAR(found.violation, 0.5, 1e-6);
    EXPECT_GT(found.missing, 0U);
    EXPECT_NE(found.reason.find("nothing is there"), std::string::npos) << found.reason;

    const FoundDesign none = design_for({{{"x", -3, -4, -1, 1}}, {edge}});
    EXPECT_EQ(none.outcome, WishOutcome::nowhere);
    EXPECT_EQ(none.evaluations, none.missing);
}

TEST(WishList, AKnownFeasibleDesignBoundsTheDistance) {
    // Products of powers of dimensions in units from nano to mega; the limits are drawn so that a known design meets
    // them all.
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> exponent(-2, 2), share(0, 1);
    for (int trial = 0; trial < 100; ++trial) {
        const std::size_t n = 2 + static_cast<std::size_t>(trial % 4);
        WishList wishes;
        std::vector<double> hidden;
        double farthest = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double unit = std::pow(10, std::floor(-9 + 16 * share(random)));
            wishes.dimensions.push_back({"d", (1 + share(random)) * unit, 0.5 * unit, 3 * unit, unit});
            hidden.push_back((0.5 + 2.5 * share(random)) * unit);
            farthest = std::hypot(farthest, (hidden[i] - wishes.dimensions[i].start) / unit);
        }
        for (std::size_t j = 0; j < n; ++j) {
            std::vector<double> powers(n);
            for (double& one : powers)
                one = exponent(random);
            const bool derivatives = share(random) < 0.5;
            const auto value = [powers, derivatives](std::span<const double> d) {
                double sum = 0;
                for (std::size_t i = 0; i < powers.size(); ++i)
                    sum += powers[i] * std::log(d[i]);
                WantedValue result{std::exp(sum), {}, {}};
                for (std::size_t i = 0; derivatives && i < powers.size(); ++i)
                    result.gradient.push_back(powers[i] * *result.value / d[i]);
                return result;
            };
            const double there = *value(hidden).value;
            const bool exact = share(random) < 0.3, least = share(random) < 0.5;
            wishes.wants.push_back(
                {"w", exact || least ? there : -infinity, exact || !least ? there : infinity, 0, value});
        }
        const FoundDesign found = design_for(wishes);
        ASSERT_EQ(found.outcome, WishOutcome::met) << trial << ": " << found.reason;
        EXPECT_LE(found.distance, farthest * (1 + 1e-6) + 1e-9) << trial; // requirements are met to 1e-9
        EXPECT_TRUE(found.stationary) << trial;
    }
}

TEST(WishList, ADimensionWithoutRangeStays) {
    const SpringMass one;
    WishList wishes = one.wishes({one.frequency(2, 2)});
    wishes.dimensions[0].lowest = wishes.dimensions[0].highest = 100;
    const FoundDesign found = design_for(wishes);
    ASSERT_EQ(found.outcome, WishOutcome::met) << found.reason;
    EXPECT_EQ(found.dimensions[0].value, 100);
    EXPECT_NEAR(found.dimensions[1].value, 100 / std::pow(4 * std::numbers::pi, 2), 1e-8);
    EXPECT_TRUE(found.dimensions[0].binds);

    wishes.dimensions.clear(); // no free dimension
    wishes.wants = {{"fixed", 1, 1, 1, [](std::span<const double>) { return WantedValue{3, {}, {}}; }}};
    const FoundDesign fixed = design_for(wishes);
    EXPECT_EQ(fixed.outcome, WishOutcome::unmet);
    EXPECT_EQ(fixed.violation, 2);
}

TEST(WishList, EndsAtItsLimitsAndWhenInterrupted) {
    const SpringMass one;
    WishOptions options;
    options.evaluations = 3;
    const FoundDesign few = design_for(one.wishes({one.frequency(9, 9), one.mass(5, 5)}), options);
    EXPECT_EQ(few.outcome, WishOutcome::unfinished);
    EXPECT_EQ(few.evaluations, 3U);
    int asked = 0;
    options = {};
    options.interrupted = [&] { return ++asked > 4; };
    const FoundDesign stopped = design_for(one.wishes({one.frequency(9, 9), one.mass(5, 5)}), options);
    EXPECT_EQ(stopped.outcome, WishOutcome::interrupted);
    EXPECT_TRUE(stopped.wants[0].value);

    // Even with noise instead of a value it ends.
    unsigned noise = 1;
    const Want random{"noise", 2, 2, 1, [&](std::span<const double>) {
                          noise = noise * 1664525U + 1013904223U;
                          return WantedValue{noise / 4294967296.0, {}, {}};
                      }};
    options = {};
    EXPECT_LE(design_for({{{"x", 0, -1, 1, 1}, {"y", 0, -1, 1, 1}}, {random}}, options).evaluations, 4000U);
}

TEST(WishList, ExceptionsOfCallbacksArePassedOn) {
    const Want broken{"broken", 1, 1, 1, [](std::span<const double> d) -> WantedValue {
                          if (d[0] != 0)
                              throw std::domain_error("broken");
                          return {2, {1}, {}};
                      }};
    EXPECT_THROW(design_for({{{"x", 0, -1, 1, 1}}, {broken}}), std::domain_error);
    const Want wrong{"wrong", 1, 1, 1, [](std::span<const double>) { return WantedValue{2, {1, 2}, {}}; }};
    EXPECT_THROW(design_for({{{"x", 0, -1, 1, 1}}, {wrong}}), InputError);
}

TEST(WishList, RefusesInvalidInput) {
    const SpringMass one;
    const auto with = [&](auto change) {
        WishList wishes = one.wishes({one.frequency(2, 2)});
        change(wishes);
        return wishes;
    };
    EXPECT_THROW(design_for(with([](WishList& w) { w.dimensions[0].start = 1e9; })), InputError);
    EXPECT_THROW(design_for(with([](WishList& w) { w.dimensions[0].scale = -1; })), InputError);
    EXPECT_THROW(design_for(with([](WishList& w) { w.wants[0].least = 3; })), InputError);
    EXPECT_THROW(design_for(with([](WishList& w) { w.wants[0].value = {}; })), InputError);
    EXPECT_THROW(design_for(with([](WishList& w) {
                     w.wants[0].least = -infinity;
                     w.wants[0].most = infinity;
                 })),
                 InputError);
    EXPECT_THROW(design_for(with([](WishList& w) { w.wants[0] = {"zero", 0, 0, 0, w.wants[0].value}; })), InputError);
    WishOptions options;
    options.starts = 0;
    EXPECT_THROW(design_for(one.wishes({}), options), InputError);
}

} // namespace graze::wish_list_test
