#include "graze/study/run_length.hpp"

#include "graze/base/input_error.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr int default_periods = 20;

struct Phase {
    std::size_t state;
    std::optional<double> time; ///< duration of a period, if the rate is constant and the same in all modes
};

std::optional<double> value_in_parameters(const Model& model, const Expression& expression) {
    const Expression expanded = Model(model).expand(expression);
    const auto is_parameter = [&](const Expression& symbol) { return model.find_parameter(symbol.name()).has_value(); };
    const std::vector<Expression> symbols = symbols_of({{expanded}});
    if (!std::all_of(symbols.begin(), symbols.end(), is_parameter))
        return std::nullopt;
    return model.values_of({{expanded}})[0];
}

std::optional<double> time_of_period(const Model& model, std::size_t state) {
    std::optional<double> common;
    for (const Mode& mode : model.modes) {
        const auto rate = value_in_parameters(model, mode.rates[state]);
        if (!rate || (common && *rate != *common))
            return std::nullopt;
        common = rate;
    }
    const auto period = value_in_parameters(model, *model.states[state].period);
    const double time = period && common ? *period / std::abs(*common) : 0;
    if (!(time > 0) || !std::isfinite(time))
        throw InputError(fmt::format("the phase '{}' does not move", model.states[state].name),
                         "give time T, or choose parameters that make it move");
    return time;
}

/// @param purpose why a phase is needed, for messages
Phase find_phase(const Model& model, const RunLengthRequest& request, const std::string& purpose) {
    std::vector<std::string> names;
    for (const State& state : model.states)
        if (state.period)
            names.push_back(state.name);
    const std::string& wanted = request.phase;
    if (names.empty())
        throw InputError(fmt::format("{}, but the model has no cyclic state", purpose), "give time T");
    if (!wanted.empty() && std::find(names.begin(), names.end(), wanted) == names.end())
        throw InputError({"phase", 0, 0}, fmt::format("'{}' is no cyclic state", wanted),
                         name_advice(wanted, names, ""));
    if (wanted.empty() && names.size() > 1)
        throw InputError(fmt::format("{}, but there are several cyclic states", purpose),
                         fmt::format("choose one by phase: {}", fmt::join(names, ", ")));
    const std::size_t state = *model.find_state(wanted.empty() ? names.front() : wanted);
    return {state, time_of_period(model, state)};
}

std::size_t positive_count(const std::optional<int>& count, const std::string& name) {
    if (count && *count <= 0)
        throw InputError({name, 0, 0}, fmt::format("{} is not a positive number", *count), "give 1 or more");
    return count ? static_cast<std::size_t>(*count) : 0;
}

void refuse_contradictions(const RunLengthRequest& request) {
    const auto refuse = [&](bool one, bool other, const char* names) {
        if (one && other)
            throw InputError(fmt::format("{} cannot be given together", names), "choose one of them");
    };
    const bool time = request.time.has_value(), periods = request.periods.has_value();
    refuse(time, periods, "time and periods");
    refuse(time, request.contacts.has_value(), "time and a number of contacts");
    refuse(periods, request.contacts.has_value(), "periods and a number of contacts");
    refuse(request.after.has_value(), request.skip.has_value(), "skip and after");
}

} // namespace

RunLength run_length(const Model& model, const RunLengthRequest& request) {
    refuse_contradictions(request);
    const bool after = request.after.has_value();
    RunLength length;
    length.shown.contacts = positive_count(request.contacts, "contacts");
    length.shown.periods = positive_count(request.periods, "periods");
    length.transient.periods = positive_count(request.skip, "skip");
    if (request.time)
        length.shown.expected = length.shown.duration = *request.time;
    if (after)
        length.transient.expected = length.transient.duration = *request.after;
    const bool by_default = length.shown.empty();
    if (by_default)
        length.shown.periods = default_periods;
    if (length.shown.periods == 0 && length.transient.periods == 0) {
        if (!request.phase.empty())
            throw InputError({"phase", 0, 0}, "no periods are counted", "leave it out, or give periods N");
        return length;
    }

    const Phase phase =
        find_phase(model, request, by_default ? "nothing says how long to simulate" : "periods are to be counted");
    for (LegEnd* leg : {&length.transient, &length.shown})
        if (phase.time && leg->periods > 0)
            leg->expected = static_cast<double>(leg->periods) * *phase.time;
    if (after) {
        // The phase at which the shown leg begins is not known beforehand, so its passages cannot be counted.
        if (!phase.time)
            throw InputError(fmt::format("after does not go with periods of '{}', whose rate is not constant",
                                         model.states[phase.state].name),
                             "use skip N, or time T");
        length.shown.duration = *length.shown.expected;
        length.shown.periods = 0;
        return length;
    }
    Probe probe;
    probe.name = "period";
    probe.kind = Probe::Kind::phase;
    probe.state = phase.state;
    probe.value = model.graph->number(model.initial_state()[phase.state]);
    length.period = probe;
    return length;
}

void run_legs(Trajectory& trajectory, JetSet& jets, RunControl& control, const RunLength& length,
              const std::function<bool()>& interrupted, const std::function<void()>& begin) {
    if (!length.transient.empty()) {
        control.begin(length.transient, 0, false);
        run(trajectory, jets);
        const Ending ending = trajectory.outcome().ending;
        if (interrupted() || (ending != Ending::end_time && ending != Ending::stopped))
            return;
        trajectory.extend(trajectory.time() + length.shown.duration);
    }
    control.begin(length.shown, trajectory.time(), true);
    begin();
    run(trajectory, jets);
}

} // namespace graze
