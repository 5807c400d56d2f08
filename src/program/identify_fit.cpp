#include "base/special_numbers.hpp"
#include "program/commands.hpp"
#include "program/drawing.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/parameter_file.hpp"
#include "graze/picture/figure.hpp"
#include "graze/picture/figure_script.hpp"
#include "program/identify_request.hpp"
#include "program/interrupt.hpp"
#include "program/output_file.hpp"
#include "program/status_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <string>

namespace graze {

namespace {

Table numbers_table(const Fit& fit) {
    Table table({{"name", ""}, {"unit", ""}, {"value", ""}, {"error", ""}, {"low", ""}, {"high", ""}, {"note", ""}});
    for (const FittedNumber& number : fit.numbers) {
        const Estimate& estimate = number.estimate;
        const bool known = estimate.freedom > 0;
        table.add(number.name, number.unit, estimate.value, known ? estimate.error : not_a_number,
                  known ? estimate.value - estimate.half_width() : not_a_number,
                  known ? estimate.value + estimate.half_width() : not_a_number,
                  number.at_bound ? "at its bound"
                  : known         ? ""
                                  : "not determined");
    }
    return table;
}

Table outputs_table(const FitOfRecords& found) {
    const Fit& fit = found.fit;
    Table table{{"output", ""}, {"unit", ""},       {"readings", ""},    {"deviation", ""},
                {"share", ""},  {"chi_square", ""}, {"correlation", ""}, {"outliers", ""}};
    for (std::size_t o = 0; o < fit.outputs.size(); ++o) {
        const FittedOutput& output = fit.outputs[o];
        table.add(output.name, found.channels[o].unit, output.readings, output.deviation, output.share,
                  found.task.outputs[o].noise > 0 ? output.chi_square : not_a_number, output.correlation,
                  output.outliers);
    }
    return table;
}

Table correlations_table(const Fit& fit) {
    std::vector<Table::Column> columns{{"name", ""}};
    for (const FittedNumber& number : fit.numbers)
        columns.push_back({number.name, ""});
    Table table(columns);
    for (std::size_t i = 0; i < fit.numbers.size(); ++i) {
        table.add(fit.numbers[i].name);
        for (std::size_t j = 0; j < fit.numbers.size(); ++j) {
            const bool known = fit.numbers[i].estimate.freedom > 0 && fit.numbers[j].estimate.freedom > 0;
            table.add(known ? fit.correlations[i * fit.numbers.size() + j] : not_a_number);
        }
    }
    return table;
}

Table readings_table(const FitOfRecords& found, const Channel& time) {
    std::vector<Table::Column> columns{{"record", ""}, {time.name, time.unit}};
    for (const Channel& channel : found.channels) {
        columns.push_back({channel.name, channel.unit});
        columns.push_back({channel.name + "_fitted", channel.unit});
    }
    Table table(columns);
    for (std::size_t r = 0; r < found.task.records.size(); ++r) {
        const FitRecord& record = found.task.records[r];
        for (std::size_t i = 0; i < record.times.size(); ++i) {
            table.add(r + 1, record.times[i]);
            for (std::size_t o = 0; o < found.channels.size(); ++o) {
                double read = not_a_number, fitted = not_a_number;
                for (std::size_t c = 0; c < record.readings.size(); ++c)
                    if (record.readings[c].output == o) {
                        read = record.readings[c].values[i];
                        fitted = found.fit.records[r].fitted[c][i];
                    }
                table.add(read, fitted);
            }
        }
    }
    return table;
}

/// Two panels for each output: measured and fitted values over time, and below them the residuals.
Figure fit_figure(const FitOfRecords& found, const Channel& time) {
    using Style = FigureSeries::Style;
    Figure figure;
    for (std::size_t o = 0; o < found.channels.size(); ++o) {
        FigurePanel panel, residuals;
        for (FigurePanel* one : {&panel, &residuals}) {
            one->x_label = time.name;
            one->x_unit = time.unit;
            one->y_unit = found.channels[o].unit;
            one->roomy_x = one->roomy_y = true;
        }
        panel.y_label = found.channels[o].name;
        residuals.y_label = found.channels[o].name + ": fitted less measured";
        FigureSeries read{"measured", Style::dots, 0, {}}, fitted{"fitted", Style::line, 1, {}},
            left{"", Style::dots, 0, {}};
        for (std::size_t r = 0; r < found.task.records.size(); ++r) {
            const FitRecord& record = found.task.records[r];
            for (std::size_t c = 0; c < record.readings.size(); ++c) {
                if (record.readings[c].output != o)
                    continue;
                for (std::size_t i = 0; i < record.times.size(); ++i) {
                    const double t = record.times[i], y = record.readings[c].values[i],
                                 f = found.fit.records[r].fitted[c][i];
                    read.points.push_back({t, y});
                    fitted.points.push_back({t, f});
                    left.points.push_back({t, f - y});
                }
                fitted.points.push_back({not_a_number, not_a_number});
            }
        }
        panel.series = {std::move(read), std::move(fitted)};
        residuals.series = {std::move(left)};
        figure.panels.push_back(std::move(panel));
        figure.panels.push_back(std::move(residuals));
    }
    return figure;
}

ParameterFile parameter_file(const Fit& fit, const FitRequest& request) {
    ParameterFile file;
    const Model& model = request.run.model;
    file.model = model.name;
    std::vector<std::string> files;
    for (const KeptRecord& record : request.records)
        files.push_back(record.name);
    file.text = fmt::format("graze identify fit, {} from {} readings of {}", name_of(fit.ending), fit.readings,
                            fmt::join(files, ", "));
    for (const FittedNumber& number : fit.numbers) {
        if (number.kind != FittedNumber::Kind::parameter)
            continue;
        file.set.emplace_back(number.name, number.estimate.value);
        if (number.estimate.freedom > 0)
            file.errors.emplace_back(number.name, number.estimate.error);
    }
    for (std::size_t i = 0; i < model.states.size(); ++i)
        file.from.emplace_back(model.states[i].name, fit.records.front().start[i]);
    return file;
}

/// Prints warnings: reasons to doubt the errors, or the model.
void warn(const FitOfRecords& found, const Console& console) {
    const Fit& fit = found.fit;
    const auto say = [&](const std::string& text) { console.err << "graze: warning: " << text << '\n'; };
    for (const FreeCombination& free : fit.free)
        say(fmt::format("readings do not tell {}", free.text));
    for (const AlternativeSolution& other : fit.alternatives)
        say(fmt::format(
            "the readings are fitted equally well by {}: bound what is known, as by --free NAME=GUESS:LEAST:GREATEST",
            other.text));
    std::size_t misplaced = 0;
    for (const FittedRecord& record : fit.records)
        misplaced += record.misplaced;
    if (misplaced > 0)
        say(fmt::format("at {} times readings were on the other side of a contact", misplaced));
    for (std::size_t o = 0; o < fit.outputs.size(); ++o) {
        const FittedOutput& output = fit.outputs[o];
        if (output.unchanging && !(found.task.outputs[o].noise > 0))
            say(fmt::format("all readings of '{}' are the same, which tells nothing of their noise: say it by "
                            "--deviation {}=VALUE; errors are too small",
                            output.name, output.name));
        constexpr double deviations = 5;
        if (output.chi_square > 1 + deviations * std::sqrt(2 / static_cast<double>(output.readings)))
            say(fmt::format("what is left of '{}' is {:.3g} times as large as its noise", output.name,
                            std::sqrt(output.chi_square)));
    }
}

FitOfRecords run_fit(const FitRequest& request, const IdentifyArguments& arguments, const Console& console) {
    StatusLine line(console, console.terminal || arguments.progress);
    const auto is_over = [&] {
        return InterruptGuard::requested() || (arguments.time_limit && line.elapsed() > *arguments.time_limit);
    };
    FitSettings settings;
    std::string done = "the first motions";
    settings.progress = [&](const FitProgress& progress) {
        if (line.wanted())
            done = fmt::format("stage {} of {}, iteration {}: {:.3g} of the range is left", progress.stage + 1,
                               progress.stages, progress.iteration, progress.misfit);
        if (line.wanted() && line.is_due())
            line.show(done);
        return !is_over();
    };
    settings.interrupted = [&] { // called during a motion, since a single one may take long
        if (line.wanted() && line.is_due())
            line.show(done);
        return is_over();
    };
    return fit_records(request.run, request.records, settings);
}

} // namespace

int identify_fit(const IdentifyArguments& arguments, const Console& console) {
    const FitRequest request = fit_request(arguments, console);
    if (!arguments.save.empty())
        require_writable(arguments.save);
    const InterruptGuard guard;
    const FitOfRecords found = run_fit(request, arguments, console);
    const Fit& fit = found.fit;
    const Channel& time = request.records.front().header.time;
    if (fit.ending == FitEnding::interrupted) {
        const bool by_user = InterruptGuard::requested();
        console.err << fmt::format(
            "graze: {}: {}; nothing is written\n",
            by_user ? "interrupted" : fmt::format("time limit of {} s", arguments.time_limit.value_or(0)), fit.detail);
        return by_user ? InterruptGuard::exit_code() : exit_irregular;
    }
    if (fit.numbers.empty()) {
        console.err << fmt::format("graze: {}: {}\n", name_of(fit.ending), fit.detail);
        return exit_irregular;
    }
    JsonObject heading;
    heading.add("graze", GRAZE_VERSION);
    heading.add("what", arguments.what);
    heading.add("model", request.run.model.name);
    heading.add("table", arguments.table);
    heading.add("ending", std::string(name_of(fit.ending)));
    heading.add("readings", static_cast<double>(fit.readings));
    heading.add("freedom", fit.freedom);
    heading.add("iterations", static_cast<double>(fit.iterations));
    heading.add("pieces", static_cast<double>(fit.pieces));
    heading.add("condition", fit.condition);
    heading.add("probability", 0.95);
    const Table table = arguments.table == "outputs"        ? outputs_table(found)
                        : arguments.table == "correlations" ? correlations_table(fit)
                        : arguments.table == "readings"     ? readings_table(found, time)
                                                            : numbers_table(fit);
    if (!arguments.reading.plot.empty())
        draw_figure(fit_figure(found, time), arguments.reading.plot, arguments.reading.data);
    deliver(table, arguments.reading.output, heading, console);
    const bool usable = fit.ending == FitEnding::converged;
    const bool kept = usable || fit.ending == FitEnding::misfit;
    if (!arguments.save.empty() && kept)
        write_file(arguments.save, write_parameter_file(parameter_file(fit, request)));
    warn(found, console);
    if (!usable)
        console.err << fmt::format("graze: {}: {}{}\n", name_of(fit.ending), fit.detail,
                                   arguments.save.empty() || kept ? "" : "; nothing is saved");
    return usable ? exit_success : exit_irregular;
}

} // namespace graze
