// The trip value of the MEMS switch over a plane of two parameters, with its class, and over devices with scatter. The
// peer does not use exact grazings: bisection, each step of which simulates the device until it trips or rests.

#include "design/simulated_devices.hpp"
#include "design/switches.hpp"
#include "graze/branch/yield.hpp"
#include "graze/design/value_map.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace {

using namespace graze;

struct Switch {
    Design design = load_design("mems-switch");
    TripPoint trip = graze::testing::trip_of(design);
};

double seconds_of(const auto& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void PlaneOfTripValues(benchmark::State& state) {
    const Switch one;
    MapSettings settings;
    settings.points = static_cast<std::size_t>(state.range(0));
    settings.jobs = static_cast<int>(state.range(1));
    double values = 0;
    for (auto _ : state) {
        const auto plane = value_plane(one.trip, one.design.dimensions[0], one.design.dimensions[1], settings);
        for (const MappedValue& value : plane)
            if (!value.found)
                throw std::logic_error("the plane is not what is to be measured");
        values += static_cast<double>(plane.size());
    }
    state.counters["values"] = benchmark::Counter(values, benchmark::Counter::kIsRate);
}
BENCHMARK(PlaneOfTripValues)
    ->ArgNames({"points", "jobs"})
    ->Args({200, 1})
    ->Args({200, 2})
    ->Unit(benchmark::kSecond)
    ->UseRealTime();

void YieldOfTripValues(benchmark::State& state) {
    const Switch one;
    YieldSettings settings;
    for (const DesignDimension& dimension : one.design.dimensions)
        settings.tolerances.push_back(dimension.tolerance->at(
            dimension.parameter, one.trip.point.solution.orbit.parameters[dimension.parameter.place()]));
    settings.jobs = static_cast<int>(state.range(0));
    for (auto _ : state)
        if (yield_of(one.trip.system, one.trip.point, one.trip.control, settings).found != settings.devices)
            throw std::logic_error("the yield is not what is to be measured");
}
BENCHMARK(YieldOfTripValues)->ArgName("jobs")->Arg(1)->Arg(2)->Unit(benchmark::kSecond)->UseRealTime();

/// Accurate to four digits only, where exact grazings give twelve: more digits cost bisection steps and longer
/// simulations. The counter `ratio` is the time of this over that of a value of the plane, both measured here.
void TripValueBySimulation(benchmark::State& state) {
    const Switch one;
    const ParameterId omega = one.trip.system.model().independent_parameter("omega");
    const graze::testing::SimulatedDevices devices(one.trip.system.model(), "V", {});
    const std::vector<double> nominal = one.trip.point.solution.orbit.parameters;
    double found = 0, count = 0, seconds = 0;
    for (auto _ : state)
        seconds += seconds_of([&] {
            std::vector<double> device = nominal;
            device[one.design.dimensions[0].parameter.place()] *= 1 + 0.01 * std::sin(count++);
            double low = 0.15, high = 0.25;
            while (high - low > 1e-4 * low) {
                const double middle = 0.5 * (low + high);
                (devices.trips(device, {0, 0, 0}, 2 * std::numbers::pi / device[omega.place()], middle) ? high : low) =
                    middle;
            }
            found = 0.5 * (low + high);
        });
    if (!(std::abs(found / one.trip.value() - 1) < 0.02))
        throw std::logic_error("the value is not what is to be measured");
    MapSettings settings;
    settings.points = 40;
    const double of_plane = seconds_of([&] {
        benchmark::DoNotOptimize(
            value_plane(one.trip, one.design.dimensions[0], one.design.dimensions[1], settings).data());
    });
    state.counters["ratio"] = seconds / count / (of_plane / 1600);
}
BENCHMARK(TripValueBySimulation)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
