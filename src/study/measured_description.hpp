#pragma once

#include "graze/model/model_file.hpp"
#include "graze/study/study.hpp"
#include "study/run_forms.hpp"
#include "study/settings_fields.hpp"

#include <algorithm>
#include <initializer_list>

namespace graze {

// The keys of runs of kind record and identify; run_description.hpp has those of the other kinds.

template <class Fields, class One>
void describe_record_sampling(Fields& fields, One& sampling) {
    fields.field("name", sampling.name);
    fields.number("kind", sampling.kind, static_cast<std::size_t>(RecordSampling::Kind::impacts) + 1);
    describe_fields(fields, "phase", sampling.phase, "negated", sampling.negated, "channel", sampling.channel,
                    "displacement", sampling.displacement, "window", sampling.impacts.window, "transition",
                    sampling.impacts.transition, "least_jump", sampling.impacts.least_jump);
}

template <class Fields, class Processing>
void describe_processing(Fields& fields, Processing& processing) {
    fields.line({"columns", "names of the columns of a text that does not give them"}, processing.layout.columns);
    fields.line({"group", "the group of HDF5"}, processing.layout.group);
    fields.table({"lines", "for an instrument's text whose layout is recognised wrongly: the number of lines to skip, "
                           "and the numbers (from 1) of the lines with names and units"},
                 "{ skip = 3, names = 4, units = 5 }", [&layout = processing.layout](auto& one) {
                     const auto line = [&](const char* name, const char* stored, auto& number, std::size_t least) {
                         if (one.has(stored, number > 0))
                             one.count(key_in_table(name, stored), number, {least, 1'000'000});
                     };
                     line("skip", "skipped_lines", layout.skip, 0);
                     line("names", "names_line", layout.names_line, 1);
                     line("units", "units_line", layout.units_line, 1);
                 });
    fields.form({"scale", "factors, offsets and units of channels"}, "{ q = 2.011, I = { factor, offset, unit } }",
                &read_scales);
    fields.list("scales", processing.scales, [](auto& one, auto& scale) {
        describe_fields(one, "channel", scale.channel, "factor", scale.factor, "offset", scale.offset);
        one.optional("unit", scale.unit);
    });
    fields.form({"part", "part of the record, between two times"}, "[t0, t1]", &read_part);
    describe_fields(fields, "begin", processing.begin, "end", processing.end);
    fields.form(
        {"filter",
         "low-pass filter: the frequency up to which it passes everything, and that from which it passes nothing"},
        "{ pass, stop }", &read_filter);
    describe_fields(fields, "pass", processing.pass, "stop", processing.stop);
    fields.count({"every", "decimation: every N-th sample is kept"}, processing.every,
                 {1, RecordProcessing::most_every});
    fields.form({"derivative", "adds a channel: the rate of change of this one"}, "\"q\" or { channel, half_width }",
                &read_derivative);
    describe_fields(fields, "derivative", processing.derivative, "half_width", processing.half_width);
}

/// A virtual bench: the keys of the table `bench`, and what is stored of it.
template <class Fields, class Bench>
void describe_bench(Fields& fields, Bench& bench) {
    if constexpr (Fields::stored && Fields::reading) {
        std::string text;
        fields.field("model", text);
        bench.model = parse_model(text, "model of a bench");
    } else if constexpr (Fields::stored) {
        fields.field("model", write_equations(bench.model));
    }
    describe_fields(fields, "parameter", bench.parameter, "levels", bench.levels, "directions", bench.directions);
    fields.count(key_in_table("repeats"), bench.repeats, {1, 10'000});
    fields.field("carry", bench.carry);
    fields.number(key_in_table("settle"), bench.settle, any_number);
    fields.number(key_in_table("time"), bench.time, positive_number);
    fields.number(key_in_table("rate"), bench.rate, positive_number);
    fields.number(key_in_table("time_unit"), bench.time_unit, positive_number);
    fields.form(key_in_table("channels"), "", &read_bench_channels);
    fields.list("channels", bench.channels, [&](auto& one, auto& channel) {
        describe_fields(one, "name", channel.value.name, "unit", channel.value.unit);
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
        describe_fields(one, "noise", channel.noise, "offset", channel.offset, "drift", channel.drift, "range",
                        channel.range);
    });
    fields.count(key_in_table("bits"), bench.bits, {1, 32});
    fields.number(key_in_table("anti_alias"), bench.anti_alias, positive_number);
    fields.field("seed", bench.seed);
}

/// Keys of the levels of a virtual bench. They are stored with the bench.
template <class Fields, class Vary>
void describe_levels(Fields& fields, Vary& vary) {
    if constexpr (!Fields::stored) {
        fields.form({"set", "values of parameters of the model on a virtual bench"}, "{ V = 1 }", read_apart);
        fields.form({"from", "its initial states"}, "{ x = 0.1 }", read_apart);
        fields.form({"mode", "its initial mode"}, "\"NAME\"", read_apart);
        fields.form({"vary", "the parameter that a virtual bench varies in steps, with its levels"},
                    "{ V = { from, to, step } }", &read_vary);
        fields.choice({"direction", "how it steps them"}, vary.direction, {"up", "down", "both"});
        fields.truth(
            {"carry", "the motion continues from level to level; `false`: each level begins in the initial state"},
            vary.carry);
        fields.count({"seed", "seed of the noise of a virtual bench"}, vary.seed, any_seed);
    }
}

template <class Fields, class Request>
void describe_record(Fields& fields, Request& request) {
    fields.form({"files", "files relative to the study, in its folder or below it; `*` in the last part stands for all "
                          "files that match, in the order of their names"},
                "\"NAME.csv\", [...] or { up = [...], down = [...] }", read_apart);
    fields.form({"bench", "a virtual bench in place of files: what it measures, how often and how long"},
                "{ channels, rate, time, settle, repeats, bits, anti_alias, time_unit }", read_apart);
    fields.list("inputs", request.inputs, [](auto& one, auto& input) {
        describe_fields(one, "name", input.name, "bytes", input.bytes, "hash", input.hash, "direction",
                        input.direction);
    });
    if constexpr (Fields::stored)
        if (fields.has("bench", request.bench.has_value())) {
            if constexpr (Fields::reading)
                request.bench.emplace();
            fields.object("bench", [&](auto& one) { describe_bench(one, *request.bench); });
        }
    fields.field("directions", request.directions);
    fields.object("processing", [&](auto& one) { describe_processing(one, request.processing); });
    fields.form({"channels",
                 "the channels that values may use, by their own names or under others that expressions accept (all)"},
                "[\"V\"] or { v = \"dq/dt\" }", read_apart);
    fields.list("channels", request.channels,
                [](auto& one, auto& kept) { describe_fields(one, "name", kept.name, "channel", kept.channel); });
    fields.form({"reference", "the channel whose rising crossings begin periods"},
                "\"V\" or { channel, level, hysteresis }", read_apart);
    describe_fields(fields, "reference", request.reference, "level", request.level, "hysteresis", request.hysteresis);
    fields.line({"coordinate", "name of the reference's amplitude, averaged over the record, which is the horizontal "
                               "axis of diagrams (amplitude)"},
                request.coordinate);
    fields.form(
        {"sample", "named samplings (`record`: all rows; with a reference also `section`: its rising crossings)"},
        "{ NAME = { ... } }", read_apart);
    fields.list("samplings", request.samplings,
                [](auto& one, auto& sampling) { describe_record_sampling(one, sampling); });
    fields.count({"keep", "number of rows of a record that are stored. Of a longer record only the sampled values and "
                          "the hash of its file are stored"},
                 request.keep, {0, 10'000'000});
}

/// Makes keys that only some estimates have: in runs of other estimates they are refused.
inline auto keys_of_estimate(IdentifyRequest::What what) {
    return [what](const char* name, const char* meaning, std::initializer_list<IdentifyRequest::What> of) -> Key {
        const bool used = std::find(of.begin(), of.end(), what) != of.end();
        return {name, meaning, true, nullptr,
                used ? "" : "has no effect on a " + kinds_of_estimates()[static_cast<std::size_t>(what)]};
    };
}

template <class Fields, class Request>
void describe_fit(Fields& fields, Request& request) {
    const auto key = keys_of_estimate(request.what);
    const auto of_fits = {IdentifyRequest::What::fit};
    fields.form(key("unknowns", "parameters to be found, by name, or with guesses and bounds", of_fits),
                "[\"c\"] or { c = { guess, bounds } }", &read_unknowns);
    fields.list("unknowns", request.unknowns, [](auto& one, auto& unknown) {
        describe_fields(one, "name", unknown.name, "guess", unknown.guess, "least", unknown.least, "greatest",
                        unknown.greatest);
    });
    fields.form(key("readings",
                    "meaning of the records' values in the model; `true` for a gain or offset that is to be found",
                    of_fits),
                "[\"q\"] or { q = { value, gain, offset, noise } }", &read_readings);
    fields.list("readings", request.readings, [](auto& one, auto& reading) {
        describe_fields(one, "channel", reading.channel, "value", reading.value, "gain_unknown", reading.gain_unknown,
                        "offset_unknown", reading.offset_unknown, "gain", reading.gain, "offset", reading.offset,
                        "noise", reading.noise);
        describe_if_given(one, "may_lack", reading.may_lack);
    });
    fields.form(
        key("known",
            "states whose initial values are those of the model (or `from`); `true`: all states. The others are found",
            of_fits),
        "[\"x\"] or true", &read_known);
    describe_fields(fields, "known", request.known, "all_known", request.all_known);
    fields.choice(key("loss", "loss: the weight of large residuals", of_fits), request.loss, names_of_losses());
    fields.number(key("piece",
                      "length of the pieces that records are cut into, in the model's time: shorter ones bear worse "
                      "guesses (by itself)",
                      of_fits),
                  request.piece, positive_number);
}

template <class Fields, class Request>
void describe_identify(Fields& fields, Request& request) {
    using What = IdentifyRequest::What;
    const auto key = keys_of_estimate(request.what);
    fields.choice({"what", "what is found"}, request.what, kinds_of_estimates());
    fields.form({"records", "runs of kind `record`, of which all records are used"}, "\"RUN\" or [\"RUN\"]",
                &read_records);
    fields.field("records", request.records);
    fields.form({"gives", "the parameter that each number found becomes"}, "{ damping_ratio = \"zeta\" }", &read_gives);
    fields.list("gives", request.gives,
                [](auto& one, auto& gives) { describe_fields(one, "name", gives.first, "parameter", gives.second); });
    fields.line(key("channel", "value of the records that is evaluated", {What::decrement, What::restitution}),
                request.channel);
    fields.line(
        key("displacement", "value of the records that is the displacement", {What::restitution, What::coupling}),
        request.displacement);
    fields.line(key("voltage", "value of the records that is the voltage", {What::impedance}), request.voltage);
    fields.line(key("current", "value of the records that is the current", {What::coupling, What::impedance}),
                request.current);
    fields.later_number(key("gap",
                            "of the transducer: a number or an expression of the model, the errors of whose parameters "
                            "count. Couplings need it",
                            {What::coupling, What::impedance}),
                        request.gap);
    fields.later_number(
        key("stiffness", "of the suspension, likewise, such as \"m*w0^2\". Couplings need it", {What::coupling}),
        request.stiffness);
    fields.later_number(key("beta1",
                            "coupling that has been found before: with beta2 and the gap it gives the leakage "
                            "inductance",
                            {What::impedance}),
                        request.beta1);
    fields.later_number(key("beta2", "the second number of that coupling", {What::impedance}), request.beta2);
    fields.later_number(key("clamped", "displacement at which the mass was held", {What::impedance}), request.clamped);
    fields.later_number(key("frequency",
                            "rough frequency of the voltage, in cycles per unit of time (estimated from the record)",
                            {What::impedance}),
                        request.frequency);
    fields.count(key("peaks", "largest number of peaks that are used, from the first one", {What::decrement}),
                 request.peaks, {2, 100'000});
    fields.count(key("window",
                     "number of samples on each side of an impact from which its velocities are fitted. Records with "
                     "fewer than three impacts are left out, unless all have fewer",
                     {What::restitution}),
                 request.impacts.window, {ImpactWindow::least_window, ImpactWindow::most_window});
    fields.count(key("transition", "number of samples next to an impact that are left out", {What::restitution}),
                 request.impacts.transition, {0, ImpactWindow::most_window});
    fields.number(
        key("least_jump", "least change of the velocity at an impact (chosen by the noise)", {What::restitution}),
        request.impacts.least_jump, positive_number);
    const auto error_of = [&](const char* name, const char* meaning, What of, auto& error) {
        if (fields.has(name, error > 0))
            fields.number(key(name, meaning, {of}), error, positive_number);
    };
    error_of("gap_error", "standard error of the gap, besides that of its parameters (none)", What::coupling,
             request.gap_error);
    error_of("stiffness_error", "standard error of the stiffness (none)", What::coupling, request.stiffness_error);
    error_of("beta1_error", "that of beta1 (none)", What::impedance, request.beta1_error);
    error_of("beta2_error", "that of beta2 (none)", What::impedance, request.beta2_error);
    if (fields.has("each_row", request.each_row))
        fields.truth(key("each_row", "of several records, too, each row is an equilibrium, not the mean of all",
                         {What::coupling}),
                     request.each_row);
    fields.table(key("noise", "standard deviations of the readings, if they are known", {What::coupling}),
                 "{ displacement, current }", [&request](auto& one) {
                     one.number(key_in_table("displacement", "displacement_noise"), request.displacement_noise,
                                positive_number);
                     one.number(key_in_table("current", "current_noise"), request.current_noise, positive_number);
                 });
    if (fields.has("fit", request.what == What::fit))
        fields.object("fit", [&](auto& one) { describe_fit(one, request); });
}

/// A run of kind identify.
template <class Fields, class Run>
void describe_found_by(Fields& fields, Run& run) {
    const auto key = keys_of_estimate(run.identify().what);
    if constexpr (!Fields::stored) {
        fields.form({"set", "values of further parameters in this run"}, "{ V = 1 }", read_apart);
        fields.form(key("from", "guesses of initial states", {IdentifyRequest::What::fit}), "{ x = 0.1 }", read_apart);
        fields.form(key("mode", "the initial mode", {IdentifyRequest::What::fit}), "\"NAME\"", read_apart);
    }
    fields.object("identify", [&](auto& one) { describe_identify(one, run.identify()); });
    fields.form(
        {"parameters", "other runs of this kind, whose results are used as known parameters, with their errors"},
        "\"RUN\" or [\"RUN\"]", &read_parameters);
    fields.field("parameters", run.parameters);
    fields.number(key("tolerance", "tolerance of the integration in each step, relative to each state",
                      {IdentifyRequest::What::fit}),
                  run.identify().simulation.tolerance, positive_number);
}

} // namespace graze
