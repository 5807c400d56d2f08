// Curves of special points in two parameters: points per second, with multipliers, all test functions and certificates.
// Folds, flips and touches are those of the microactuator's orbits without impact and with one; torus points those of a
// map in the plane, since no shipped model has any. Then curves of orbits with increasing numbers of segments.

#include "microactuator.hpp"

#include "graze/branch/switching.hpp"
#include "graze/model/model_file.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace {

using namespace graze;

/// The orbit without impact, which has a flip, a fold and a grazing as the voltage increases.
Branch branch_without_impact(const Model& model) {
    AttractorOptions settle;
    settle.section = "longest";
    settle.cycles = 4000;
    BranchSettings settings;
    settings.parameter = model.independent_parameter("V");
    settings.least = 0;
    settings.greatest = 3;
    return follow_branch(System(model), find_orbit(System(model), settle).orbit, settings);
}

SpecialPoint first_of(const Branch& branch, PointType type) {
    const auto found = std::find_if(branch.special.begin(), branch.special.end(),
                                    [type](const SpecialPoint& point) { return point.type == type; });
    if (found == branch.special.end())
        throw std::logic_error("the branch is not what is to be measured");
    return *found;
}

/// Henon's map x -> y, y -> a - b x - y^2 + x y / 10 once in each unit of time: fixed points y have the determinant b -
/// y/10.
Model spiralling_map() {
    return parse_model(R"toml(
[parameters]
a = 0.336
b = 0.5
[states]
x = 0.2
y = 0.2
clock = 0
[modes.rest]
rates = { x = 0, y = 0, clock = 1 }
watch = ["tick"]
[events.tick]
function = "1 - clock"
[jumps.map]
x = "y"
y = "a - b*x - y^2 - x*y/10"
clock = 0
[[transitions]]
mode = "rest"
event = "tick"
jump = "map"
next = "rest"
label = "map"
[initial]
mode = "rest"
)toml",
                       "map.toml");
}

/// Follows the curve through a point in both directions and returns the number of points.
std::size_t follow_curve(const Model& model, const SpecialPoint& point, const std::string& first,
                         const std::string& second, std::size_t steps) {
    std::size_t points = 0;
    for (const int direction : {1, -1}) {
        BranchSettings settings;
        settings.parameter = model.independent_parameter(first);
        settings.direction = direction;
        settings.steps = steps;
        settings.continuation.largest_step = 0.01;
        settings.kept = point;
        settings.free = {model.independent_parameter(second)};
        points += follow_branch(System(model), point.solution.orbit, settings).points.size();
    }
    return points;
}

void measure(benchmark::State& state, const Model& model, const SpecialPoint& point, const std::string& first,
             const std::string& second, std::size_t steps = 20) {
    std::size_t points = 0;
    for (auto _ : state)
        points += follow_curve(model, point, first, second, steps);
    if (points <= static_cast<std::size_t>(state.iterations()) * 2)
        throw std::logic_error("the curve is not what is to be measured");
    state.counters["points"] = benchmark::Counter(static_cast<double>(points), benchmark::Counter::kIsRate);
    state.counters["segments"] = static_cast<double>(point.solution.orbit.segments());
}

void CurveOfTheMicroactuator(benchmark::State& state, PointType type) {
    Model model = microactuator(0.1);
    measure(state, model, first_of(branch_without_impact(model), type), "omega", "V");
}
BENCHMARK_CAPTURE(CurveOfTheMicroactuator, folds, PointType::fold)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CurveOfTheMicroactuator, flips, PointType::flip)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CurveOfTheMicroactuator, touches, PointType::grazing)->Unit(benchmark::kMillisecond);

void CurveOfTorusPoints(benchmark::State& state) {
    const Model model = spiralling_map();
    BranchSettings settings;
    settings.parameter = model.independent_parameter("b");
    settings.greatest = 2;
    const Orbit orbit{parse_signature(model, "map"), model.parameter_values(), {{0.2, 0.2, 0}}, {1}, {}};
    const SpecialPoint torus = first_of(follow_branch(System(model), orbit, settings), PointType::torus);
    measure(state, model, torus, "a", "b");
}
BENCHMARK(CurveOfTorusPoints)->Unit(benchmark::kMillisecond);

/// Curves of the orbit {J1, J8} repeated several times: folds, and flips, whose coefficient costs more. An odd number
/// of repetitions keeps the multiplier -1.
void CurveOfManySegments(benchmark::State& state, PointType type) {
    const Model model = microactuator(microactuator_start);
    const Branch branch = follow_branch(System(model), microactuator_orbit(), microactuator_settings());
    SpecialPoint point = first_of(branch, type);
    const auto rounds = static_cast<std::size_t>(state.range(0));
    // The frame drifts in each repetition. The drift is taken from a neighbouring point, because the equations for it
    // are singular at a fold.
    const auto next = std::min_element(branch.points.begin(), branch.points.end(), [&](const auto& a, const auto& b) {
        return std::abs(a.arclength - point.arclength) < std::abs(b.arclength - point.arclength);
    });
    const Orbit elsewhere = solve_orbit(System(model), repeated(next->solution.orbit, rounds)).orbit;
    const std::size_t segments = point.solution.orbit.segments();
    point.solution.orbit = repeated(point.solution.orbit, rounds);
    const std::size_t frame = *model.find_state("x1");
    for (std::size_t i = segments; i < segments * rounds; ++i)
        point.solution.orbit.starts[i][frame] += elsewhere.starts[i][frame] - elsewhere.starts[i % segments][frame];
    measure(state, model, point, "omega", "V", 3);
    state.SetComplexityN(state.range(0));
}
BENCHMARK_CAPTURE(CurveOfManySegments, folds, PointType::fold)
    ->Arg(1)
    ->Arg(5)
    ->Arg(25)
    ->Arg(75)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
BENCHMARK_CAPTURE(CurveOfManySegments, flips, PointType::flip)->Arg(1)->Arg(5)->Arg(25)->Unit(benchmark::kMillisecond);

} // namespace
