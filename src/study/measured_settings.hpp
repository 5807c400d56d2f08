#pragma once

#include "graze/model/model_file.hpp"
#include "graze/study/study.hpp"
#include "study/settings_fields.hpp"

namespace graze {

// What runs of records, and of what is found from them, ask for: described to what writes settings and to what reads
// them. Of the first, requests are constant.

template <class Fields, class One>
void describe_record_sampling(Fields& fields, One& sampling) {
    fields.field("name", sampling.name);
    fields.number("kind", sampling.kind, static_cast<std::size_t>(RecordSampling::Kind::impacts) + 1);
    fields.field("phase", sampling.phase);
    fields.field("negated", sampling.negated);
    fields.field("channel", sampling.channel);
    fields.field("displacement", sampling.displacement);
    fields.field("window", sampling.window);
    fields.field("transition", sampling.transition);
    fields.field("least_jump", sampling.least_jump);
}

template <class Fields, class Processing>
void describe_processing(Fields& fields, Processing& processing) {
    fields.field("columns", processing.layout.columns);
    fields.field("group", processing.layout.group);
    const auto line = [&](const char* name, auto& number) {
        if (fields.has(name, number > 0))
            fields.field(name, number);
    };
    line("skipped_lines", processing.layout.skip);
    line("names_line", processing.layout.names_line);
    line("units_line", processing.layout.units_line);
    fields.list("scales", processing.scales, [](auto& one, auto& scale) {
        one.field("channel", scale.channel);
        one.field("factor", scale.factor);
        one.field("offset", scale.offset);
        one.optional("unit", scale.unit);
    });
    fields.field("begin", processing.begin);
    fields.field("end", processing.end);
    fields.field("pass", processing.pass);
    fields.field("stop", processing.stop);
    fields.field("every", processing.every);
    fields.field("derivative", processing.derivative);
    fields.field("half_width", processing.half_width);
}

template <class Fields, class Bench>
void describe_bench(Fields& fields, Bench& bench) {
    if constexpr (Fields::reading) {
        std::string text;
        fields.field("model", text);
        bench.model = parse_model(text, "model of a bench");
    } else {
        fields.field("model", write_model(bench.model));
    }
    fields.field("parameter", bench.parameter);
    fields.field("levels", bench.levels);
    fields.field("directions", bench.directions);
    fields.field("repeats", bench.repeats);
    fields.field("carry", bench.carry);
    fields.field("settle", bench.settle);
    fields.field("time", bench.time);
    fields.field("rate", bench.rate);
    fields.field("time_unit", bench.time_unit);
    fields.list("channels", bench.channels, [&](auto& one, auto& channel) {
        one.field("name", channel.value.name);
        one.field("unit", channel.value.unit);
        if constexpr (Fields::reading) {
            std::string text;
            one.field("value", text);
            const std::string name = channel.value.name, unit = channel.value.unit;
            channel.value = named_value(bench.model, text, Place{"channel of a bench", 0, 0});
            channel.value.name = name;
            channel.value.unit = unit;
        } else {
            one.field("value", to_string(channel.value.value));
        }
        one.field("noise", channel.noise);
        one.field("offset", channel.offset);
        one.field("drift", channel.drift);
        one.field("range", channel.range);
    });
    fields.field("bits", bench.bits);
    fields.field("anti_alias", bench.anti_alias);
    fields.field("seed", bench.seed);
}

template <class Fields, class Request>
void describe_record(Fields& fields, Request& request) {
    fields.list("inputs", request.inputs, [](auto& one, auto& input) {
        one.field("name", input.name);
        one.field("bytes", input.bytes);
        one.field("hash", input.hash);
        one.field("direction", input.direction);
    });
    if (fields.has("bench", request.bench.has_value())) {
        if constexpr (Fields::reading)
            request.bench.emplace();
        fields.object("bench", [&](auto& one) { describe_bench(one, *request.bench); });
    }
    fields.field("directions", request.directions);
    fields.object("processing", [&](auto& one) { describe_processing(one, request.processing); });
    fields.list("channels", request.channels, [](auto& one, auto& kept) {
        one.field("name", kept.name);
        one.field("channel", kept.channel);
    });
    fields.field("reference", request.reference);
    fields.field("level", request.level);
    fields.field("hysteresis", request.hysteresis);
    fields.field("coordinate", request.coordinate);
    fields.list("samplings", request.samplings,
                [](auto& one, auto& sampling) { describe_record_sampling(one, sampling); });
    fields.field("keep", request.keep);
}

template <class Fields, class Request>
void describe_fit(Fields& fields, Request& request) {
    fields.list("unknowns", request.unknowns, [](auto& one, auto& unknown) {
        one.field("name", unknown.name);
        one.field("guess", unknown.guess);
        one.field("least", unknown.least);
        one.field("greatest", unknown.greatest);
    });
    fields.list("readings", request.readings, [](auto& one, auto& reading) {
        one.field("channel", reading.channel);
        one.field("value", reading.value);
        one.field("gain_unknown", reading.gain_unknown);
        one.field("offset_unknown", reading.offset_unknown);
        one.field("gain", reading.gain);
        one.field("offset", reading.offset);
        one.field("noise", reading.noise);
    });
    fields.field("known", request.known);
    fields.field("all_known", request.all_known);
    fields.number("loss", request.loss, 3);
    fields.field("piece", request.piece);
}

template <class Fields, class Request>
void describe_identify(Fields& fields, Request& request) {
    fields.number("what", request.what, static_cast<std::size_t>(IdentifyRequest::What::fit) + 1);
    fields.field("records", request.records);
    fields.list("gives", request.gives, [](auto& one, auto& gives) {
        one.field("name", gives.first);
        one.field("parameter", gives.second);
    });
    for (auto [name, text] : {std::pair{"channel", &request.channel}, std::pair{"displacement", &request.displacement},
                              std::pair{"voltage", &request.voltage}, std::pair{"current", &request.current},
                              std::pair{"gap", &request.gap}, std::pair{"stiffness", &request.stiffness},
                              std::pair{"beta1", &request.beta1}, std::pair{"beta2", &request.beta2},
                              std::pair{"clamped", &request.clamped}, std::pair{"frequency", &request.frequency}})
        fields.field(name, *text);
    fields.field("peaks", request.peaks);
    fields.field("window", request.window);
    fields.field("transition", request.transition);
    fields.field("least_jump", request.least_jump);
    fields.field("displacement_noise", request.displacement_noise);
    fields.field("current_noise", request.current_noise);
    if (fields.has("fit", request.what == IdentifyRequest::What::fit))
        fields.object("fit", [&](auto& one) { describe_fit(one, request); });
}

} // namespace graze
