#include "program/fit_request.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/physical_unit.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/named_value.hpp"
#include "program/record_stages.hpp"
#include "program/values.hpp"
#include "program/with_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

namespace graze {

namespace {

constexpr std::size_t most_samples = 1'000'000;

/// NAME, or NAME=REST
struct Named {
    std::string name;
    std::optional<std::string> rest;
};
Named split(const std::string& item) {
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos)
        return {item, std::nullopt};
    return {item.substr(0, equals), item.substr(equals + 1)};
}

double number_in(const Model& model, const std::string& text, const char* option, const std::string& item) {
    return value_of_text(model, text, {fmt::format("{} {}", option, item), 0, 0});
}

/// NAME[=GUESS][:LEAST:GREATEST]
UnknownParameter unknown_of(const Model& model, const std::string& item) {
    std::vector<std::string> parts;
    for (std::size_t start = 0; start <= item.size();) {
        const std::size_t end = std::min(item.find(':', start), item.size());
        parts.push_back(item.substr(start, end - start));
        start = end + 1;
    }
    if (parts.size() != 1 && parts.size() != 3)
        throw InputError({"--free " + item, 0, 0}, "it has one bound", "write NAME=GUESS:LEAST:GREATEST, or no bounds");
    const Named named = split(parts[0]);
    UnknownParameter unknown;
    try {
        unknown.parameter = model.independent_parameter(named.name);
    } catch (const InputError& error) {
        throw InputError({"--free", 0, 0}, error.problem(), error.remedy());
    }
    unknown.guess = named.rest ? number_in(model, *named.rest, "--free", item)
                               : model.parameter_values()[unknown.parameter.place()];
    if (parts.size() == 3) {
        unknown.least = number_in(model, parts[1], "--free", item);
        unknown.greatest = number_in(model, parts[2], "--free", item);
    }
    return unknown;
}

class Requester {
public:
    Requester(const IdentifyArguments& arguments, const Console& console)
        : arguments_(&arguments), console_(&console) {}

    FitRequest make() {
        const std::vector<std::string>& files = arguments_->reading.files;
        if (files.size() < 2)
            throw InputError("a fit needs a model and records", "write graze identify fit MODEL RECORD");
        request_.model = load_model(files.front());
        request_.files.assign(files.begin() + 1, files.end());
        set_parameters(request_.model, arguments_->set);
        read_start();
        if (!arguments_->mode.empty())
            request_.model.set_initial_mode(arguments_->mode);
        for (const std::string& item : split_list(arguments_->free))
            request_.task.parameters.push_back(unknown_of(request_.model, item));
        read_meanings();
        for (const std::string& file : request_.files)
            with_file(file, [&] { read_record(file); });
        read_own();
        take_channel_options(arguments_->gains, "--gain", [](MeasuredOutput& output, std::optional<double> value) {
            output.gain_unknown = true;
            output.gain = value.value_or(output.gain);
        });
        take_channel_options(arguments_->offsets, "--offset", [](MeasuredOutput& output, std::optional<double> value) {
            output.offset_unknown = true;
            output.offset = value.value_or(output.offset);
        });
        take_channel_options(
            arguments_->noises, "--deviation", [](MeasuredOutput& output, std::optional<double> value) {
                if (!value || !(*value > 0))
                    throw InputError({"--deviation", 0, 0}, "noise has no positive deviation", "write CHANNEL=VALUE");
                output.noise = *value;
            });
        check_units();
        request_.settings.loss = arguments_->loss == "huber"    ? FitLoss::huber
                                 : arguments_->loss == "cauchy" ? FitLoss::cauchy
                                                                : FitLoss::squares;
        if (!arguments_->piece.empty())
            request_.settings.piece = positive_value_of(request_.model, arguments_->piece, "--piece");
        return std::move(request_);
    }

private:
    std::size_t state(const std::string& name, const char* option) const {
        if (const auto index = request_.model.find_state(name))
            return *index;
        std::vector<std::string> names;
        for (const State& one : request_.model.states)
            names.push_back(one.name);
        throw InputError({option, 0, 0}, fmt::format("'{}' is not a state", name), name_advice(name, names, ""));
    }

    void read_start() {
        for (const std::string& item : split_list(arguments_->start)) {
            const Named named = split(item);
            if (!named.rest)
                throw InputError({"--start " + item, 0, 0}, "it has no value", "write STATE=VALUE");
            state(named.name, "--start"); // says which there are
            request_.model.set_initial(named.name, number_in(request_.model, *named.rest, "--start", item));
        }
        const std::vector<std::string> known = split_list(arguments_->known);
        const bool all = known.size() == 1 && known[0] == "all";
        std::vector<std::size_t> fixed;
        for (const std::string& name : known)
            if (!all)
                fixed.push_back(state(name, "--known"));
        for (std::size_t i = 0; i < request_.model.states.size(); ++i)
            if (!all && std::find(fixed.begin(), fixed.end(), i) == fixed.end())
                unknown_.push_back(i);
    }

    void read_meanings() {
        for (const std::string& item : arguments_->meanings) {
            const Named named = split(item);
            if (!named.rest || named.name.empty())
                throw InputError({"--reading " + item, 0, 0}, "it says of no channel what it measures",
                                 "write CHANNEL=EXPRESSION");
            meanings_[named.name] = *named.rest;
        }
    }

    /// What the channel measures: the output's number, or none.
    std::optional<std::size_t> output_of(const Channel& channel) {
        for (std::size_t o = 0; o < request_.task.outputs.size(); ++o)
            if (request_.task.outputs[o].name == channel.name)
                return o;
        const auto said = meanings_.find(channel.name);
        const Model& model = request_.model;
        if (said == meanings_.end() && !model.find_state(channel.name) && !model.find_quantity(channel.name))
            return std::nullopt;
        const std::string text = said == meanings_.end() ? channel.name : said->second;
        const NamedValue value =
            named_value(model, text, {said == meanings_.end() ? channel.name : "--reading " + channel.name, 0, 0});
        MeasuredOutput output;
        output.name = channel.name;
        output.value = value.value;
        request_.task.outputs.push_back(output);
        request_.channels.push_back(channel);
        units_.push_back(value.unit);
        return request_.task.outputs.size() - 1;
    }

    void read_record(const std::string& file) {
        RecordStages stages(file, arguments_->reading, *console_);
        const RecordHeader header = stages.header();
        for (const auto& [name, text] : meanings_)
            header.channel(name, "--reading");
        FitRecord record;
        std::vector<std::size_t> columns;
        for (std::size_t c = 0; c < header.channels.size(); ++c)
            if (const std::optional<std::size_t> output = output_of(header.channels[c])) {
                if (request_.channels[*output].unit != header.channels[c].unit)
                    throw InputError(fmt::format("channel '{}' is in {}, and that of another record in {}",
                                                 header.channels[c].name, unit_text(header.channels[c].unit),
                                                 unit_text(request_.channels[*output].unit)),
                                     "give records of the same units, by --scale if need be");
                FitRecord::Readings readings;
                readings.output = *output;
                record.readings.push_back(readings);
                columns.push_back(c);
            }
        if (columns.empty()) {
            std::vector<std::string> names;
            for (const Channel& channel : header.channels)
                names.push_back(channel.name);
            throw InputError(fmt::format("no channel has the name of a state or quantity of '{}'", request_.model.name),
                             fmt::format("say what is measured by --reading {}=EXPRESSION", names.front()));
        }
        const std::string& unit = request_.model.time_unit;
        if (!unit.empty() && !header.time.unit.empty() && unit_symbol(unit) != header.time.unit)
            throw InputError(fmt::format("its time is in {}, and that of the model in {}", header.time.unit, unit),
                             "convert the times of the record");
        Samples samples = read_all(stages.source(), most_samples);
        if (samples.rows() < 2)
            throw InputError("it has fewer than two rows", "give a longer record");
        record.times = std::move(samples.times);
        for (std::size_t k = 0; k < columns.size(); ++k)
            record.readings[k].values = std::move(samples.values[columns[k]]);
        record.mode = request_.model.initial_mode;
        record.unknown_states = unknown_;
        if (request_.task.records.empty())
            request_.time = header.time;
        request_.task.records.push_back(std::move(record));
    }

    void read_own() {
        for (const std::string& item : arguments_->own) {
            const std::size_t colon = item.rfind(':', item.find('='));
            const Named named = split(colon == std::string::npos ? item : item.substr(colon + 1));
            const Place place{"--with " + item, 0, 0};
            if (colon == std::string::npos || !named.rest)
                throw InputError(place, "it sets nothing", "write FILE:NAME=VALUE");
            const auto file = std::find(request_.files.begin(), request_.files.end(), item.substr(0, colon));
            if (file == request_.files.end())
                throw InputError(place, fmt::format("'{}' is none of the records", item.substr(0, colon)),
                                 "name a record as it is named before the options");
            const ParameterId parameter = request_.model.independent_parameter(named.name);
            const auto number = static_cast<std::size_t>(file - request_.files.begin());
            request_.task.records[number].known.emplace_back(parameter,
                                                             number_in(request_.model, *named.rest, "--with", item));
        }
    }

    void take_channel_options(const std::vector<std::string>& items, const char* option,
                              const std::function<void(MeasuredOutput&, std::optional<double>)>& take) {
        for (const std::string& item : split_list(items)) {
            const Named named = split(item);
            const auto found = std::find_if(request_.task.outputs.begin(), request_.task.outputs.end(),
                                            [&](const MeasuredOutput& output) { return output.name == named.name; });
            if (found == request_.task.outputs.end()) {
                std::vector<std::string> names;
                for (const MeasuredOutput& output : request_.task.outputs)
                    names.push_back(output.name);
                throw InputError({option, 0, 0}, fmt::format("'{}' is no channel that is used", named.name),
                                 name_advice(named.name, names, ""));
            }
            take(*found,
                 named.rest ? std::optional(number_in(request_.model, *named.rest, option, item)) : std::nullopt);
        }
    }

    /// A gain that is found, or given, converts.
    void check_units() const {
        for (std::size_t o = 0; o < units_.size(); ++o) {
            const std::string &read = request_.channels[o].unit, &meant = units_[o];
            if (!request_.task.outputs[o].gain_unknown && !read.empty() && !meant.empty() &&
                unit_symbol(read) != unit_symbol(meant))
                throw InputError(fmt::format("channel '{}' is in {}, and what it measures in {}",
                                             request_.channels[o].name, read, meant),
                                 fmt::format("convert it by --scale {}=FACTOR:{}", request_.channels[o].name, meant));
        }
    }
    static std::string unit_text(const std::string& unit) { return unit.empty() ? "no unit" : unit; }

    const IdentifyArguments* arguments_;
    const Console* console_;
    FitRequest request_;
    std::vector<std::size_t> unknown_;
    std::map<std::string, std::string> meanings_;
    std::vector<std::string> units_;
};

} // namespace

FitRequest fit_request(const IdentifyArguments& arguments, const Console& console) {
    return Requester(arguments, console).make();
}

} // namespace graze
