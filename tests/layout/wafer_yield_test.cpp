#include "graze/layout/wafer_yield.hpp"

#include "design/simulated_devices.hpp"
#include "design/switches.hpp"
#include "graze/base/input_error.hpp"
#include "graze/study/yield_part.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace graze::testing::wafer_yield_test {

/// The shipped device on its wafers, with some variation of its process.
struct Wafers {
    DeviceFile file = load_device_file("mems-switch-device");
    Design design;
    WaferYieldSettings settings;

    explicit Wafers(double share = 1) {
        for (const DepartureField& field : departure_fields())
            for (const auto part : {&SpreadParts::wafer, &SpreadParts::radial, &SpreadParts::device})
                (file.spread.*field.spread).*part *= share;
        design = design_of_device(load_design("mems-switch-device"), file);
        settings.wafers = 4;
    }
    WaferYield yield() const {
        return wafer_yield_of(design, file, draw_wafer_layout(file), trip_of(design), settings);
    }
};

TEST(WaferYield, OfSmallSpreadsEqualsTheLinearEstimate) {
    Wafers wafers(1e-3);
    wafers.settings.wafers = 40;
    const WaferYield found = wafers.yield();
    ASSERT_EQ(found.yield.found, 320U);
    // Nonlinear effects are squares of relative deviations, 1e-5 each.
    EXPECT_LT(found.yield.largest_departure, 1e-3 * found.linear_deviation);
    // Devices of a wafer are correlated: 40 wafers give the deviation within 4/sqrt(80).
    EXPECT_NEAR(found.yield.deviation->value, found.linear_deviation, 0.45 * found.linear_deviation);
    EXPECT_NEAR(found.yield.deviation->value, found.yield.linear_deviation, 1e-3 * found.linear_deviation);
    // The derivative by the bias, from devices alone.
    DeviceFile etched = wafers.file;
    etched.conditions.bias += 0.002;
    const double more = trip_of(design_of_device(wafers.design, etched)).value();
    const double derivative = (more - found.yield.nominal) / 0.002;
    EXPECT_EQ(found.effects.front().name, "bias");
    EXPECT_NEAR(found.effects.front().derivative, derivative, 2e-3 * std::abs(derivative)); // a one-sided difference
}

TEST(WaferYield, OfADeviceAgreesWithSimulation) {
    const Wafers wafers;
    const WaferYield found = wafers.yield();
    ASSERT_EQ(found.devices.size(), 32U);
    const Model& model = wafers.design.model;
    const SimulatedDevices shop(model, "V", {.begin = 0.5, .keeps = 0.94, .cycles = 250, .rests = 100});
    for (const std::size_t i : {std::size_t{0}, std::size_t{13}, std::size_t{27}}) {
        const WaferDevice& device = found.devices[i];
        ASSERT_EQ(device.outcome, DeviceOutcome::found);
        EXPECT_EQ(device.found, GrazingOutcome::lost);
        std::vector<double> parameters;
        Model one = model;
        for (const auto& [name, value] : parameters_of(*device.lumped, model).set) {
            one.set_parameter(name, value);
            if (name == "f0")
                one.set_parameter("f", value);
        }
        parameters = one.parameter_values();
        const double cycle = 1 / (device.lumped->frequency() / 1000);
        // From rest; the rise leaves a disturbance of 0.94^250, then contacts have time to grow.
        EXPECT_FALSE(shop.trips(parameters, {0, 0, 0}, cycle, 0.999 * device.value)) << i;
        EXPECT_TRUE(shop.trips(parameters, {0, 0, 0}, cycle, 1.001 * device.value)) << i;
        ASSERT_TRUE(device.trip_time);
        EXPECT_GT(*device.trip_time, cycle);
    }
}

/// Dependent parameters have no values of their own among those of the model.
TEST(WaferYield, TunesTheDriveForAnyOrderOfParameters) {
    const DeviceFile file = load_device_file("mems-switch-device");
    Design design = load_design("mems-switch-device");
    design.model.set_parameter("f", 0.5 * *design.model.parameters[*design.model.find_parameter("f0")].value);
    std::rotate(design.model.parameters.begin(), design.model.parameters.end() - 3, design.model.parameters.end());
    ASSERT_TRUE(design.model.parameters.front().expression) << "a dependent one comes first";
    const Design drawn = design_of_device(design, file);
    EXPECT_NEAR(*drawn.model.parameters[*drawn.model.find_parameter("f")].value,
                0.5e-3 * lumped_model_of(file).frequency(), 1e-12);
}

TEST(WaferYield, DependsOnTheSeedAndNotOnThreads) {
    Wafers wafers;
    wafers.settings.wafers = 10;
    const WaferYield one = wafers.yield();
    wafers.settings.jobs = 2;
    const WaferYield two = wafers.yield();
    for (std::size_t i = 0; i < one.devices.size(); ++i) {
        EXPECT_EQ(one.devices[i].value, two.devices[i].value);
        EXPECT_EQ(one.devices[i].trip_time, two.devices[i].trip_time);
    }
    EXPECT_EQ(one.classes, two.classes);
}

TEST(WaferYield, IsTheSameInParts) {
    Wafers wafers;
    wafers.file.spread.bias.wafer = 4; // the etch removes some
    wafers.settings.wafers = 3;
    const WaferYield whole = wafers.yield();
    EXPECT_FALSE(whole.classes.empty());
    EXPECT_TRUE(whole.overshoot);
    wafers.settings.elsewhere = [](const AskedDevices& devices, const std::function<bool()>& interrupted,
                                   const DeviceSink& sink) {
        const DeviceSolver other = device_solver_of(bytes_of(devices.solver), wafer_examination_of);
        for (std::size_t last = devices.count; last > 0; last -= std::min<std::size_t>(last, 5)) {
            const ItemRange range{last - std::min<std::size_t>(last, 5), last};
            read_devices(devices, range, solved_part(other, part_of(devices, range), interrupted), sink);
        }
        return true;
    };
    const WaferYield parted = wafers.yield();
    ASSERT_EQ(parted.devices.size(), whole.devices.size());
    for (std::size_t i = 0; i < whole.devices.size(); ++i) {
        EXPECT_EQ(parted.devices[i].outcome, whole.devices[i].outcome);
        EXPECT_EQ(parted.devices[i].value, whole.devices[i].value);
        EXPECT_EQ(parted.devices[i].found, whole.devices[i].found);
        EXPECT_EQ(parted.devices[i].trip_time, whole.devices[i].trip_time);
    }
    EXPECT_EQ(parted.classes, whole.classes);
    EXPECT_EQ(parted.yield.problems, whole.yield.problems);
    EXPECT_EQ(parted.yield.deviation->value, whole.yield.deviation->value);
}

TEST(WaferYield, RefusesDevicesThatWereNotExamined) {
    Wafers wafers;
    wafers.settings.wafers = 1;
    for (const std::string& examined : {std::string(), std::string(9, '\x7f')}) {
        wafers.settings.elsewhere = [&](const AskedDevices& devices, const std::function<bool()>&,
                                        const DeviceSink& sink) {
            for (std::size_t i = 0; i < devices.count; ++i) {
                SolvedDevice solved{{DeviceOutcome::found, 25, 25}, "", examined};
                sink(i, solved);
            }
            return true;
        };
        EXPECT_THROW(wafers.yield(), InputError);
    }
}

TEST(WaferYield, CountsDevicesThatTheEtchRemoves) {
    Wafers wafers;
    wafers.file.spread.bias.wafer = 4; // flexures are 6.4 um wide
    wafers.settings.wafers = 3;
    const WaferYield found = wafers.yield();
    std::size_t gone = 0;
    for (const WaferDevice& device : found.devices)
        if (!device.lumped) {
            ++gone;
            EXPECT_EQ(device.outcome, DeviceOutcome::failed);
            EXPECT_FALSE(device.problem.empty());
        }
    EXPECT_GT(gone, 0U);
    EXPECT_EQ(found.yield.made, 24U);
    wafers.file.spread = {};
    EXPECT_THROW(wafers.yield(), InputError);
    wafers.settings.wafers = 0;
    EXPECT_THROW(wafers.yield(), InputError);
}

} // namespace graze::testing::wafer_yield_test
