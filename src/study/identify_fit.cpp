#include "study/identify_fit.hpp"

#include "graze/base/physical_unit.hpp"
#include "graze/identify/fit.hpp"
#include "graze/model/named_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

FitTask task_of(const StudyRun& run, const std::vector<KeptRecord>& records) {
    const IdentifyRequest& request = run.identify;
    const Model& model = run.model;
    FitTask task;
    for (const IdentifyRequest::Unknown& one : request.unknowns) {
        UnknownParameter unknown;
        unknown.parameter = model.independent_parameter(one.name);
        const auto take = [&](const std::string& text, double& value) {
            if (!text.empty())
                value = value_of_text(model, text, run.place);
        };
        unknown.guess = model.parameter_values()[unknown.parameter.place()];
        take(one.guess, unknown.guess);
        take(one.least, unknown.least);
        take(one.greatest, unknown.greatest);
        task.parameters.push_back(unknown);
    }
    for (const IdentifyRequest::Reading& one : request.readings) {
        MeasuredOutput output;
        output.name = one.channel;
        output.value = named_value(model, one.value, run.place).value;
        output.gain = one.gain;
        output.offset = one.offset;
        output.gain_unknown = one.gain_unknown;
        output.offset_unknown = one.offset_unknown;
        output.noise = one.noise;
        task.outputs.push_back(std::move(output));
    }
    std::vector<std::size_t> unknown_states;
    for (std::size_t s = 0; s < model.states.size() && !request.all_known; ++s)
        if (std::find(request.known.begin(), request.known.end(), model.states[s].name) == request.known.end())
            unknown_states.push_back(s);
    for (const KeptRecord& kept : records) {
        FitRecord record;
        record.times = kept.samples.times;
        record.mode = model.initial_mode;
        record.unknown_states = unknown_states;
        for (std::size_t o = 0; o < request.readings.size(); ++o)
            record.readings.push_back(
                {o, kept.samples.values[kept.header.channel(request.readings[o].channel, "readings")]});
        for (const auto& [name, value] : kept.known)
            if (const auto parameter = model.find_independent_parameter(name))
                record.known.emplace_back(*parameter, value);
        task.records.push_back(std::move(record));
    }
    return task;
}

/// A reading in another unit than what it is compared with would be taken for something else.
void check_units(const StudyRun& run, const std::vector<KeptRecord>& records) {
    for (const KeptRecord& kept : records) {
        for (const IdentifyRequest::Reading& reading : run.identify.readings) { // whose gain may be unknown
            const auto unit = [&](const KeptRecord& of) {
                return of.header.channels[of.header.channel(reading.channel, "readings")].unit;
            };
            if (unit(kept) != unit(records.front()))
                throw InputError(run.place,
                                 fmt::format("{}: channel '{}' is in '{}', and that of the first record in '{}'",
                                             kept.name, reading.channel, unit(kept), unit(records.front())),
                                 "convert it by `scale` of the run that has the record");
        }
        const std::string &time = kept.header.time.unit, &wanted = run.model.time_unit;
        if (!time.empty() && !wanted.empty() && time != unit_symbol(wanted))
            throw InputError(run.place,
                             fmt::format("{}: its time is in {}, and that of the model in {}", kept.name, time, wanted),
                             "convert the times of the record");
        for (const IdentifyRequest::Reading& reading : run.identify.readings) {
            const std::string& unit = kept.header.channels[kept.header.channel(reading.channel, "readings")].unit;
            const std::string meant = named_value(run.model, reading.value, run.place).unit;
            if (!reading.gain_unknown && reading.gain == 1 && !unit.empty() && !meant.empty() &&
                unit_symbol(unit) != unit_symbol(meant))
                throw InputError(run.place,
                                 fmt::format("{}: channel '{}' is in {}, and what it measures in {}", kept.name,
                                             reading.channel, unit, meant),
                                 "convert it by `scale` of the run that has the record");
        }
    }
}

EstimateRecords estimates_of(const Fit& fit) {
    EstimateRecords records;
    const std::size_t count = fit.numbers.size();
    for (const FittedNumber& number : fit.numbers) {
        const bool known = number.estimate.freedom > 0;
        records.numbers.push_back({number.name, number.unit, number.estimate,
                                   number.at_bound ? "at its bound"
                                   : known         ? ""
                                                   : "not determined"});
    }
    records.covariance.assign(count * count, 0);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < count && fit.correlations.size() == count * count; ++j)
            records.covariance[i * count + j] =
                fit.correlations[i * count + j] * fit.numbers[i].estimate.error * fit.numbers[j].estimate.error;
    return records;
}

SampleSet residuals_of(const Fit& fit, const FitTask& task) {
    SampleSet samples;
    samples.width = 2 + task.outputs.size();
    for (std::size_t what = 0; what < 3; ++what)
        for (std::size_t r = 0; r < task.records.size(); ++r) {
            const FitRecord& record = task.records[r];
            for (std::size_t i = 0; i < record.times.size(); ++i) {
                samples.samplings.push_back(what);
                samples.times.push_back(record.times[i]);
                samples.values.push_back(static_cast<double>(r));
                samples.values.push_back(record.times[i]);
                for (std::size_t o = 0; o < record.readings.size(); ++o) {
                    const double read = record.readings[o].values[i], fitted = fit.records[r].fitted[o][i];
                    samples.values.push_back(what == 0 ? read : what == 1 ? fitted : read - fitted);
                }
            }
        }
    return samples;
}

} // namespace

std::optional<FoundByRun> identify_fit_of(const StudyRun& run, const std::vector<KeptRecord>& records,
                                          const std::function<bool()>& interrupted) {
    check_units(run, records);
    const FitTask task = task_of(run, records);
    FitSettings settings;
    settings.loss = run.identify.loss;
    settings.piece = run.identify.piece;
    settings.interrupted = interrupted;
    settings.progress = [&](const FitProgress&) { return !(interrupted && interrupted()); };
    const Fit fit = fit_model(System(run.model), task, settings);
    if (fit.ending == FitEnding::interrupted)
        return std::nullopt;
    FoundByRun found;
    found.estimates = estimates_of(fit);
    if (fit.records.size() == task.records.size() && !fit.records.empty() && !fit.records.front().fitted.empty())
        found.point.result.samples = residuals_of(fit, task);
    else
        found.point.result.samples.width = 2 + task.outputs.size();
    if (fit.ending != FitEnding::converged)
        found.problem = fmt::format("{}{}{}", name_of(fit.ending), fit.detail.empty() ? "" : ": ", fit.detail);
    for (const FreeCombination& free : fit.free)
        found.problem += fmt::format("; readings do not tell {}", free.text);
    return found;
}

} // namespace graze
