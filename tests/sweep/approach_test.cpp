#include "settle.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace graze::approach_test {

struct Bifurcation {
    const char* name;
    std::function<std::string(double)> map; ///< as a function of the distance from the bifurcation
    std::size_t before, after;              ///< period of the stable orbit before and after the bifurcation; 0: none
    std::vector<double> starts;
};

std::string logistic(double r) {
    return fmt::format("{:.17g}*z*(1 - z)", r);
}

TEST(Approach, OrbitsNextToTheirBifurcationsAreFound) {
    const std::vector<Bifurcation> cases{
        {"flip", [](double e) { return logistic(3 + e); }, 1, 2, {0.3, 0.12}},
        {"flip of a flip", [](double e) { return logistic(1 + std::sqrt(6.0) + e); }, 2, 4, {0.3, 0.12}},
        {"fold of period three", [](double e) { return logistic(1 + std::sqrt(8.0) + e); }, 0, 3, {0.3, 0.12}},
        {"exchange of stability", [](double e) { return logistic(1 + e); }, 1, 1, {0.3, 0.12}},
        {"pitchfork", [](double e) { return fmt::format("z*(1 + {:.17g}) - z^3", e); }, 1, 1, {0.3, 0.12}},
        {"fold", [](double e) { return fmt::format("z + {:.17g} - (z - 1)^2", e); }, 0, 1, {1.3, 1.12}},
        {"hard flip", [](double e) { return fmt::format("-(1 + {:.17g})*z - z^2 + 2*z^3", e); }, 1, 0, {0.09, 0.04}},
    };
    std::size_t settled = 0, all = 0;
    for (const Bifurcation& one : cases)
        for (int exponent = 3; exponent <= 9; ++exponent)
            for (const double side : {-1.0, 1.0})
                for (const double start : one.starts) {
                    const std::size_t period = side < 0 ? one.before : one.after;
                    if (period == 0)
                        continue;
                    const double distance = side * std::pow(10, -exponent);
                    const PointResult result = settle(iterated(one.map(distance), start));
                    ++all;
                    settled += result.label == Label::periodic ? 1 : 0;
                    // Within 1e-8 of a flip both orbits agree to within round-off: no period is better than a wrong
                    // one.
                    if (result.label == Label::periodic) {
                        EXPECT_EQ(result.period, period) << one.name << " " << distance << " " << start;
                    } else {
                        EXPECT_EQ(result.label, Label::unsettled) << one.name << " " << distance << " " << start;
                    }
                }
    EXPECT_GE(static_cast<double>(settled), 0.95 * static_cast<double>(all)) << all;
}

TEST(Approach, NoOrbitIsFoundBeyondAFold) {
    // Beyond folds motions linger where the orbit was.
    for (int exponent = 4; exponent <= 9; ++exponent) {
        const double e = std::pow(10, -exponent);
        const PointResult fold = settle(iterated(fmt::format("z - {:.17g} - (z - 1)^2", e), 1.3));
        EXPECT_NE(fold.label, Label::periodic) << e;
        const PointResult three = settle(iterated(logistic(1 + std::sqrt(8.0) - e), 0.3));
        EXPECT_FALSE(three.label == Label::periodic && three.period == 3) << e;
    }
}

} // namespace graze::approach_test
