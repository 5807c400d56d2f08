#include "graze/study/fit_records.hpp"

#include "graze/base/physical_unit.hpp"
#include "graze/base/require.hpp"
#include "graze/base/with_place.hpp"
#include "graze/model/named_value.hpp"
#include "study/identify_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace graze {

namespace {

using Reading = IdentifyRequest::Reading;

const Place& place_of(const StudyRun& run, const Place& own) {
    return own.file.empty() ? run.place : own;
}

UnknownParameter unknown_of(const StudyRun& run, const IdentifyRequest::Unknown& one) {
    UnknownParameter unknown;
    unknown.parameter = run.model.independent_parameter(one.name);
    unknown.guess = run.model.parameter_values()[unknown.parameter.place()];
    for (const auto& [text, value] : {std::pair(&one.guess, &unknown.guess), std::pair(&one.least, &unknown.least),
                                      std::pair(&one.greatest, &unknown.greatest)})
        if (!text->empty())
            *value = value_of_text(run.model, *text, place_of(run, one.place));
    return unknown;
}

/// The channel of a reading; none where the record lacks it and may do so.
std::optional<std::size_t> column_of(const Reading& reading, const RecordHeader& header) {
    const bool has = std::ranges::find(header.channels, reading.channel, &Channel::name) != header.channels.end();
    return has || !reading.may_lack ? std::optional(header.channel(reading.channel, "readings")) : std::nullopt;
}

/// Builds the task of a fit, record by record.
class FitMaker {
public:
    explicit FitMaker(const StudyRun& run) : run_(&run) {
        const IdentifyRequest& request = run.identify();
        for (const IdentifyRequest::Unknown& one : request.unknowns)
            made_.task.parameters.push_back(unknown_of(run, one));
        for (const Reading& one : request.readings) {
            const NamedValue meant = named_value(run.model, one.value, place_of(run, one.place));
            MeasuredOutput output;
            output.name = one.channel;
            output.value = meant.value;
            output.gain = one.gain;
            output.offset = one.offset;
            output.gain_unknown = one.gain_unknown;
            output.offset_unknown = one.offset_unknown;
            output.noise = one.noise;
            made_.task.outputs.push_back(std::move(output));
            units_.push_back(meant.unit);
        }
        made_.channels.resize(request.readings.size());
        for (std::size_t s = 0; s < run.model.states.size() && !request.all_known; ++s)
            if (std::find(request.known.begin(), request.known.end(), run.model.states[s].name) == request.known.end())
                unknown_states_.push_back(s);
    }

    void add(const KeptRecord& kept) {
        check_record_time(*run_, kept.header);
        if (kept.samples.rows() < 2)
            throw InputError("it has fewer than two rows", "give a longer record");
        FitRecord record;
        record.times = kept.samples.times;
        record.mode = run_->model.initial_mode;
        record.unknown_states = unknown_states_;
        for (std::size_t o = 0; o < units_.size(); ++o)
            if (const auto column = column_of(run_->identify().readings[o], kept.header)) {
                check_unit(o, kept.header.channels[*column]);
                require_index(*column, kept.samples.values.size(), "channel");
                record.readings.push_back({o, kept.samples.values[*column]});
            }
        for (const auto& [name, value] : kept.known)
            if (const auto parameter = run_->model.find_independent_parameter(name))
                record.known.emplace_back(*parameter, value);
        made_.task.records.push_back(std::move(record));
    }

    FitOfRecords made() { return std::move(made_); }

private:
    /// Refuses a channel whose unit differs from that of the value it measures. A gain converts units, whether it is
    /// found or given.
    void check_unit(std::size_t output, const Channel& channel) {
        const Reading& reading = run_->identify().readings[output];
        Channel& known = made_.channels[output];
        const auto text = [](const std::string& unit) { return unit.empty() ? "no unit" : unit; };
        if (!known.name.empty() && known.unit != channel.unit)
            throw InputError(fmt::format("channel '{}' is in {}, and that of another record in {}", channel.name,
                                         text(channel.unit), text(known.unit)),
                             scale_remedy(channel, known.unit));
        known = channel;
        const std::string& meant = units_[output];
        if (!reading.gain_unknown && reading.gain == 1 && !channel.unit.empty() && !meant.empty() &&
            unit_symbol(channel.unit) != unit_symbol(meant))
            throw InputError(
                fmt::format("channel '{}' is in {}, and what it measures in {}", channel.name, channel.unit, meant),
                scale_remedy(channel, meant));
    }

    const StudyRun* run_;
    FitOfRecords made_;
    std::vector<std::string> units_; ///< of the values that are measured
    std::vector<std::size_t> unknown_states_;
};

} // namespace

FitOfRecords fit_records(const StudyRun& run, const std::vector<KeptRecord>& records, FitSettings settings) {
    FitMaker maker(run);
    for (const KeptRecord& record : records)
        with_place(
            run.place, [&] { maker.add(record); }, record.name + ": ");
    FitOfRecords made = maker.made();
    settings.loss = run.identify().loss;
    settings.piece = run.identify().piece;
    settings.simulation = run.identify().simulation;
    made.fit = fit_model(System(run.model), made.task, settings);
    for (FittedNumber& number : made.fit.numbers)
        if (number.kind == FittedNumber::Kind::offset)
            number.unit = made.channels[number.index].unit;
    return made;
}

} // namespace graze
