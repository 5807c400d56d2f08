#include "program/run_length.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/transform.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr int default_periods = 20;

struct Phase {
    std::size_t state;
    std::optional<double> time; ///< of one period, if its rate is the same number everywhere
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
                         "give --time T, or choose parameters that make it move");
    return time;
}

/// @param purpose the option that needs a phase
Phase find_phase(const Model& model, const std::string& wanted, const std::string& purpose) {
    std::vector<std::string> names;
    for (const State& state : model.states)
        if (state.period)
            names.push_back(state.name);
    if (names.empty())
        throw InputError(fmt::format("{}, but the model has no cyclic state", purpose), "give --time T");
    if (!wanted.empty() && std::find(names.begin(), names.end(), wanted) == names.end())
        throw InputError({"--phase", 0, 0}, fmt::format("'{}' is no cyclic state", wanted),
                         name_advice(wanted, names, ""));
    if (wanted.empty() && names.size() > 1)
        throw InputError(fmt::format("{}, but there are several cyclic states", purpose),
                         fmt::format("choose one by --phase: {}", fmt::join(names, ", ")));
    const std::size_t state = *model.find_state(wanted.empty() ? names.front() : wanted);
    return {state, time_of_period(model, state)};
}

std::size_t positive_count(const std::optional<int>& count, const char* option) {
    if (count && *count <= 0)
        throw InputError({option, 0, 0}, fmt::format("{} is not a positive number", *count), "give 1 or more");
    return count ? static_cast<std::size_t>(*count) : 0;
}

void refuse_both(bool one, bool other, const char* names, const char* remedy) {
    if (one && other)
        throw InputError(fmt::format("{} cannot be given together", names), remedy);
}

} // namespace

RunLength run_length(const Model& model, const SimulateArguments& arguments) {
    const bool by_time = !arguments.time.empty(), after = !arguments.after.empty();
    refuse_both(by_time, arguments.periods.has_value(), "--time and --periods", "choose one of them");
    refuse_both(by_time, arguments.contact_count.has_value(), "--time and a number of --contacts",
                "choose one of them");
    refuse_both(arguments.periods.has_value(), arguments.contact_count.has_value(),
                "--periods and a number of --contacts", "choose one of them");
    refuse_both(after, arguments.skip.has_value(), "--skip and --after", "choose one of them");

    RunLength length;
    length.shown.contacts = positive_count(arguments.contact_count, "--contacts");
    length.shown.periods = positive_count(arguments.periods, "--periods");
    length.transient.periods = positive_count(arguments.skip, "--skip");
    if (by_time)
        length.shown.expected = length.shown.duration = positive_value_of(model, arguments.time, "--time");
    if (after)
        length.transient.expected = length.transient.duration = positive_value_of(model, arguments.after, "--after");
    const bool by_default = length.shown.empty();
    if (by_default)
        length.shown.periods = default_periods;
    if (length.shown.periods == 0 && length.transient.periods == 0) {
        if (!arguments.phase.empty())
            throw InputError({"--phase", 0, 0}, "no periods are counted", "leave it out, or give --periods N");
        return length;
    }

    const Phase phase = find_phase(model, arguments.phase,
                                   by_default ? "nothing says how long to simulate" : "periods are to be counted");
    for (LegEnd* leg : {&length.transient, &length.shown})
        if (phase.time && leg->periods > 0)
            leg->expected = static_cast<double>(leg->periods) * *phase.time;
    if (after) {
        // The phase at which the shown leg begins is not known beforehand, so its passages cannot be counted.
        if (!phase.time)
            throw InputError(fmt::format("--after does not go with periods of '{}', whose rate is not constant",
                                         model.states[phase.state].name),
                             "use --skip N, or --time T");
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

} // namespace graze
