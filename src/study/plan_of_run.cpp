#include "study/plan_of_run.hpp"
#include "base/concatenated.hpp"
#include "base/random_number.hpp"
#include "graze/base/require.hpp"
#include "graze/study/runner.hpp"
#include "graze/symbolic/function.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace graze {

namespace {

double drawn(const StudyRun& run, std::size_t axis, std::size_t point) {
    const Variation& variation = run.motion().axes[axis];
    const std::uint64_t bits = mixed(mixed(mixed(run.motion().seed) ^ point) ^ axis);
    const double share = static_cast<double>(bits >> 11) * 0x1p-53; // in [0, 1)
    return variation.offset + (variation.logarithmic ? variation.low * std::pow(variation.high / variation.low, share)
                                                     : variation.low + share * (variation.high - variation.low));
}

/// Number of values along the first axis of a sweep, in one direction.
std::size_t sweep_length(const StudyRun& run) {
    return run.is_swept() ? run.motion().axes.front().values.size() : 1;
}

/// Number of points along the first axis of a sweep, in both directions.
std::size_t row_length(const StudyRun& run) {
    return sweep_length(run) * (run.is_swept() && run.motion().direction == SweepDirection::both ? 2 : 1);
}

/// Number of combinations of values of the axes, each of which makes a row.
std::size_t combinations(const StudyRun& run) {
    std::size_t count = 1;
    for (std::size_t a = run.is_swept() ? 1 : 0; a < run.motion().axes.size(); ++a)
        count *= std::max<std::size_t>(run.motion().axes[a].values.size(), 1);
    return count;
}

std::size_t rows_of(const StudyRun& run) {
    return combinations(run) * std::max<std::size_t>(run.motion().draws, 1);
}

/// Whether each point begins where the one before it in its row ended.
bool carries_states(const StudyRun& run) {
    return run.is_swept() && run.motion().carry;
}

/// The initial states that are functions of states and parameters.
Function following_states(const StudyRun& run) {
    if (run.motion().following.empty())
        return {};
    // The model of a copied run has a graph of its own, while these expressions belong to the original graph.
    const auto graph = run.motion().following.front().value.graph();
    std::vector<Expression> inputs, outputs;
    for (const State& state : run.model.states)
        inputs.push_back(graph->symbol(state.name));
    for (const Expression& parameter : run.model.parameter_symbols())
        inputs.push_back(graph->symbol(parameter.name()));
    for (const FollowingState& one : run.motion().following)
        outputs.push_back(one.value);
    return {inputs, outputs};
}

} // namespace

std::size_t direction_of(const StudyRun& run, std::size_t point) {
    require_index(point, points_of(run), "point");
    return point % row_length(run) < sweep_length(run) ? 0 : 1;
}

std::vector<double> coordinates_of(const StudyRun& run, std::size_t point) {
    require_index(point, points_of(run), "point");
    const std::size_t index = point % row_length(run);
    std::vector<double> coordinates(run.motion().axes.size());
    std::size_t rest = row_of(run, point) % combinations(run);
    for (std::size_t a = run.motion().axes.size(); a-- > 0;) {
        const Variation& axis = run.motion().axes[a];
        if (axis.values.empty()) {
            coordinates[a] = drawn(run, a, point);
        } else if (a == 0 && run.is_swept()) {
            const std::size_t size = axis.values.size();
            const bool falling = run.motion().direction == SweepDirection::down || index >= size;
            coordinates[a] = axis.values[falling ? size - 1 - index % size : index];
        } else {
            coordinates[a] = axis.values[rest % axis.values.size()];
            rest /= axis.values.size();
        }
    }
    return coordinates;
}

std::size_t row_of(const StudyRun& run, std::size_t point) {
    return point / row_length(run);
}

std::size_t chains_of(const StudyRun& run) {
    if (!run.has_motions())
        return 1;
    return carries_states(run) ? rows_of(run) : points_of(run);
}

std::size_t points_of(const StudyRun& run) {
    if (run.kind == RunKind::record)
        return run.record().records();
    return run.has_motions() ? rows_of(run) * row_length(run) : 1;
}

Plan plan_of(const StudyRun& given, const System& system, const PointRecord* start) {
    const auto kept = std::make_shared<const StudyRun>(given);
    const StudyRun& run = *kept;
    Plan plan;
    plan.carry = carries_states(run);
    plan.chain_length = plan.carry ? row_length(run) : 1;
    plan.chains = chains_of(run);
    std::vector<double> state = start ? start->result.state : std::vector<double>();
    const std::size_t mode = start ? start->result.mode : run.model.initial_mode;
    plan.start = [kept, &run, state, mode, system, following = following_states(run)](std::size_t point) {
        PointStart result{run.model.parameter_values(), state, mode};
        const std::vector<double> coordinates = coordinates_of(run, point);
        for (std::size_t a = 0; a < run.motion().axes.size(); ++a)
            if (!run.motion().axes[a].state)
                result.parameters[run.motion().axes[a].parameter.place()] = coordinates[a];
        if (result.state.empty())
            result.state = system.initial()(result.parameters);
        for (std::size_t a = 0; a < run.motion().axes.size(); ++a)
            if (const auto& varied = run.motion().axes[a].state)
                result.state[*varied] = coordinates[a];
        if (!run.motion().following.empty()) {
            const std::vector<double> values = following(concatenated(result.state, result.parameters));
            for (std::size_t i = 0; i < values.size(); ++i)
                result.state[run.motion().following[i].state] = values[i];
        }
        return result;
    };
    return plan;
}

} // namespace graze
