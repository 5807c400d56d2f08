// Taylor coefficients of a vibro-impactor driven by an electromagnet, order 20: from a tape, for each kind of lanes and
// instruction set, against hand-written code.

#include "graze/symbolic/expression.hpp"
#include "graze/tape/jet.hpp"
#include "graze/tape/tape.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace graze;

constexpr int order = 20;
constexpr double damping = 0.01626, gap = 2.9379, alpha1 = 0.9047, alpha2 = 1.2424, frequency = 0.4093, voltage = 0.6;
constexpr double initial[4] = {0.1, 0.02, 0.3, 0.4};

Tape impactor() {
    const auto graph = Graph::create();
    const std::vector<Expression> states{graph->symbol("x"), graph->symbol("v"), graph->symbol("I"),
                                         graph->symbol("phase")};
    const std::vector<Expression> parameters{graph->symbol("zeta"),   graph->symbol("d"),     graph->symbol("alpha1"),
                                             graph->symbol("alpha2"), graph->symbol("omega"), graph->symbol("V")};
    const auto &x = states[0], &v = states[1], &current = states[2], &phase = states[3];
    const auto &zeta = parameters[0], &d = parameters[1], &a1 = parameters[2], &a2 = parameters[3],
               &omega = parameters[4], &amplitude = parameters[5];
    const Expression distance = 1 + d - x;
    const Expression force = pow(current, 2) / pow(distance, 2);
    const std::vector<Expression> rates{
        v, force - (x + 2 * zeta * v),
        (amplitude * sin(phase) - (v / pow(distance, 2) + a2) * current) / (1 / distance + a1), omega};
    return compile_tape(states, parameters, rates, std::vector<Expression>{x - d, x + d});
}

/// The same series as straight-line code for one trajectory and one order, as a code generator would write it.
class HandWritten {
public:
    [[gnu::noinline, gnu::target("avx2,fma")]] void compute(const double* state);
    double x[order + 1], v[order + 1], current[order + 1];

private:
    double phase_[2], sine_[order + 1], cosine_[order + 1], distance_[order + 1], squared_[order + 1],
        current_squared_[order + 1], force_[order + 1], ratio_[order + 1], resistance_[order + 1], product_[order + 1],
        inductance_[order + 1], reciprocal_[order + 1];
};

#define GRAZE_SUM(result, first, last, term_a, term_b)                                                                 \
    double result;                                                                                                     \
    {                                                                                                                  \
        double sums[2] = {0, 0};                                                                                       \
        _Pragma("GCC unroll 32") for (int j = first; j <= (last); ++j) sums[j % 2] =                                   \
            __builtin_fma(term_a, term_b, sums[j % 2]);                                                                \
        result = sums[0] + sums[1];                                                                                    \
    }

void HandWritten::compute(const double* state) {
    x[0] = state[0];
    v[0] = state[1];
    current[0] = state[2];
    phase_[0] = state[3];
    phase_[1] = frequency;
    sine_[0] = std::sin(phase_[0]);
    cosine_[0] = std::cos(phase_[0]);
    distance_[0] = 1 + gap - x[0];
    const double inverse_distance = 1 / distance_[0];
    const double inverse_squared = inverse_distance * inverse_distance;
    const double inverse_inductance = 1 / (inverse_distance + alpha1);
#pragma GCC unroll 32
    for (int k = 0; k <= order; ++k) {
        const double inverse = 1.0 / (k == 0 ? 1 : k);
        if (k > 0) {
            x[k] = v[k - 1] * inverse;
            v[k] = (force_[k - 1] - x[k - 1] - 2 * damping * v[k - 1]) * inverse;
            GRAZE_SUM(rest, 1, k - 1, inductance_[j], current[k - j] * (k - j))
            const double rate = voltage * sine_[k - 1] - product_[k - 1];
            current[k] = (rate - rest) * inverse_inductance * inverse;
            sine_[k] = frequency * inverse * cosine_[k - 1];
            cosine_[k] = -frequency * inverse * sine_[k - 1];
            distance_[k] = -x[k];
        }
        GRAZE_SUM(squared, 0, k, distance_[j], distance_[k - j])
        squared_[k] = squared;
        GRAZE_SUM(current_squared, 0, k, current[j], current[k - j])
        current_squared_[k] = current_squared;
        GRAZE_SUM(force, 1, k, squared_[j], force_[k - j])
        force_[k] = (current_squared_[k] - force) * inverse_squared;
        GRAZE_SUM(ratio, 1, k, squared_[j], ratio_[k - j])
        ratio_[k] = (v[k] - ratio) * inverse_squared;
        resistance_[k] = k == 0 ? ratio_[0] + alpha2 : ratio_[k];
        GRAZE_SUM(product, 0, k, resistance_[j], current[k - j])
        product_[k] = product;
        GRAZE_SUM(reciprocal, 1, k, distance_[j], reciprocal_[k - j])
        reciprocal_[k] = ((k == 0 ? 1.0 : 0.0) - reciprocal) * inverse_distance;
        inductance_[k] = k == 0 ? reciprocal_[0] + alpha1 : reciprocal_[k];
    }
}
#undef GRAZE_SUM

/// Returns the smallest time of one call, in seconds.
template <class Compute>
double least_time(Compute&& compute) {
    using Clock = std::chrono::steady_clock;
    double least = std::numeric_limits<double>::infinity();
    for (int repetition = 0; repetition < 20; ++repetition) {
        constexpr int calls = 2000;
        const auto start = Clock::now();
        for (int i = 0; i < calls; ++i)
            compute();
        least = std::min(least, std::chrono::duration<double>(Clock::now() - start).count() / calls);
    }
    return least;
}

/// States that change slightly between calls, so that no call repeats the last one.
struct States {
    explicit States(int width) {
        for (const double value : initial)
            for (int lane = 0; lane < width; ++lane)
                values.push_back(value + 1e-3 * lane);
    }
    const std::vector<double>& next() {
        values[0] = values[0] > 0.2 ? 0.1 : values[0] + 1e-6;
        return values;
    }
    std::vector<double> values;
};

double hand_written_time() {
    HandWritten jet;
    States states(1);
    return least_time([&] {
        jet.compute(states.next().data());
        benchmark::DoNotOptimize(jet.current[order]);
    });
}

std::unique_ptr<Jet> impactor_jet(LaneKind kind, InstructionSet set, MachineCode code) {
    const Tape tape = impactor();
    auto jet = make_jet(tape, order, kind, set, code);
    const int width = jet->width();
    std::vector<double> parameters;
    for (const double value : {damping, gap, alpha1, alpha2, frequency, voltage})
        for (int lane = 0; lane < width; ++lane)
            parameters.push_back(lane == 0 || kind == LaneKind::ensemble ? value : 0.0);
    jet->set_parameters(parameters);
    return jet;
}

void tape_jet(benchmark::State& state, LaneKind kind, InstructionSet set, MachineCode code) {
    const auto jet = impactor_jet(kind, set, code);
    States states(jet->width());
    for (auto unused : state) {
        jet->compute(states.next());
        benchmark::DoNotOptimize(jet->state(2)[order * jet->width()]);
    }
    HandWritten reference;
    if (kind == LaneKind::single && __builtin_cpu_supports("fma")) {
        reference.compute(states.values.data());
        const double own = jet->state(2)[order];
        if (std::abs(reference.current[order] - own) > 1e-12 * std::abs(own))
            state.SkipWithError("the two jets differ");
        state.counters["by_hand/tape"] = hand_written_time() / least_time([&] { jet->compute(states.next()); });
    }
    const int lanes = kind == LaneKind::ensemble ? jet->width() : 1;
    state.counters["jets"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * lanes, benchmark::Counter::kIsRate);
}

void hand_written_jet(benchmark::State& state) {
    if (!__builtin_cpu_supports("fma") || !__builtin_cpu_supports("avx2")) {
        state.SkipWithError("needs fused multiplication and addition");
        return;
    }
    HandWritten jet;
    States states(1);
    for (auto unused : state) {
        jet.compute(states.next().data());
        benchmark::DoNotOptimize(jet.current[order]);
    }
    state.counters["jets"] = benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void compile_and_make(benchmark::State& state, MachineCode code) {
    for (auto unused : state)
        benchmark::DoNotOptimize(impactor_jet(LaneKind::single, best_instruction_set(), code).get());
}

const int registered = [] {
    benchmark::RegisterBenchmark("hand_written_jet", hand_written_jet);
    for (const auto set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
        if (!is_supported(set))
            continue;
        const std::string name(name_of(set));
        benchmark::RegisterBenchmark(("tape_jet/single/" + name).c_str(), tape_jet, LaneKind::single, set,
                                     MachineCode::never);
        if (set != InstructionSet::baseline) // for which none is made
            benchmark::RegisterBenchmark(("tape_jet/machine_code/" + name).c_str(), tape_jet, LaneKind::single, set,
                                         MachineCode::at_once);
        benchmark::RegisterBenchmark(("tape_jet/ensemble/" + name).c_str(), tape_jet, LaneKind::ensemble, set,
                                     MachineCode::never);
    }
    benchmark::RegisterBenchmark("compile_tape_and_make_jet", compile_and_make, MachineCode::never);
    benchmark::RegisterBenchmark("compile_tape_and_make_code", compile_and_make, MachineCode::at_once);
    return 0;
}();

} // namespace
