#include "study/identify_run.hpp"

#include "graze/base/name_list.hpp"
#include "graze/base/with_place.hpp"
#include "graze/study/identify_records.hpp"
#include "graze/study/stored_study.hpp"
#include "study/estimate_kind.hpp"
#include "study/identify_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// The estimates, under the names of the parameters that they give.
EstimateRecords estimates_of(const Identification& found, const IdentifyRequest& request, const Place& place) {
    EstimateRecords records;
    records.covariance = found.covariance;
    std::vector<std::string> names;
    for (const Identification::Value& value : found.values) {
        names.push_back(value.name);
        records.numbers.push_back({value.name, value.unit, value.estimate, ""});
    }
    for (const auto& [name, parameter] : request.gives) {
        const auto at = std::find(names.begin(), names.end(), name);
        if (at == names.end())
            throw InputError(place, fmt::format("nothing of the name '{}' is found", name),
                             fmt::format("it finds {}", name_list(names, name)));
        records.numbers[static_cast<std::size_t>(at - names.begin())].name = parameter;
    }
    return records;
}

void add_curve(SampleSet& samples, std::size_t sampling, std::size_t record, const Identification::Curve& curve) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
        samples.samplings.push_back(sampling);
        samples.times.push_back(static_cast<double>(samples.times.size()));
        for (const double value : {static_cast<double>(record), curve.x[i], curve.y[i]})
            samples.values.push_back(value);
    }
}

FoundByRun found_from(const Identification& found, const StudyRun& run) {
    FoundByRun result;
    result.estimates = estimates_of(found, run.identify(), run.place);
    convert_to_model(result.estimates, run);
    SampleSet& samples = result.point.result.samples;
    samples.width = 3;
    for (std::size_t r = 0; r < found.shown.size(); ++r) {
        add_curve(samples, 0, r, found.shown[r].measured);
        add_curve(samples, 1, r, found.shown[r].fitted);
        add_curve(samples, 2, r, found.shown[r].left);
    }
    for (const std::string& warning : found.warnings)
        result.problem += (result.problem.empty() ? "" : "; ") + warning;
    return result;
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

SampleSet residuals_of(const FitOfRecords& found) {
    const FitTask& task = found.task;
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
                    const double read = record.readings[o].values[i], fitted = found.fit.records[r].fitted[o][i];
                    samples.values.push_back(what == 0 ? read : what == 1 ? fitted : read - fitted);
                }
            }
        }
    return samples;
}

FoundByRun found_from(const FitOfRecords& found) {
    const Fit& fit = found.fit;
    FoundByRun result;
    result.estimates = estimates_of(fit);
    SampleSet& samples = result.point.result.samples;
    if (fit.records.size() == found.task.records.size() && !fit.records.empty() && !fit.records.front().fitted.empty())
        samples = residuals_of(found);
    else
        samples.width = 2 + found.task.outputs.size();
    if (fit.ending != FitEnding::converged)
        result.problem = fmt::format("{}{}{}", name_of(fit.ending), fit.detail.empty() ? "" : ": ", fit.detail);
    for (const FreeCombination& free : fit.free)
        result.problem += fmt::format("; readings do not tell {}", free.text);
    return result;
}

} // namespace

std::vector<std::string> residual_names(const IdentifyRequest& request) {
    if (const auto shown = estimate_kind(request.what).shown) {
        const auto [x, y] = shown(request);
        return {"record", x, y};
    }
    std::vector<std::string> names{"record", "t"};
    for (const IdentifyRequest::Reading& reading : request.readings)
        names.push_back(reading.channel);
    return names;
}

std::vector<std::string> names_found(const IdentifyRequest& request) {
    std::vector<std::string> names = estimate_kind(request.what).numbers;
    for (const auto& [name, parameter] : request.gives) {
        std::replace(names.begin(), names.end(), name, parameter);
        if (std::find(names.begin(), names.end(), parameter) == names.end())
            names.push_back(parameter);
    }
    for (const IdentifyRequest::Unknown& one : request.unknowns)
        names.push_back(one.name);
    return names;
}

std::vector<KeptRecord> kept_records(const StudyRun& run, const ResultFile& file) {
    std::vector<KeptRecord> records;
    for (const std::string& name : run.identify().records) {
        const auto from = file.find_run(name);
        if (!from)
            throw InputError(run.place, fmt::format("there are no results of a run '{}'", name), "run it first");
        const StudyRun asked = stored_run(*from);
        const std::vector<RecordSampling>& samplings = asked.record().samplings;
        const auto all_rows = std::ranges::find(samplings, RecordSampling::Kind::record, &RecordSampling::kind);
        const std::string kept = all_rows == samplings.end() ? "" : all_rows->name;
        for (std::size_t number = 0; number < from->points; ++number) {
            const auto point = file.point(name, number);
            if (!point)
                throw InputError(run.place, fmt::format("run '{}' lacks record {}", name, number), "run it first");
            KeptRecord& record = records.emplace_back();
            record.name = fmt::format("{} {}", name, point->result.outcome.detail);
            record.name = record.name.substr(0, record.name.rfind(':'));
            record.header.time = {"t", asked.model.time_unit};
            for (std::size_t v = 0; v < from->values.size(); ++v)
                record.header.channels.push_back({from->values[v].name, from->values[v].unit});
            record.samples.clear(from->values.size());
            const SampleSet& samples = point->result.samples;
            for (std::size_t s = 0; s < samples.size(); ++s) {
                if (from->samplings[samples.samplings[s]] != kept)
                    continue;
                record.samples.times.push_back(samples.times[s]);
                for (std::size_t v = 0; v < samples.width; ++v)
                    record.samples.values[v].push_back(samples.values[s * samples.width + v]);
            }
            if (record.samples.rows() == 0)
                throw InputError(run.place, fmt::format("run '{}' keeps no rows of its records", name),
                                 "give it a sampling { record = true }, and a larger `keep`");
            for (std::size_t c = 0; c < from->coordinates.size(); ++c)
                record.known.emplace_back(from->coordinates[c].name, point->coordinates[c]);
        }
    }
    return records;
}

std::optional<FoundByRun> identify(const StudyRun& run, const std::vector<KeptRecord>& records,
                                   const std::vector<EstimateRecords>& found,
                                   const std::function<bool()>& interrupted) {
    if (run.identify().what == IdentifyRequest::What::fit) {
        FitSettings settings;
        settings.interrupted = interrupted;
        settings.progress = [&](const FitProgress&) { return !(interrupted && interrupted()); };
        const FitOfRecords fitted = fit_records(run, records, settings);
        return fitted.fit.ending == FitEnding::interrupted ? std::nullopt : std::optional(found_from(fitted));
    }
    const EachRecord each = [&](const auto& work) {
        for (const KeptRecord& record : records)
            with_place(
                run.place,
                [&] {
                    StoredSamples samples(record.header, record.samples);
                    work(record.name, samples);
                },
                record.name + ": ");
    };
    return found_from(identify_records(run, each, records.size(), found), run);
}

} // namespace graze
