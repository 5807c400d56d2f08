// Maps of whole cycles of the shipped models against simulation: the errors fall with the stated order.

#include "cycle_error.hpp"
#include "follow.hpp"

#include <gtest/gtest.h>

namespace graze::shipped_cycles_test {

using namespace graze::testing;

/// Equal static and dynamic friction, so that the mass sticks for a short time.
TEST(ShippedCycles, ErrorForDryFrictionFallsWithTheNextPowerOfTheDepth) {
    const Model model =
        shipped_with("dry-friction-oscillator", {{"friction_static", 0.3}, {"friction_dynamic", 0.3}, {"omega", 0.2}});
    const SpecialPoint touch = first_touch(model, "phase0", in_parameter(model, "omega", 0.15, 0.3));
    const CycleMap map = map_at(model, touch);
    EXPECT_EQ(map.contact.order, MapOrder::linear);
    expect_rates(model, map, 1e-3);
}

TEST(ShippedCycles, ErrorFallsWithTheNextPowerOfTheDepth) {
    const Model oscillator = shipped_with("impact-oscillator", {{"sigma", 0.5}, {"amplitude", 0.1}, {"omega", 1.2}});
    expect_rates(oscillator,
                 map_at(oscillator, first_touch(oscillator, "phase0", in_parameter(oscillator, "amplitude", 0, 1))),
                 1e-5);

    const Model stops = shipped_with("impact-oscillator-two-stops", {{"amplitude", 0.1}});
    expect_rates(stops, map_at(stops, first_touch(stops, "phase0", in_parameter(stops, "amplitude", 0, 10))), 1e-5);

    const Model mems = started(shipped_with("mems-switch", {{"V", 0.15}}), {{"q", 0}});
    expect_rates(mems, map_at(mems, first_touch(mems, "phase0", in_parameter(mems, "V", 0, 0.4))), 1e-6);

    const Model device = started(shipped_with("mems-switch-device", {{"V", 7}}), {{"q", 0}});
    expect_rates(device, map_at(device, first_touch(device, "phase0", in_parameter(device, "V", 0, 50))), 1e-6);

    const Model ball = shipped_with("bouncing-ball", {{"e", 0.2}, {"a", 0.006}});
    expect_rates(ball, map_at(ball, first_touch(ball, "phase0", in_parameter(ball, "a", 0.0025, 0.05, -1))), 1e-6);

    const Model testbed = shipped_with("electromagnetic-testbed", {{"V0", 3}});
    expect_rates(testbed, map_at(testbed, first_touch(testbed, "phase0", in_parameter(testbed, "V0", 0, 5.5), 600)),
                 1e-6);

    const Model actuator = shipped_with("impact-microactuator", {{"V", 0.1}, {"omega", 0.9189}});
    expect_rates(actuator, map_at(actuator, first_touch(actuator, "longest", in_parameter(actuator, "V", 0, 3), 4000)),
                 1e-6);

    const Model beam = shipped_with("microbeam", {{"V", 0.01}});
    expect_rates(beam, map_at(beam, first_touch(beam, "phase0", in_parameter(beam, "V", 0.005, 0.06))), 3e-5);

    const Model shaker = shipped_with("ball-and-shaker", {{"a", 0.65}, {"b", 0.65}, {"f", 6}});
    const Orbit resting = given_orbit(shaker, "free:phase0", {{0, 0, 0}}, {1.0 / 6});
    CycleMapOptions options;
    options.next_order = true;
    const auto touches = touches_of(System(shaker), resting);
    ASSERT_EQ(touches.size(), 1U);
    expect_rates(shaker, cycle_map(System(shaker), resting, touches.front(), options), 1e-5);
}

} // namespace graze::shipped_cycles_test
