// The voltage at which the MEMS switch's orbit touches its stop: derivatives at a point, values at other dimensions,
// and the yield of devices on threads. The peer is a new branch for each device, up to the touch.

#include "graze/branch/orbit_branch.hpp"
#include "graze/branch/yield.hpp"
#include "graze/model/catalogue.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace {

using namespace graze;

struct Switch {
    Model model = load_model("mems-switch");
    ParameterId voltage = model.independent_parameter("V");
    std::vector<ParameterId> dimensions{model.independent_parameter("delta"), model.independent_parameter("zeta"),
                                        model.independent_parameter("omega")};
    OrbitSolution start;
    SpecialPoint touch;

    Switch() {
        model.set_parameter("V", 0.15);
        model.set_initial("q", 0);
        AttractorOptions settle;
        settle.section = "phase0";
        settle.cycles = 2000;
        start = find_orbit(System(model), settle);
        touch = touch_at(start.orbit);
    }
    SpecialPoint touch_at(const Orbit& orbit) const {
        BranchSettings settings;
        settings.parameter = voltage;
        settings.greatest = 0.4;
        settings.stop_at = {PointType::grazing};
        const Branch branch = follow_branch(System(model), orbit, settings);
        if (branch.special.empty() || branch.special.back().type != PointType::grazing)
            throw std::logic_error("the branch is not what is to be measured");
        return branch.special.back();
    }
};

/// Returns the k-th device, with each dimension changed by up to one percent.
std::vector<double> device(const std::vector<double>& nominal, std::size_t k) {
    std::vector<double> values = nominal;
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] *= 1 + 0.01 * std::sin(static_cast<double>(7 * k + 3 * i));
    return values;
}

void TouchDerivatives(benchmark::State& state) {
    const Switch one;
    const System system(one.model);
    for (auto _ : state)
        benchmark::DoNotOptimize(LocatedValue(system, one.touch, one.voltage, one.dimensions).derivatives().data());
}
BENCHMARK(TouchDerivatives)->Unit(benchmark::kMicrosecond);

void TouchOfADevice(benchmark::State& state) {
    const Switch one;
    LocatedValue touch(System(one.model), one.touch, one.voltage, one.dimensions);
    std::size_t k = 0;
    for (auto _ : state)
        if (!touch(device(touch.values(), k++)).admissible)
            throw std::logic_error("the device is not what is to be measured");
    state.counters["devices"] = benchmark::Counter(static_cast<double>(k), benchmark::Counter::kIsRate);
}
BENCHMARK(TouchOfADevice)->Unit(benchmark::kMicrosecond);

/// The peer: the branch of each device, up to its touch.
void TouchOfADeviceByItsBranch(benchmark::State& state) {
    const Switch one;
    LocatedValue touch(System(one.model), one.touch, one.voltage, one.dimensions);
    std::size_t k = 0;
    for (auto _ : state) {
        Orbit orbit = one.start.orbit;
        const std::vector<double> values = device(touch.values(), k++);
        for (std::size_t i = 0; i < values.size(); ++i)
            orbit.parameters[one.dimensions[i].place()] = values[i];
        const double found = one.touch_at(orbit).parameter;
        state.PauseTiming();
        if (!(std::abs(found - touch(values).value) < 1e-10))
            throw std::logic_error("the two do not agree");
        state.ResumeTiming();
    }
    state.counters["devices"] = benchmark::Counter(static_cast<double>(k), benchmark::Counter::kIsRate);
}
BENCHMARK(TouchOfADeviceByItsBranch)->Unit(benchmark::kMicrosecond);

void YieldOfDevices(benchmark::State& state) {
    const Switch one;
    const System system(one.model);
    YieldSettings settings;
    for (const ParameterId parameter : one.dimensions) {
        const double value = one.touch.solution.orbit.parameters[parameter.place()];
        settings.tolerances.push_back({parameter, Spread::normal, 0.01 * value});
    }
    settings.jobs = static_cast<int>(state.range(0));
    for (auto _ : state)
        if (yield_of(system, one.touch, one.voltage, settings).found != settings.devices)
            throw std::logic_error("the yield is not what is to be measured");
}
BENCHMARK(YieldOfDevices)->ArgName("jobs")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
