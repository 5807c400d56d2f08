#include "identify/fit_layout.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace graze {

namespace {

void require_parameters(const System& system, const FitTask& task) {
    const std::vector<std::string> names = system.model().independent_parameters();
    std::set<std::size_t> seen;
    for (const UnknownParameter& unknown : task.parameters) {
        require_index(unknown.parameter.place(), names.size(), "independent parameter");
        const std::string& name = names[unknown.parameter.place()];
        if (!seen.insert(unknown.parameter.place()).second)
            throw InputError(fmt::format("parameter '{}' is to be found twice", name), "leave one of them out");
        if (!std::isfinite(unknown.guess))
            throw InputError(fmt::format("the guess of parameter '{}' is {}", name, unknown.guess),
                             "give a finite number");
        if (!(unknown.least < unknown.greatest) || unknown.guess < unknown.least || unknown.guess > unknown.greatest)
            throw InputError(
                fmt::format("the guess {:.9g} of parameter '{}' is not within its bounds, {:.9g} and {:.9g}",
                            unknown.guess, name, unknown.least, unknown.greatest),
                "give bounds that rise, with the guess between them");
    }
    if (!task.values.empty())
        require_size(task.values.size(), names.size(), "values of independent parameters");
    require_finite(task.values, "the value of a parameter");
}

void require_outputs(const FitTask& task) {
    if (task.outputs.empty())
        throw InputError("no output is compared with the model", "give one output or more");
    for (const MeasuredOutput& output : task.outputs) {
        for (const double value : {output.gain, output.offset, output.noise})
            require_finite(value, fmt::format("gain, offset or noise of '{}'", output.name));
        if (output.gain == 0 || output.noise < 0)
            throw InputError(fmt::format("the gain of '{}' is 0, or its noise is negative", output.name),
                             "give a gain that is not 0, and noise of 0 where it is not known");
    }
}

/// Refuses readings so large that the others would lose all digits beside them.
void require_proportion(const FitTask& task) {
    constexpr double most = 1e12;
    for (std::size_t r = 0; r < task.records.size(); ++r)
        for (const FitRecord::Readings& readings : task.records[r].readings) {
            std::vector<double> sizes;
            for (const double value : readings.values)
                sizes.push_back(std::abs(value));
            const auto upper = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 3 / 4);
            std::nth_element(sizes.begin(), upper, sizes.end());
            for (std::size_t i = 0; i < readings.values.size(); ++i)
                if (const double size = std::abs(readings.values[i]); *upper > 0 && size / most > *upper)
                    throw InputError(
                        fmt::format("the reading {:.6g} of '{}' at time {:.9g}{} is out of all proportion: three "
                                    "quarters of its readings are {:.6g} at most",
                                    readings.values[i], task.outputs[readings.output].name, task.records[r].times[i],
                                    task.records.size() > 1 ? fmt::format(" of record {}", r + 1) : "", *upper),
                        "leave that row out");
        }
}

void require_record(const System& system, const FitTask& task, const FitRecord& record) {
    const std::size_t times = record.times.size();
    if (times < 2 || record.readings.empty())
        throw InputError("a record has fewer than two times, or no readings", "leave it out");
    require_finite(record.times, "a time of a record");
    if (std::adjacent_find(record.times.begin(), record.times.end(), std::greater_equal<>()) != record.times.end())
        throw InputError("the times of a record do not rise", "give them in order, each once");
    std::set<std::size_t> seen;
    for (const FitRecord::Readings& readings : record.readings) {
        require_index(readings.output, task.outputs.size(), "output");
        require_size(readings.values.size(), times, "readings");
        require_finite(readings.values, "a reading");
        if (!seen.insert(readings.output).second)
            throw InputError(fmt::format("a record has two readings of '{}'", task.outputs[readings.output].name),
                             "leave one of them out");
    }
    for (const auto& [parameter, value] : record.known) {
        require_index(parameter.place(), system.parameters(), "independent parameter");
        require_finite(value, "the value of a record's parameter");
    }
    if (!record.start.empty())
        require_size(record.start.size(), system.states(), "states");
    require_finite(record.start, "a state at the beginning of a record");
    require_index(record.mode, system.model().modes.size(), "mode");
    std::set<std::size_t> states;
    for (const std::size_t state : record.unknown_states) {
        require_index(state, system.states(), "state");
        if (!states.insert(state).second)
            throw InputError(fmt::format("state '{}' is to be found twice", system.model().states[state].name),
                             "leave one of them out");
    }
}

/// Size of the second differences of all readings around each time, relative to their ranges.
std::vector<double> roughness_of(const FitRecord& record) {
    std::vector<double> rough(record.times.size(), 0.0);
    for (const FitRecord::Readings& readings : record.readings) {
        const auto [least, greatest] = std::minmax_element(readings.values.begin(), readings.values.end());
        const double range = *greatest > *least ? *greatest - *least : 1;
        for (std::size_t i = 1; i + 1 < rough.size(); ++i)
            rough[i] += std::abs(readings.values[i - 1] - 2 * readings.values[i] + readings.values[i + 1]) / range;
    }
    std::vector<double> around = rough; // the largest of three neighbours
    for (std::size_t i = 1; i + 1 < rough.size(); ++i)
        around[i] = std::max({rough[i - 1], rough[i], rough[i + 1]});
    return around;
}

/// Default number of pieces of a record: enough readings in each, and not too many unknowns.
std::size_t usual_pieces(const System& system, const FitRecord& record) {
    constexpr std::size_t readings_each = 30, most_unknowns = 240, most_pieces = 60;
    const std::size_t by_readings = record.times.size() / readings_each;
    const std::size_t by_states = most_unknowns / std::max<std::size_t>(1, system.states());
    return std::clamp<std::size_t>(std::min(by_readings, by_states), 1, most_pieces);
}

} // namespace

std::size_t readings_of(const FitTask& task) {
    std::size_t count = 0;
    for (const FitRecord& record : task.records)
        count += record.times.size() * record.readings.size();
    return count;
}

std::size_t unknowns_of(const FitTask& task) {
    std::size_t count = task.parameters.size();
    for (const MeasuredOutput& output : task.outputs)
        count += (output.gain_unknown ? 1U : 0U) + (output.offset_unknown ? 1U : 0U);
    for (const FitRecord& record : task.records)
        count += record.unknown_states.size();
    return count;
}

void require_task(const System& system, const FitTask& task, const FitSettings& settings) {
    require_parameters(system, task);
    require_outputs(task);
    if (task.records.empty())
        throw InputError("there is no record to fit", "give one or more");
    for (const FitRecord& record : task.records)
        require_record(system, task, record);
    const std::size_t unknown = unknowns_of(task), readings = readings_of(task);
    require_proportion(task);
    if (unknown == 0)
        throw InputError("there is no unknown to fit", "name a parameter, gain, offset or state that is not known");
    if (readings <= unknown)
        throw InputError(fmt::format("{} readings cannot determine {} numbers", readings, unknown),
                         "record more, or say what is known");
    if (!std::isfinite(settings.piece) || settings.piece < 0 || settings.most_iterations < 1)
        throw InputError("the length of pieces is negative, or no iteration is allowed", "give 0 or a length of time");
    settings.simulation.validate();
}

std::vector<FitPiece> cut_records(const System& system, const FitTask& task, const FitSettings& settings) {
    std::vector<FitPiece> pieces;
    for (std::size_t r = 0; r < task.records.size(); ++r) {
        const FitRecord& record = task.records[r];
        const double begin = record.times.front(), length = record.times.back() - begin;
        const double by_length = settings.piece > 0 ? std::round(length / settings.piece) : 0;
        const auto most = static_cast<double>(record.times.size() - 1);
        const auto count = settings.piece > 0 ? static_cast<std::size_t>(std::clamp(by_length, 1.0, most))
                                              : usual_pieces(system, record);
        const std::vector<double> rough = roughness_of(record);
        std::size_t from = 0;
        for (std::size_t k = 0; k < count; ++k) {
            std::size_t to = record.times.size() - 1;
            if (k + 1 < count) {
                const double part = length / static_cast<double>(count),
                             middle = begin + static_cast<double>(k + 1) * part;
                constexpr double slack = 0.25;
                const auto place = [&](double time) {
                    return static_cast<std::size_t>(std::lower_bound(record.times.begin(), record.times.end(), time) -
                                                    record.times.begin());
                };
                to = std::max(from + 1, place(middle));
                for (std::size_t i = std::max(from + 1, place(middle - slack * part));
                     i < place(middle + slack * part) && i + 1 < record.times.size(); ++i)
                    to = rough[i] < rough[to] ? i : to;
            }
            if (to <= from || to >= record.times.size())
                continue;
            pieces.push_back({.record = r,
                              .first = from == 0 ? 0 : from + 1,
                              .last = to + 1,
                              .begin = record.times[from],
                              .end = record.times[to],
                              .mode = record.mode,
                              .has_next = to + 1 < record.times.size(),
                              .is_first = from == 0});
            from = to;
        }
    }
    return pieces;
}

} // namespace graze
