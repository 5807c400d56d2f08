// Yield of devices that are drawn and simulated one by one, against that of exact grazings: an independent method with
// independent draws.

#include "simulated_devices.hpp"

#include "graze/branch/yield.hpp"
#include "identify/noise.hpp"
#include "switches.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::testing::simulated_devices_test {

/// The MEMS switch, its trip point, and the tolerances of its design.
struct Switches {
    Design design = load_design("mems-switch");
    TripPoint trip = trip_of(design);
    std::vector<double> nominal = trip.point.solution.orbit.parameters;
    std::vector<Tolerance> tolerances;
    SimulatedDevices simulated{trip.system.model(), "V", {}};
    ParameterId omega = trip.system.model().independent_parameter("omega");

    Switches() {
        for (const DesignDimension& one : design.dimensions)
            tolerances.push_back(one.tolerance->at(one.parameter, nominal[one.parameter.place()]));
    }
    std::vector<double> drawn(Noise& noise) const {
        std::vector<double> device = nominal;
        for (const Tolerance& one : tolerances)
            device[one.parameter.place()] +=
                one.size * (one.spread == Spread::normal ? noise.normal() : 2 * noise.uniform() - 1);
        return device;
    }
    bool trips(const std::vector<double>& device, double value) const {
        return simulated.trips(device, {0, 0, 0}, 2 * std::numbers::pi / device[omega.place()], value);
    }
};

TEST(SimulatedDevices, TripAboveTheirValueAndNotBelow) {
    const Switches switches;
    const double value = switches.trip.value();
    // On both sides of the value published to sixteen digits, as close as a few hundred cycles can resolve.
    EXPECT_FALSE(switches.trips(switches.nominal, value * (1 - 1e-5)));
    EXPECT_TRUE(switches.trips(switches.nominal, value * (1 + 1e-5)));
}

TEST(SimulatedDevicesSlow, HaveTheYieldOfExactGrazings) {
    Switches switches;
    YieldSettings settings;
    settings.tolerances = switches.tolerances;
    settings.devices = 4000;
    settings.least = switches.design.yield.least;
    settings.greatest = switches.design.yield.greatest;
    const Yield exact = yield_of(switches.trip.system, switches.trip.point, switches.trip.control, settings);
    std::vector<ParameterId> varied;
    for (const Tolerance& one : switches.tolerances)
        varied.push_back(one.parameter);
    LocatedValue located(switches.trip.system, switches.trip.point, switches.trip.control, varied);
    Noise noise(7);
    constexpr std::size_t devices = 400;
    constexpr double near = 1e-4; // of a limit: ten times the resolution of a few hundred cycles
    std::size_t within = 0, compared = 0;
    for (std::size_t i = 0; i < devices; ++i) {
        const std::vector<double> device = switches.drawn(noise);
        const bool below = switches.trips(device, *settings.least), above = switches.trips(device, *settings.greatest);
        within += !below && above ? 1 : 0;
        std::vector<double> values;
        for (const ParameterId one : varied)
            values.push_back(device[one.place()]);
        const LocatedSolution solution = located(values);
        ASSERT_TRUE(solution.found && solution.admissible) << solution.problem;
        for (const auto& [limit, trips] : {std::pair(*settings.least, below), std::pair(*settings.greatest, above)})
            if (std::abs(solution.value - limit) > near * limit) {
                ++compared;
                EXPECT_EQ(trips, solution.value < limit) << "device " << i << ": " << solution.value << ", " << limit;
            }
    }
    EXPECT_GT(compared, 19 * devices / 10);
    // The 99.9 percent confidence limits of either share contain the other: both are estimates.
    const ConfidenceInterval brute = wilson_interval(within, devices, 0.999);
    EXPECT_GT(exact.within->value, brute.low);
    EXPECT_LT(exact.within->value, brute.high);
    // The linear estimate agrees here, too, and the frequency causes most of the variance.
    EXPECT_GT(*exact.linear_within, brute.low);
    EXPECT_LT(*exact.linear_within, brute.high);
    EXPECT_EQ(exact.contributions.front().parameter, switches.omega);
    RecordProperty("yield", std::to_string(exact.within->value));
    RecordProperty("brute_force", std::to_string(brute.value));
}

} // namespace graze::testing::simulated_devices_test
