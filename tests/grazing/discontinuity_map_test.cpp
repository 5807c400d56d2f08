// Discontinuity maps against simulation: the error falls with the next power of the depth.

#include "graze/grazing/discontinuity_map.hpp"

#include "graze/base/input_error.hpp"
#include "near_touch.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace graze::discontinuity_map_test {

using namespace graze::testing;

using ::testing::HasSubstr;

/// Returns the largest scaled difference between the simulation and the map for a motion near the touch that would
/// penetrate to `depth`.
double error_at(const System& system, const DiscontinuityMap& map, double depth, double time) {
    return error_of_map(system, map, state_at_depth(system, map, depth), depth, time, 1e-15);
}

/// Checks that with the next order the error falls with half a power more.
void expect_next_order(const System& system, DiscontinuityMap map, double depth, double time, double rate) {
    ASSERT_EQ(map.second.size(), map.direction.size());
    const double far = error_at(system, map, 10 * depth, time), near = error_at(system, map, depth, time);
    EXPECT_GT(std::log10(far / near), rate + 0.5 - 0.05) << far << ' ' << near;
    map.second.clear();
    EXPECT_LT(near, 0.3 * error_at(system, map, depth, time));
}

/// Checks the power of the depth with which the error of the leading order falls when the depth falls to a hundredth.
void expect_rate(const System& system, DiscontinuityMap map, double depth, double time, double rate) {
    ASSERT_TRUE(map.exists()) << map.reason;
    EXPECT_EQ(map.second.empty(),
              map.order == MapOrder::three_halves || (map.order == MapOrder::square_root && map.contacts.size() != 1));
    if (!map.second.empty())
        expect_next_order(system, map, depth, time, rate);
    map.second.clear();
    const double far = error_at(system, map, depth, time), near = error_at(system, map, depth / 100, time);
    // The next term may be zero, so the error may fall faster.
    EXPECT_GT(std::log(far / near) / std::log(100), rate - 0.05) << far << ' ' << near;
}

/// x'' = 2 + x z - v with z' = 1 - z + v x in front of a wall at x = 0. @param contact transitions and further modes
Model wall_model(const std::string& contact) {
    return model_from(R"toml(
[parameters]
e = 0.7
k = 3
c = 0.6
[states]
x = 1
v = 0
z = 0.3
w = 0
[definitions]
free = "2 + x*z - v + 0.3*sin(w)"
[initial]
mode = "free"
[events]
touch = "x"
leave = "-x"
[modes.free]
watch = ["touch"]
rates = { x = "v", v = "free", z = "1 - z + v*x + 0.2*w", w = "z - 0.4*w" }
)toml" + contact);
}

Model compliant(const std::string& force) {
    return wall_model(fmt::format(R"toml(
[modes.on]
watch = ["leave"]
rates = {{ x = "v", v = "free + {}", z = "1 - z + v*x + 0.2*w", w = "z - 0.4*w" }}
)toml",
                                  force) +
                      transition("free", "touch", "on") + transition("on", "leave", "free"));
}

/// @param jump lines of its table
Model jumping(const std::string& jump, const std::string& next = "free") {
    return wall_model("[jumps.impact]\n" + jump + '\n' + transition("free", "touch", next, "impact"));
}

const std::vector<double> at_wall{0, 0, 0.3, 0.2};

TEST(DiscontinuityMap, ImpactHasItsClosedForm) {
    const Model model = jumping("v = '-e*v'");
    const DiscontinuityMap map = discontinuity_map(System(model), touch_of(model, "free", "touch", at_wall));
    ASSERT_EQ(map.order, MapOrder::square_root) << map.reason;
    EXPECT_NEAR(map.acceleration, 2 + 0.3 * std::sin(0.2), 1e-15);
    EXPECT_NEAR(map.direction[1], 1.7, 1e-15);
    for (const std::size_t i : {0, 2, 3})
        EXPECT_EQ(map.direction[i], 0);
    EXPECT_EQ(map.time, 0);
    expect_rate(System(model), map, 1e-6, 0.1, 1);
}

TEST(DiscontinuityMap, ImpactMayChangeSeveralStates) {
    const Model model = jumping("v = '-e*v*(1 + 0.2*z)'\nz = 'z - 0.4*v + v^2'\nw = 'w + 0.3*v*z'");
    const DiscontinuityMap map = discontinuity_map(System(model), touch_of(model, "free", "touch", at_wall));
    ASSERT_EQ(map.order, MapOrder::square_root) << map.reason;
    EXPECT_NEAR(map.restitution, 0.7 * 1.06, 1e-15);
    EXPECT_NEAR(map.direction[2], 0.4, 1e-15);
    EXPECT_NEAR(map.direction[3], -0.09, 1e-15);
    expect_rate(System(model), map, 1e-6, 0.1, 1);
}

TEST(DiscontinuityMap, MovingWallsAndSlipAfterImpactsHaveSquareRootMaps) {
    const Model shaker = shipped_with("ball-and-shaker", {{"a", 0.65}});
    const DiscontinuityMap moving =
        discontinuity_map(System(shaker), touch_of(shaker, "free", "contact", {0, 0, std::acos(0.0)}, {0.65, 20, 1}));
    ASSERT_EQ(moving.order, MapOrder::square_root) << moving.reason;
    expect_rate(System(shaker), moving, 1e-6, 0.005, 1);

    // The frame slips for a time proportional to the speed, and sticks again.
    const Model actuator = load_model("impact-microactuator");
    const DiscontinuityMap slipping =
        discontinuity_map(System(actuator), touch_of(actuator, "stick", "front", {0, 0, 0.5, 0, 2.9}));
    ASSERT_EQ(slipping.order, MapOrder::square_root) << slipping.reason;
    EXPECT_EQ(slipping.contacts.size(), 2U);
    EXPECT_GT(slipping.time, 0);
    expect_rate(System(actuator), slipping, 1e-6, 0.1, 1);
}

/// A touching state of a shipped model, with the scales of its states, a depth and a time that is short for it.
struct Shipped {
    const char* model;
    Settings parameters;
    const char* mode;
    const char* event;
    std::vector<double> state, scales;
    double depth, time;
    MapOrder order;
};

TEST(DiscontinuityMap, ErrorForShippedModelsFallsWithTheNextPower) {
    const double deflection = -0.004 / 1.5881462620646052;
    const Shipped all[] = {
        {"impact-oscillator", {}, "free", "stop", {0.1, 0, 3}, {1, 1, 1}, 1e-5, 0.1, MapOrder::square_root},
        {"impact-oscillator-two-stops", {}, "free", "left", {-1, 0, 0.2}, {1, 1, 1}, 1e-5, 0.1, MapOrder::square_root},
        {"impact-oscillator-two-stops", {}, "free", "right", {1, 0, 3}, {1, 1, 1}, 1e-5, 0.1, MapOrder::square_root},
        {"mems-switch", {}, "on", "stop", {-0.6, 0, 1}, {1, 1, 1}, 1e-5, 0.1, MapOrder::square_root},
        {"mems-switch", {}, "off", "stop", {-0.6, 0, 4}, {1, 1, 1}, 1e-5, 0.1, MapOrder::square_root},
        {"bouncing-ball",
         {{"a", 0.003}},
         "flight",
         "contact",
         {0.003 * std::sin(1.4), 0.003 * 20 * std::acos(-1.0) * std::cos(1.4), 1.4},
         {1e-3, 0.1, 1},
         1e-9,
         0.001,
         MapOrder::square_root},
        {"microbeam", {}, "free_on", "touch", {deflection, 0, 1}, {1e-3, 0.02, 1}, 1e-5, 0.005, MapOrder::three_halves},
        {"microbeam",
         {},
         "free_off",
         "touch",
         {deflection, 0, 5},
         {1e-3, 0.02, 1},
         1e-5,
         0.005,
         MapOrder::three_halves},
    };
    for (const Shipped& one : all) {
        SCOPED_TRACE(fmt::format("{} {}", one.model, one.event));
        const Model model = shipped_with(one.model, one.parameters);
        const DiscontinuityMap map =
            discontinuity_map(System(model), touch_of(model, one.mode, one.event, one.state, one.scales));
        EXPECT_EQ(map.order, one.order) << map.reason;
        expect_rate(System(model), map, one.depth, one.time, one.order == MapOrder::square_root ? 1 : 2);
    }
    // The mass of the testbed touches its stop with a current that pulls it away.
    const Model testbed = load_model("electromagnetic-testbed");
    const double delta = testbed.values_of(std::array{testbed.symbol("delta")})[0];
    const DiscontinuityMap map =
        discontinuity_map(System(testbed), touch_of(testbed, "free", "stop", {delta, 0, 0.1, 1}, {1e-3, 0.1, 1, 1}));
    EXPECT_EQ(map.order, MapOrder::square_root) << map.reason;
    expect_rate(System(testbed), map, 1e-8, 0.001, 1);
}

TEST(DiscontinuityMap, PreloadedStopHasASquareRootMap) {
    const Model model = compliant("c - k*x");
    const DiscontinuityMap map = discontinuity_map(System(model), touch_of(model, "free", "touch", at_wall));
    ASSERT_EQ(map.order, MapOrder::square_root) << map.reason;
    // The preload c acts for the time 2 s/(a + c).
    const double a = 2 + 0.3 * std::sin(0.2);
    EXPECT_NEAR(map.time, 2 / (a + 0.6), 1e-15);
    EXPECT_NEAR(map.direction[1], 0.6 * 2 / (a + 0.6), 1e-15);
    expect_rate(System(model), map, 1e-6, 0.1, 1);
}

TEST(DiscontinuityMap, CompliantStopsHaveThreeHalvesMaps) {
    for (const char* force : {"(-k*x)", "(-k*x*(1 + z))", "(-k*x - c*v)", "(-k*x - c*v*(1 + z + v))", "(-c*v)"}) {
        SCOPED_TRACE(force);
        const Model model = compliant(force);
        const DiscontinuityMap map = discontinuity_map(System(model), touch_of(model, "free", "touch", at_wall));
        ASSERT_EQ(map.order, MapOrder::three_halves) << map.reason;
        expect_rate(System(model), map, 1e-3, 0.2, 2);
    }
    const Model spring = compliant("(-k*x)");
    const DiscontinuityMap map = discontinuity_map(System(spring), touch_of(spring, "free", "touch", at_wall));
    EXPECT_NEAR(map.direction[1], 4 * std::sqrt(2 / map.acceleration), 1e-14); // 4/3 k (2/a)^(1/2)
}

/// A relay system: the vector field is `first` where h = x - 0.3 sin(w) is positive, `second` where it is negative, and
/// on h = 0 the convex combination that keeps h zero (A. F. Filippov). The initial state has h > 0.
std::string relay_text(const std::string& jump) {
    return R"toml(
[states]
x = 1
y = 0
z = 0.3
w = 0
[definitions]
first_x = "y + 0.4*z^2 - 0.7*x + 0.2*x*z"
first_y = "1 + 0.5*y - z*x"
first_z = "0.3 - z + 0.2*w*y"
rate_w = "z - 0.4*w"
second_x = "first_x + 2 + z + 0.3*y^2"
second_y = "first_y - 0.8 + 0.5*x"
second_z = "first_z + 0.7*cos(y)"
surface = "0.3*cos(w)*rate_w"
first = "first_x - surface"
second = "second_x - surface"
share = "first/(first - second)"
[initial]
mode = "free"
[events]
touch = "x - 0.3*sin(w)"
leave = "-first"
[jumps.put]
x = "0.3*sin(w)"
[jumps.shake]
z = "z + first^2"
[modes.free]
watch = ["touch"]
rates = { x = "first_x", y = "first_y", z = "first_z", w = "rate_w" }
[modes.slide]
watch = ["leave"]
[modes.slide.rates]
x = "first_x + share*(second_x - first_x)"
y = "first_y + share*(second_y - first_y)"
z = "first_z + share*(second_z - first_z)"
w = "rate_w"
)toml" + transition("free", "touch", "slide", jump) +
           transition("slide", "leave", "free");
}
Model relay(const std::string& jump) {
    return model_from(relay_text(jump));
}

/// The touching state, where first_x equals the rate of the surface.
std::vector<double> touch_of_relay() {
    const double z = 0.3, w = 0.2, x = 0.3 * std::sin(w);
    return {x, 0.3 * std::cos(w) * (z - 0.4 * w) - 0.4 * z * z + 0.7 * x - 0.2 * x * z, z, w};
}

TEST(DiscontinuityMap, GrazingSlidingHasALinearMap) {
    for (const char* jump : {"identity", "put"}) {
        const Model model = relay(jump);
        const std::vector<double> state = touch_of_relay();
        const DiscontinuityMap map = discontinuity_map(System(model), touch_of(model, "free", "touch", state));
        ASSERT_EQ(map.order, MapOrder::linear) << map.reason;
        EXPECT_EQ(map.contacts.size(), 2U);
        // (second - first) divided by the rate at which the second field meets the surface.
        const double y = state[1], rate = 2 + state[2] + 0.3 * y * y;
        EXPECT_NEAR(map.direction[0], 1, 1e-13);
        EXPECT_NEAR(map.direction[1], (-0.8 + 0.5 * state[0]) / rate, 1e-13);
        EXPECT_NEAR(map.direction[2], 0.7 * std::cos(y) / rate, 1e-13);
        EXPECT_EQ(map.direction[3], 0);
        // It slides from the contact until the time at which the motion would have touched.
        EXPECT_NEAR(map.time, 1 / map.acceleration, 1e-13);
        expect_rate(System(model), map, 1e-4, 0.1, 1.5);
    }
}

/// With one coefficient of friction, a mass that sticks instead of moving back and forth keeps a lead of the distance
/// that it would have moved back, a/3 (2 d/a)^(3/2).
TEST(DiscontinuityMap, ShortStickingHasALinearMapWithItsClosedForm) {
    for (const double zeta : {0.0, 0.1}) {
        Model model = shipped_with("dry-friction-oscillator", {{"zeta", zeta}, {"friction_static", 0.3}});
        const double theta = 4, x = std::cos(theta) - 0.3;
        TouchState touch = touch_of(model, "mass-forward", "friction-stops-forward", {x, 0, theta});
        const DiscontinuityMap map = discontinuity_map(System(model), touch);
        ASSERT_EQ(map.order, MapOrder::linear) << map.reason;
        const double a = -0.4 * std::sin(theta);
        EXPECT_NEAR(map.acceleration, a, 1e-15);
        EXPECT_EQ(map.direction[0], 0);
        EXPECT_NEAR(map.direction[1], 1, 1e-15);
        EXPECT_EQ(map.direction[2], 0);
        EXPECT_NEAR(map.second[0], a / 3 * std::pow(2 / a, 1.5), 1e-14);
        EXPECT_EQ(map.second[1], 0);
        expect_rate(System(model), map, 2e-6, 0.3, 1.5);
        // The symmetric image.
        for (std::size_t i = 0; i < 2; ++i)
            touch.state[i] = -touch.state[i];
        touch.state[2] += std::acos(-1.0);
        touch.mode = *model.find_mode("mass-backward");
        touch.event = *model.find_event("friction-stops-backward");
        const DiscontinuityMap mirrored = discontinuity_map(System(model), touch);
        ASSERT_EQ(mirrored.order, MapOrder::linear) << mirrored.reason;
        EXPECT_NEAR(mirrored.direction[1], -1, 1e-15);
        EXPECT_NEAR(mirrored.second[0], -map.second[0], 1e-14);
        // Higher static friction holds the mass for a time that does not vanish with the depth.
        model.set_parameter("friction_static", 0.31);
        touch.parameters = model.parameter_values();
        const DiscontinuityMap held = discontinuity_map(System(model), touch);
        EXPECT_FALSE(held.exists());
        EXPECT_THAT(held.reason, HasSubstr("mode 'mass-stick', from which the motion does not come back at once"));
    }
}

/// m x'' = A cos(w t) - k x - F in several units.
TEST(DiscontinuityMap, StickingScalesWithTheUnits) {
    for (const double length : {1.0, 1e-9, 1e6})
        for (const double clock : {1.0, 1e-9, 1e6}) {
            const double velocity = length / clock, force = velocity / clock;
            const Model model =
                TwoModes{.parameters = fmt::format("w = {:.17g}\nk = {:.17g}\namplitude = {:.17g}\nfriction = {:.17g}",
                                                   0.4 / clock, 2 / (clock * clock), force, 0.3 * force),
                         .states = "x = 0\nv = 0",
                         .definitions = "force = 'amplitude*cos(theta) - k*x'",
                         .clock = "w",
                         .first = {"slip", "x = 'v', v = 'force - friction'", "stop", "v"},
                         .second = {"stick", "x = 0, v = 0", "break", "friction - force"},
                         .kind = "barrier"}
                    .model();
            const double theta = 4, x = (std::cos(theta) - 0.3) / 2 * length;
            const DiscontinuityMap map =
                discontinuity_map(System(model), touch_of(model, "slip", "stop", {x, 0, theta}, {length, velocity, 1}));
            ASSERT_EQ(map.order, MapOrder::linear) << map.reason << ' ' << length << ' ' << clock;
            const double a = -0.4 * std::sin(theta) * force / clock;
            EXPECT_NEAR(map.acceleration, a, 1e-14 * a);
            EXPECT_EQ(map.direction[0], 0);
            EXPECT_NEAR(map.direction[1], 1, 1e-14);
            const double second = a / 3 * std::pow(2 / a, 1.5);
            EXPECT_NEAR(map.second[0], second, 1e-13 * second);
        }
}

/// A mass that is held by more than dynamic friction slips far once it is let go.
TEST(DiscontinuityMap, EndOfStickingIsRefusedWithTheReason) {
    const Model model = shipped_with("dry-friction-oscillator", {{"friction_static", 0.4}});
    EXPECT_THAT(
        discontinuity_map(System(model), touch_of(model, "mass-stick", "mass-stick-forward", {0.6, 0, 0})).reason,
        HasSubstr("mode 'mass-forward', from which the motion does not come back at once"));
}

TEST(DiscontinuityMap, UnsuitableSlidingIsRefusedWithTheReason) {
    const auto reason_of = [](const Model& model) {
        const DiscontinuityMap map =
            discontinuity_map(System(model), touch_of(model, "free", "touch", touch_of_relay()));
        EXPECT_FALSE(map.exists());
        return map.reason;
    };
    EXPECT_THAT(reason_of(relay("shake")), HasSubstr("the jump 'shake' changes states on the surface"));
    const auto replaced = [](const std::string& old, const std::string& with) {
        std::string text = relay_text("identity");
        const std::size_t place = text.find(old);
        EXPECT_NE(place, std::string::npos) << old;
        return model_from(text.replace(place, old.size(), with));
    };
    EXPECT_THAT(reason_of(replaced("first_y + share", "first_y + 0.1*(z - 0.3) + share")),
                HasSubstr("the field of mode 'slide' is not that of mode 'free' wherever the surface is touched"));
    EXPECT_THAT(reason_of(replaced("first_x + share*", "first_x + 0.5*share*")),
                HasSubstr("mode 'slide' does not stay on the surface of event 'touch'"));
}

TEST(DiscontinuityMap, UnsuitableContactsAreRefusedWithTheReason) {
    const auto reason = [](const Model& model, std::vector<double> state = at_wall) {
        const DiscontinuityMap map =
            discontinuity_map(System(model), touch_of(model, "free", "touch", std::move(state)));
        EXPECT_FALSE(map.exists());
        return map.reason;
    };
    EXPECT_THAT(reason(jumping("v = '1'")), HasSubstr("is not the identity at zero speed: it changes 'v'"));
    EXPECT_THAT(reason(jumping("v = '-e*v'\nw = '0.2 + 2*(w - 0.2)'")), HasSubstr("is not the identity at zero speed"));
    EXPECT_THAT(reason(jumping("x = 'x + 0.1*v'\nv = '-e*v'")), HasSubstr("moves states off the surface"));
    EXPECT_THAT(reason(jumping("v = '0.5*v'")), HasSubstr("happens again at once"));
    EXPECT_THAT(reason(jumping("v = '-e*v'", "end")), HasSubstr("the motion ends at event 'touch'"));
    EXPECT_THAT(reason(jumping("v = '-e*v'", "[{ when = 'z > 5', mode = 'free' }]")),
                HasSubstr("no alternative of the guard"));
    EXPECT_THAT(reason(jumping("v = '-e*v'"), {0, 1, 0.3, 0.2}), HasSubstr("is reached with nonzero speed"));
    EXPECT_THAT(reason(jumping("v = '-e*v'"), {0.5, 0, 0.3, 0.2}), HasSubstr("not on the surface"));
    EXPECT_THAT(reason(wall_model("[modes.held]\nwatch = []\nrates = { x = 0, v = 0, z = 0, w = 0 }\n" +
                                  transition("free", "touch", "held"))),
                HasSubstr("from which the motion does not come back at once"));
    EXPECT_THAT(reason(wall_model(transition("free", "touch", "free"))), HasSubstr("changes nothing"));
}

TEST(DiscontinuityMap, NumbersThatDoNotFitAreRefused) {
    const Model model = load_model("impact-oscillator");
    EXPECT_THROW(discontinuity_map(System(model), touch_of(model, "free", "stop", {0, 0})), InputError);
    EXPECT_THROW(discontinuity_map(System(model), touch_of(model, "free", "stop", {0, 0, NAN})), InputError);
    TouchState touch = touch_of(model, "free", "stop", {0.1, 0, 0});
    touch.event = 7;
    EXPECT_THROW(discontinuity_map(System(model), touch), InputError);
}

} // namespace graze::discontinuity_map_test
