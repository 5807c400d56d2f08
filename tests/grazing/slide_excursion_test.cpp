// Slides that are left for a short time: closed forms, and the order of the error against simulation.

#include "graze/grazing/discontinuity_map.hpp"
#include "near_touch.hpp"
#include "trajectory/model_parts.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace graze::slide_excursion_test {

using namespace graze::testing;

/// Returns the state on the surface of an event, at which the touched function is -depth and has zero rate.
std::vector<double> on_surface_at_depth(const System& system, const DiscontinuityMap& map, std::size_t surface,
                                        double depth) {
    const TouchState& touch = map.touch;
    const auto n = static_cast<Eigen::Index>(touch.state.size());
    std::vector<double> state = touch.state;
    for (int iteration = 0; iteration < 40; ++iteration) {
        const auto off = system.event(surface)(inputs_at(touch, state)),
                   edge = system.event(touch.event)(inputs_at(touch, state));
        Eigen::MatrixXd rows(3, n);
        rows.row(0) = Eigen::Map<const Eigen::RowVectorXd>(off.data() + 1, n);
        rows.row(1) = Eigen::Map<const Eigen::RowVectorXd>(edge.data() + 1, n);
        rows.row(2) = Eigen::Map<const Eigen::RowVectorXd>(map.rate_gradient.data(), n);
        const Eigen::Vector3d lack(-off[0], -depth - edge[0], -rate_at(system, touch, state));
        const Eigen::VectorXd step = rows.completeOrthogonalDecomposition().solve(lack);
        for (Eigen::Index i = 0; i < n; ++i)
            state[static_cast<std::size_t>(i)] += step[i];
    }
    return state;
}

/// Returns the largest scaled difference between simulation and map for a motion on the surface that would reach
/// -depth.
double error_at(const Model& model, const DiscontinuityMap& map, std::size_t surface, double depth) {
    const System system(model);
    const double time = 4 * std::sqrt(2 * depth / map.acceleration);
    return error_of_map(system, map, on_surface_at_depth(system, map, surface, depth), depth, time, 1e-16);
}

/// The error of the leading order is of the order depth^(5/2), and without the map it is of the order depth^2.
void expect_order(const Model& model, const DiscontinuityMap& map, const std::string& surface, double depth) {
    ASSERT_EQ(map.order, MapOrder::quadratic) << map.reason;
    const std::size_t event = *model.find_event(surface);
    const double far = error_at(model, map, event, depth), near = error_at(model, map, event, depth / 30);
    EXPECT_GT(std::log(far / near) / std::log(30), 2.4) << far << ' ' << near;
    DiscontinuityMap without = map;
    std::fill(without.direction.begin(), without.direction.end(), 0.0);
    const double all = error_at(model, without, event, depth / 30);
    EXPECT_LT(near, 0.2 * all) << near << ' ' << all;
}

/// On a belt, the velocity relative to it has the rate -h during the excursion, and its integral is 9/2 depth^2/a.
TEST(SlideExcursion, AMassThatLeavesABeltIsAdvancedInClosedForm) {
    const Model model = shipped_with("belt-oscillator", {{"nu", 1.3}, {"amplitude", 1.7}});
    const double theta = -std::asin(1 / (1.3 * 1.7)), a = 1.7 * 1.3 * 1.3 * std::cos(theta);
    const std::vector<double> state{1.7 * std::cos(theta) - 1.5, 1, theta + 2 * std::numbers::pi};
    const DiscontinuityMap map = discontinuity_map(System(model), touch_of(model, "stick", "stick-faster", state));
    ASSERT_EQ(map.order, MapOrder::quadratic) << map.reason;
    EXPECT_NEAR(map.acceleration, a, 1e-14);
    EXPECT_NEAR(map.direction[0], 4.5 / a, 1e-13);
    EXPECT_EQ(map.direction[1], 0);
    EXPECT_EQ(map.direction[2], 0);
    ASSERT_EQ(map.contacts.size(), 2U);
    EXPECT_EQ(model.transitions[map.contacts[0]].label, "stick:faster");
    EXPECT_EQ(model.transitions[map.contacts[1]].label, "faster:belt");
    EXPECT_NEAR(map.time, 3 / a, 1e-13);
    expect_order(model, map, "belt", 1e-3);
}

/// The same where the mass rests on a surface, by a law of friction, with units.
TEST(SlideExcursion, AMassThatIsMovedFromRestIsAdvancedInClosedForm) {
    for (const double zeta : {0.0, 0.1}) {
        const Model model = shipped_with("dry-friction-oscillator",
                                         {{"zeta", zeta}, {"friction_static", 0.3}, {"omega", 0.8}, {"amplitude", 2}});
        const double a = 2 * 0.8 * 0.8;
        const DiscontinuityMap map = discontinuity_map(
            System(model), touch_of(model, "mass-stick", "mass-stick-forward", {1.7, 0, 0}, {2, 1, 1}));
        ASSERT_EQ(map.order, MapOrder::quadratic) << map.reason;
        EXPECT_NEAR(map.direction[0], 4.5 / a, 1e-13);
        EXPECT_EQ(map.direction[1], 0);
        EXPECT_EQ(map.direction[2], 0);
        expect_order(model, map, "friction-stops-forward", 1e-3);
    }
}

/// A slide in four states along a curved surface. @param bend of the surface by y, which makes it nonlinear in all
/// states; @param shift that makes the rate of the touched function vanish at the state
Model curved(double bend, double shift) {
    return model_from(fmt::format(R"toml(
name = "curved"
[parameters]
bend = {:.17g}
shift = {:.17g}
[states]
x = 0.4
y = 0.1
z = 0.3
w = 0
[definitions]
drift = "0.3*cos(x)*(z - 0.5*y)"
edge = "w - 0.2*z^2 + 0.15*x*y"
[modes.low]
rates = {{ x = "z", y = "2 + 0.3*x*z", z = "1 - z + x*w", w = "z - 0.4*w + shift + 0.3*y" }}
[modes.high.rates]
x = "z - 0.5*y"
y = "(drift - edge*(1 + 0.2*x))/(1 + 2*bend*y)"
z = "1.3 - z + x*w + 0.4*y^2"
w = "z - 0.4*w + shift"
[events]
surface = "y - 0.3*sin(x) + bend*y^2"
[slides.along]
surface = "surface"
between = ["low", "high"]
[initial]
mode = "low"
)toml",
                                  bend, shift));
}

TEST(SlideExcursion, HasALeadingOrderOnCurvedSurfaces) {
    for (const double bend : {0.0, 0.4}) {
        const double x = 0.4, z = 0.9;
        double y = 0.3 * std::sin(x);
        for (int i = 0; i < 50; ++i)
            y -= (y - 0.3 * std::sin(x) + bend * y * y) / (1 + 2 * bend * y);
        const std::vector<double> state{x, y, z, 0.2 * z * z - 0.15 * x * y};
        // The edge has the rate zero if w has the rate that balances the others.
        const Model plain = curved(bend, 0);
        TouchState touch = touch_of(plain, "along", "along-high", state);
        const double push = System(plain).event(touch.event)(inputs_at(touch, state))[4]; // by w
        const double shift = -rate_at(System(plain), touch, state) / push;
        const Model model = curved(bend, shift);
        touch.parameters = model.parameter_values();
        const DiscontinuityMap map = discontinuity_map(System(model), touch);
        expect_order(model, map, "surface", 1e-3);
        EXPECT_GT(Eigen::Map<const Eigen::VectorXd>(map.direction.data(), 4).cwiseAbs().minCoeff(), 1e-3);
        // The shift keeps the surface.
        const auto off = System(model).event(*model.find_event("surface"))(inputs_at(touch, state));
        double lift = 0;
        for (std::size_t i = 0; i < 4; ++i)
            lift += off[1 + i] * map.direction[i];
        EXPECT_NEAR(lift, 0, 1e-12);
    }
}

/// In other units the shift is the same.
TEST(SlideExcursion, ScalesWithTheUnits) {
    for (const double length : {1.0, 1e-9, 1e6})
        for (const double clock : {1.0, 1e-6, 1e6}) {
            const double force = length / (clock * clock);
            const Model model = model_from(fmt::format(R"toml(
[parameters]
k = {:.17g}
w = {:.17g}
amplitude = {:.17g}
friction = {:.17g}
[states]
x = 0
v = 0
theta = {{ initial = 0, period = "2*pi" }}
[definitions]
force = "amplitude*cos(theta) - k*x"
[modes.mass]
rates = {{ x = "v", v = "force - rub", theta = "w" }}
[friction.rub]
velocity = "v"
normal = 1
coefficient = "friction"
[initial]
mode = "mass"
)toml",
                                                       2 / (clock * clock), 0.4 / clock, force, 0.3 * force));
            const DiscontinuityMap map =
                discontinuity_map(System(model), touch_of(model, "mass-stick", "mass-stick-forward",
                                                          {0.35 * length, 0, 0}, {length, length / clock, 1}));
            ASSERT_EQ(map.order, MapOrder::quadratic) << map.reason << ' ' << length << ' ' << clock;
            const double a = 0.16 * force / (clock * clock);
            EXPECT_NEAR(map.direction[0] * a, 4.5, 1e-12);
            EXPECT_EQ(map.direction[1], 0);
        }
}

} // namespace graze::slide_excursion_test
