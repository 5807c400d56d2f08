#include "study/identify_run.hpp"

#include "graze/base/name_list.hpp"
#include "graze/study/identify_records.hpp"
#include "graze/study/stored_study.hpp"
#include "study/identify_fit.hpp"
#include "study/identify_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

using What = IdentifyRequest::What;

/// Under the names of the parameters that they are.
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
    result.estimates = estimates_of(found, run.identify, run.place);
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

} // namespace

std::vector<std::string> residual_names(const IdentifyRequest& request) {
    switch (request.what) {
    case What::decrement:
        return {"record", "t", "peak"};
    case What::restitution:
        return {"record", "before", "after"};
    case What::coupling:
        return {"record", request.current, request.displacement.empty() ? "q" : request.displacement};
    case What::impedance:
        return {"record", "t", request.current};
    case What::fit:
        break;
    }
    std::vector<std::string> names{"record", "t"};
    for (const IdentifyRequest::Reading& reading : request.readings)
        names.push_back(reading.channel);
    return names;
}

std::vector<std::string> names_of_estimates(What what) {
    switch (what) {
    case What::decrement:
        return {"natural_frequency", "damping_ratio", "natural_frequency_of_pairs", "damping_ratio_of_pairs",
                "rest_position"};
    case What::restitution:
        return {"restitution"};
    case What::coupling:
        return {"beta1", "beta2", "correlation", "beta1_of_regression", "beta2_of_regression"};
    case What::impedance:
        return {"resistance", "inductance", "leakage_inductance", "frequency"};
    case What::fit:
        break;
    }
    return {};
}

std::vector<std::string> names_found(const IdentifyRequest& request) {
    std::vector<std::string> names = names_of_estimates(request.what);
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
    for (const std::string& name : run.identify.records) {
        const auto from = file.find_run(name);
        if (!from)
            throw InputError(run.place, fmt::format("there are no results of a run '{}'", name), "run it first");
        const StudyRun asked = stored_run(*from);
        std::size_t sampling = 0;
        while (sampling < asked.record.samplings.size() &&
               asked.record.samplings[sampling].kind != RecordSampling::Kind::record)
            ++sampling;
        const std::vector<std::string> names = from->samplings;
        const std::string kept =
            sampling < asked.record.samplings.size() ? asked.record.samplings[sampling].name : std::string();
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
                if (names[samples.samplings[s]] != kept)
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
    if (run.identify.what == What::fit)
        return identify_fit_of(run, records, interrupted);
    const EachRecord each = [&](const auto& work) {
        for (const KeptRecord& record : records)
            try {
                StoredSamples samples(record.header, record.samples);
                work(record.name, samples);
            } catch (const InputError& error) {
                if (!error.place().file.empty())
                    throw;
                throw InputError(run.place, fmt::format("{}: {}", record.name, error.problem()), error.remedy());
            }
    };
    return found_from(identify_records(run, each, records.size(), found), run);
}

} // namespace graze
