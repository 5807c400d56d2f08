// Sines and cosines of jets against those of the standard library in more digits.

#include "tape/problems.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace graze::sine_and_cosine_test {

using testing::Problem;

/// A problem with one constant state, its sine and its cosine.
Problem circle() {
    Problem p;
    const Expression x = p.state("x", 0);
    p.rates = {p.parameter("rate", 1) * p.graph->number(1)};
    p.outputs = {sin(x), cos(x)};
    return p;
}

/// Arguments of all sizes, up to those that are left to the library, and close to multiples of pi/4.
std::vector<double> arguments() {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<double> all{0, 1e-300, 0x1p-30, 0x1p20, -0x1p20, std::nextafter(0x1p20, 2e6), 1e15, -1e300};
    for (int i = 0; i < 40000; ++i) {
        all.push_back(4 * unit(random));
        all.push_back(unit(random) * std::exp2(40 * unit(random)));
        all.push_back(std::round(2e6 * unit(random)) * std::numbers::pi / 4 * (1 + 1e-15 * unit(random)));
    }
    while (all.size() % 16 != 0)
        all.push_back(unit(random));
    return all;
}

double units_in_last_place(double value, long double exact) {
    const auto nearest = static_cast<double>(exact);
    const double unit = std::nextafter(std::abs(nearest), 10) - std::abs(nearest);
    return static_cast<double>(std::abs(static_cast<long double>(value) - exact) / unit);
}

TEST(SineAndCosine, AreAccurateToLessThanOneUnitInTheLastPlace) {
    const Problem p = circle();
    const std::vector<double> all = arguments();
    for (const auto set : testing::supported_sets()) {
        const auto jet = make_jet(p.tape(), 1, LaneKind::single, set);
        jet->set_parameters(p.parameter_values);
        for (const double x : all) {
            jet->begin({&x, 1});
            /// Rounding alone takes half a unit; the sine of long double is accurate to a thousandth of a unit. The
            /// largest error seen in six million arguments is 0.673.
            EXPECT_LE(units_in_last_place(jet->output(0)[0], std::sin(static_cast<long double>(x))), 0.7) << x;
            EXPECT_LE(units_in_last_place(jet->output(1)[0], std::cos(static_cast<long double>(x))), 0.7) << x;
        }
    }
}

TEST(SineAndCosine, LanesEqualASingleNumber) {
    const Problem p = circle();
    const std::vector<double> all = arguments();
    for (const auto set : testing::supported_sets()) {
        const auto single = make_jet(p.tape(), 1, LaneKind::single, set),
                   lanes = make_jet(p.tape(), 1, LaneKind::ensemble, set);
        const auto width = static_cast<std::size_t>(lanes->width());
        for (std::size_t i = 0; i + width <= all.size(); i += width) {
            lanes->begin(std::span(all).subspan(i, width));
            for (std::size_t l = 0; l < width; ++l) {
                const double x = all[i + l];
                single->begin({&x, 1});
                for (const std::size_t output : {std::size_t{0}, std::size_t{1}})
                    ASSERT_EQ(lanes->output(output)[l], single->output(output)[0]) << x << " " << name_of(set);
            }
        }
    }
}

/// NaN and infinities have no sine.
TEST(SineAndCosine, AreNaNForNonFiniteArguments) {
    const Problem p = circle();
    for (const auto set : testing::supported_sets()) {
        const auto jet = make_jet(p.tape(), 1, LaneKind::ensemble, set);
        std::vector<double> states(static_cast<std::size_t>(jet->width()), 0.5);
        states[0] = std::numeric_limits<double>::infinity();
        states[1] = std::numeric_limits<double>::quiet_NaN();
        jet->begin(states);
        EXPECT_TRUE(std::isnan(jet->output(0)[0]) && std::isnan(jet->output(1)[1]));
        EXPECT_NEAR(jet->output(0)[jet->width() - 1], std::sin(0.5), testing::eps);
    }
}

} // namespace graze::sine_and_cosine_test
