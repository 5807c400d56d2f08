#include "program/identify_request.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/named_value.hpp"
#include "program/record_request.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

namespace graze {

namespace {

constexpr std::size_t most_samples = 1'000'000;

/// NAME or NAME=REST, split at the sign.
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

/// Reads NAME[=GUESS][:LEAST:GREATEST].
IdentifyRequest::Unknown unknown_of(const Model& model, const std::string& item) {
    std::vector<std::string> parts;
    for (std::size_t start = 0; start <= item.size();) {
        const std::size_t end = std::min(item.find(':', start), item.size());
        parts.push_back(item.substr(start, end - start));
        start = end + 1;
    }
    const Place place{"--free " + item, 0, 0};
    if (parts.size() != 1 && parts.size() != 3)
        throw InputError(place, "it has one bound", "write NAME=GUESS:LEAST:GREATEST, or no bounds");
    const Named named = split(parts[0]);
    if (named.rest == "" || std::any_of(parts.begin() + 1, parts.end(), [](const auto& part) { return part.empty(); }))
        throw InputError(place, "a number is missing", "write NAME=GUESS:LEAST:GREATEST, or no bounds");
    try {
        model.independent_parameter(named.name);
    } catch (const InputError& error) {
        throw InputError({"--free", 0, 0}, error.problem(), error.remedy());
    }
    parts.resize(3);
    return {named.name, named.rest.value_or(""), parts[1], parts[2], place};
}

/// Makes a FitRequest from the command line, option by option.
class FitRequestReader {
public:
    FitRequestReader(const IdentifyArguments& arguments, const Console& console)
        : arguments_(&arguments), console_(&console) {}

    FitRequest make() {
        const std::vector<std::string>& files = arguments_->reading.files;
        if (files.size() < 2)
            throw InputError("a fit needs a model and records", "write graze identify fit MODEL RECORD");
        request_.run = identify_request(*arguments_);
        Model& model = request_.run.model;
        model = load_model(files.front());
        set_parameters(model, arguments_->set);
        read_start();
        if (!arguments_->mode.empty())
            model.set_initial_mode(arguments_->mode);
        for (const std::string& item : split_list(arguments_->free))
            asked().unknowns.push_back(unknown_of(model, item));
        read_meanings();
        for (auto file = files.begin() + 1; file != files.end(); ++file)
            with_place({*file, 0, 0}, [&] { read_record(*file); });
        read_own();
        take_channel_options(arguments_->gains, "--gain", [](Reading& reading, std::optional<double> value) {
            reading.gain_unknown = true;
            reading.gain = value.value_or(reading.gain);
        });
        take_channel_options(arguments_->offsets, "--offset", [](Reading& reading, std::optional<double> value) {
            reading.offset_unknown = true;
            reading.offset = value.value_or(reading.offset);
        });
        take_channel_options(arguments_->noises, "--deviation", [](Reading& reading, std::optional<double> value) {
            if (!value || !(*value > 0))
                throw InputError({"--deviation", 0, 0}, "noise has no positive deviation", "write CHANNEL=VALUE");
            reading.noise = *value;
        });
        const std::vector<std::string>& losses = names_of_losses();
        asked().loss = static_cast<FitLoss>(std::find(losses.begin(), losses.end(), arguments_->loss) - losses.begin());
        if (!arguments_->piece.empty())
            asked().piece = positive_value_of(model, arguments_->piece, "--piece");
        return std::move(request_);
    }

private:
    using Reading = IdentifyRequest::Reading;

    const Model& model() const { return request_.run.model; }
    IdentifyRequest& asked() { return request_.run.identify(); }

    /// @throws InputError, with the nearest name of a state, unless it is a state
    void require_state(const std::string& name, const char* option) const {
        if (!model().find_state(name))
            throw InputError({option, 0, 0}, fmt::format("'{}' is not a state", name),
                             name_advice(name, names_of(model().states), ""));
    }

    void read_start() {
        for (const std::string& item : split_list(arguments_->start)) {
            const Named named = split(item);
            if (!named.rest)
                throw InputError({"--start " + item, 0, 0}, "it has no value", "write STATE=VALUE");
            require_state(named.name, "--start");
            request_.run.model.set_initial(named.name, number_in(model(), *named.rest, "--start", item));
        }
        const std::vector<std::string> known = split_list(arguments_->known);
        asked().all_known = known.size() == 1 && known[0] == "all";
        if (asked().all_known)
            return;
        for (const std::string& name : known)
            require_state(name, "--known");
        asked().known = known;
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

    /// True when a channel is used: it has a --reading, or the name of a state or quantity. It becomes a reading then.
    bool is_read(const std::string& channel) {
        std::vector<Reading>& readings = asked().readings;
        if (std::any_of(readings.begin(), readings.end(), [&](const Reading& one) { return one.channel == channel; }))
            return true;
        const auto said = meanings_.find(channel);
        const bool is_said = said != meanings_.end();
        if (!is_said && !model().find_state(channel) && !model().find_quantity(channel))
            return false;
        Reading& reading = readings.emplace_back();
        reading.channel = channel;
        reading.value = is_said ? said->second : channel;
        reading.may_lack = true;
        reading.place = {is_said ? "--reading " + channel : channel, 0, 0};
        return true;
    }

    void read_record(const std::string& file) {
        ProcessedRecord record(file, record_processing(arguments_->reading, *console_));
        const RecordHeader header = record.header();
        for (const auto& [name, text] : meanings_)
            header.channel(name, "--reading");
        std::vector<std::size_t> columns;
        for (std::size_t c = 0; c < header.channels.size(); ++c)
            if (is_read(header.channels[c].name))
                columns.push_back(c);
        if (columns.empty())
            throw InputError(
                fmt::format("no channel has the name of a state or quantity of '{}'", model().name),
                fmt::format("say what is measured by --reading {}=EXPRESSION", header.channels.front().name));
        Samples samples = read_all(record.source(), most_samples);
        KeptRecord& kept = request_.records.emplace_back();
        kept.name = file;
        kept.header.time = header.time;
        kept.samples.times = std::move(samples.times);
        for (const std::size_t c : columns) {
            kept.header.channels.push_back(header.channels[c]);
            kept.samples.values.push_back(std::move(samples.values[c]));
        }
    }

    void read_own() {
        for (const std::string& item : arguments_->own) {
            const std::size_t colon = item.rfind(':', item.find('='));
            const Named named = split(colon == std::string::npos ? item : item.substr(colon + 1));
            const Place place{"--with " + item, 0, 0};
            if (colon == std::string::npos || !named.rest)
                throw InputError(place, "it sets nothing", "write FILE:NAME=VALUE");
            const auto record = std::find_if(request_.records.begin(), request_.records.end(),
                                             [&](const KeptRecord& one) { return one.name == item.substr(0, colon); });
            if (record == request_.records.end())
                throw InputError(place, fmt::format("'{}' is none of the records", item.substr(0, colon)),
                                 "name a record as it is named before the options");
            model().independent_parameter(named.name); // throws, with the names of parameters, for others
            record->known.emplace_back(named.name, number_in(model(), *named.rest, "--with", item));
        }
    }

    void take_channel_options(const std::vector<std::string>& items, const char* option,
                              const std::function<void(Reading&, std::optional<double>)>& take) {
        std::vector<Reading>& readings = asked().readings;
        for (const std::string& item : split_list(items)) {
            const Named named = split(item);
            const auto found = std::find_if(readings.begin(), readings.end(),
                                            [&](const Reading& reading) { return reading.channel == named.name; });
            if (found == readings.end()) {
                std::vector<std::string> names;
                for (const Reading& reading : readings)
                    names.push_back(reading.channel);
                throw InputError({option, 0, 0}, fmt::format("'{}' is no channel that is used", named.name),
                                 name_advice(named.name, names, ""));
            }
            take(*found, named.rest ? std::optional(number_in(model(), *named.rest, option, item)) : std::nullopt);
        }
    }

    const IdentifyArguments* arguments_;
    const Console* console_;
    FitRequest request_;
    std::map<std::string, std::string> meanings_;
};

} // namespace

FitRequest fit_request(const IdentifyArguments& arguments, const Console& console) {
    return FitRequestReader(arguments, console).make();
}

} // namespace graze
