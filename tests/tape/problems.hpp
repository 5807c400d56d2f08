#pragma once

#include "graze/symbolic/expression.hpp"
#include "graze/tape/jet.hpp"
#include "graze/tape/tape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace graze::testing {

inline constexpr double eps = std::numeric_limits<double>::epsilon();

/// A vector field with outputs, and values of its states and parameters.
struct Problem {
    std::shared_ptr<Graph> graph = Graph::create();
    std::vector<Expression> states, parameters, rates, outputs;
    std::vector<double> state_values, parameter_values;

    Expression state(const std::string& name, double value) {
        state_values.push_back(value);
        return states.emplace_back(graph->symbol(name));
    }
    Expression parameter(const std::string& name, double value) {
        parameter_values.push_back(value);
        return parameters.emplace_back(graph->symbol(name));
    }
    Tape tape() const { return compile_tape(states, parameters, rates, outputs); }
};

inline std::vector<InstructionSet> supported_sets() {
    std::vector<InstructionSet> sets;
    for (const auto set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512})
        if (is_supported(set))
            sets.push_back(set);
    return sets;
}

/// Time as a state: of degree 1, or written such that its degree is not known from the expressions.
enum class Time { linear, hidden };
inline Expression add_time(Problem& problem, Time kind, double start) {
    const Expression time = problem.state("time", start);
    if (kind == Time::linear) {
        problem.rates.push_back(problem.graph->number(1));
    } else {
        const Expression one = problem.state("one", 1);
        problem.rates.push_back(one);
        problem.rates.push_back(problem.parameter("nothing", 0) * one);
    }
    return time;
}

/// Coefficients of all outputs, [output][order], with one lane.
inline std::vector<std::vector<double>> output_series(const Problem& problem, int order, InstructionSet set) {
    const Tape tape = problem.tape();
    const auto jet = make_jet(tape, order, LaneKind::single, set);
    jet->set_parameters(problem.parameter_values);
    jet->compute(problem.state_values);
    std::vector<std::vector<double>> series;
    for (std::size_t i = 0; i < problem.outputs.size(); ++i)
        series.emplace_back(jet->output(i), jet->output(i) + order + 1);
    return series;
}
inline std::vector<double> state_series(const Problem& problem, std::size_t state, int order, InstructionSet set) {
    const Tape tape = problem.tape();
    const auto jet = make_jet(tape, order, LaneKind::single, set);
    jet->set_parameters(problem.parameter_values);
    jet->compute(problem.state_values);
    return {jet->state(state), jet->state(state) + order + 1};
}

/// A problem in which every operation occurs, analytic near the given values.
inline Problem everything() {
    Problem p;
    const Expression x = p.state("x", 0.3), y = p.state("y", 0.7), z = p.state("z", -0.4);
    const Expression phase = p.state("phase", 0.9), frozen = p.state("frozen", 1.1);
    const Expression a = p.parameter("a", 0.8), b = p.parameter("b", 1.3);
    const Expression exponent = p.parameter("exponent", 1.7), unused = p.parameter("unused", 5);
    p.rates = {y, -a * sin(x) - 0.1 * y + b * cos(phase), tanh(y) / (1 + x * x) - z * frozen, 0.5 * a * sqrt(b),
               p.graph->number(0)};
    p.outputs = {x + y - 2 * z + a * b,
                 3 * (x - 1) - (y + z) / 4,
                 x * y * z,
                 x / (2 + y),
                 a / (2 + y),
                 pow(x, 3) - pow(2 + y, -2),
                 sqrt(1 + y * y),
                 pow(2 + z, exponent),
                 pow(2 + z, -0.5) + pow(2 + z, 2.5),
                 pow(a, x),
                 pow(2 + x, y),
                 exp(x - y),
                 log(2 + x),
                 sin(x * y) + cos(x * y),
                 sinh(z) * cosh(z),
                 tan(x) - tanh(y),
                 erf(x * y) - y * erf(z),
                 asin(x / 2) - acos(z / 2),
                 atan(x + y),
                 sin(3 * phase) * exp(phase / 5),
                 cos(phase) * tan(phase) - sinh(phase) - cosh(phase) - tanh(phase),
                 erf(phase) - erf(2 * phase - a),
                 phase * x,
                 y * phase + frozen * phase,
                 phase * phase,
                 exp(a) * asin(a / 2) + atan(b) * pow(a, exponent) * erf(a),
                 sin(frozen) / frozen,
                 x,
                 x * (x + y) * 2 - (a * x - b * y) * z + exp(frozen * a),
                 (b - a * x * y) * z,
                 (b - 2 * pow(x, 2)) * z,
                 (b - a * x / (2 + y)) * z,
                 (b - a / (2 + y)) * z,
                 (x * y - a * y * z) / (2 + x),
                 sinh(phase / 3) * exp(a * phase)};
    return p;
}

/// Returns the largest coefficient of each order, for relative errors. @param series coefficients, one series after
/// another
inline std::vector<double> sizes_of(const std::vector<double>& series, int order) {
    std::vector<double> size(static_cast<std::size_t>(order) + 1, 0.0);
    for (std::size_t i = 0; i < series.size(); ++i)
        size[i % size.size()] = std::max(size[i % size.size()], std::abs(series[i]));
    return size;
}

/// Copies numbers into lanes, [number * width + lane]; lane l is changed by `change(number, l)`.
template <class Change>
std::vector<double> spread(const std::vector<double>& numbers, int width, Change&& change) {
    std::vector<double> lanes;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        for (int lane = 0; lane < width; ++lane)
            lanes.push_back(change(i, lane));
    return lanes;
}

} // namespace graze::testing
