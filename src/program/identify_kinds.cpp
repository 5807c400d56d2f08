#include "program/identify_kinds.hpp"

#include "graze/identify/coupling.hpp"
#include "graze/identify/decrement.hpp"
#include "graze/identify/impedance.hpp"
#include "graze/identify/restitution.hpp"
#include "graze/record/impacts.hpp"
#include "graze/symbolic/input_error.hpp"
#include "program/record_stages.hpp"
#include "program/with_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace graze {

namespace {

using Style = FigureSeries::Style;

constexpr std::size_t most_samples = 10'000'000;

template <class Work>
void for_each_file(const IdentifyArguments& arguments, const Work& work) {
    for (const std::string& file : arguments.reading.files)
        with_file(file, [&] {
            RecordStages stages(file, arguments.reading);
            work(file, stages);
        });
}

std::string name_or(const std::string& given, const char* usual) {
    return given.empty() ? usual : given;
}

FigurePanel panel_of(const Channel& x, const Channel& y) {
    FigurePanel panel;
    panel.x_label = x.name;
    panel.x_unit = x.unit;
    panel.y_label = y.name;
    panel.y_unit = y.unit;
    panel.roomy_x = panel.roomy_y = true;
    return panel;
}

/// Series of what was measured and what was fitted, and a panel below with what is left.
Figure fit_figure(FigurePanel fit, const std::string& left, std::vector<PlanePoint> residuals) {
    Figure figure;
    FigurePanel rest = panel_of({fit.x_label, fit.x_unit}, {left, fit.y_unit});
    rest.x_range = fit.x_range;
    rest.series.push_back({"", Style::dots, 0, std::move(residuals)});
    figure.panels.push_back(std::move(fit));
    figure.panels.push_back(std::move(rest));
    return figure;
}

std::string per(const std::string& unit) {
    return unit.empty() ? "" : "rad/" + unit;
}

/// VALUE or VALUE+-ERROR
Estimate known_value(const std::string& text, const char* option) {
    const std::size_t sign = text.find("+-");
    const auto number = [&](const std::string& part) {
        double value = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (error != std::errc() || end != part.data() + part.size() || !std::isfinite(value))
            throw InputError(Place{fmt::format("{} {}", option, text), 0, 0}, fmt::format("'{}' is no number", part),
                             "write a value, or a value and its standard error as in 1.9e-5+-2e-7");
        return value;
    };
    return {number(text.substr(0, sign)), sign == std::string::npos ? 0 : std::abs(number(text.substr(sign + 2))), 0};
}

} // namespace

Identified identify_decrement(const IdentifyArguments& arguments) {
    std::vector<DecayPeaks> releases;
    RecordHeader header;
    const std::string name = name_or(arguments.channel, "v");
    std::size_t channel = 0;
    for_each_file(arguments, [&](const std::string&, RecordStages& stages) {
        header = stages.header();
        channel = header.channel(name, "--channel");
        releases.push_back(decay_peaks(stages.source(), channel, arguments.peaks));
    });
    const Decrement found = logarithmic_decrement(releases);
    Identified result;
    result.values = {{"natural_frequency", per(header.time.unit), found.frequency},
                     {"damping_ratio", "", found.damping},
                     {"natural_frequency_of_pairs", per(header.time.unit), {found.pair_frequency, 0, 0}},
                     {"damping_ratio_of_pairs", "", {found.pair_damping, 0, 0}}};
    std::vector<Estimate> rests;
    for (const DecayPeaks& peaks : releases)
        rests.push_back({peaks.rest, peaks.rest_error, found.damping.freedom});
    result.values.push_back({"rest_position", header.channels[channel].unit, combine(rests).mean});
    FigurePanel panel = panel_of({header.time.name + " since the first peak", header.time.unit},
                                 {"peaks of " + header.channels[channel].name, header.channels[channel].unit});
    FigureSeries measured{"measured", Style::circles, 0, {}}, fitted{"fitted decay", Style::line, 1, {}};
    std::vector<PlanePoint> left;
    for (std::size_t r = 0; r < releases.size(); ++r) {
        const double first = found.fitted[r].times.front();
        for (std::size_t k = 0; k < releases[r].times.size(); ++k) {
            const double t = releases[r].times[k] - first, height = found.fitted[r].heights[k];
            measured.points.push_back({t, releases[r].heights[k]});
            fitted.points.push_back({found.fitted[r].times[k] - first, height});
            left.push_back({t, releases[r].heights[k] - height});
        }
        fitted.points.push_back({std::nan(""), std::nan("")});
    }
    panel.series = {std::move(measured), std::move(fitted)};
    result.figure = fit_figure(std::move(panel), "measured less fitted", std::move(left));
    return result;
}

Identified identify_restitution(const IdentifyArguments& arguments) {
    Identified result;
    std::vector<Estimate> sets;
    FigureSeries measured{"measured", Style::circles, 0, {}};
    std::vector<PlanePoint> left;
    Channel velocity;
    double fastest = 0, slowest = 0;
    for_each_file(arguments, [&](const std::string& file, RecordStages& stages) {
        ImpactSettings settings;
        settings.velocity = stages.header().channel(name_or(arguments.channel, "v"), "--channel");
        velocity = stages.header().channels[settings.velocity];
        if (!arguments.displacement.empty())
            settings.displacement = stages.header().channel(arguments.displacement, "--displacement");
        settings.window = arguments.window;
        settings.transition = arguments.transition;
        settings.least_jump = arguments.least_jump;
        std::vector<ImpactSpeeds> impacts;
        for (const RecordedImpact& impact : find_impacts(stages.source(), settings))
            impacts.push_back({impact.before, impact.after, impact.before_error, impact.after_error});
        const Restitution found = restitution(impacts);
        sets.push_back(found.coefficient);
        if (arguments.reading.files.size() > 1)
            result.values.push_back({"restitution of " + file, "", found.coefficient});
        for (std::size_t i = 0; i < impacts.size(); ++i) {
            measured.points.push_back({impacts[i].before, impacts[i].after});
            left.push_back({impacts[i].before, found.residuals[i]});
            fastest = std::max(fastest, impacts[i].before);
            slowest = std::min(slowest, impacts[i].before);
        }
    });
    const Combined all = combine(sets);
    result.values.insert(result.values.begin(), {"restitution", "", all.mean});
    if (sets.size() > 1)
        result.values.push_back({"spread_between_records", "", {all.spread, 0, 0}});
    FigurePanel panel =
        panel_of({velocity.name + " before", velocity.unit}, {velocity.name + " after impacts", velocity.unit});
    const double e = all.mean.value;
    panel.series = {std::move(measured),
                    {"fitted", Style::line, 1, {{slowest, -e * slowest}, {fastest, -e * fastest}}}};
    result.figure = fit_figure(std::move(panel), "measured less fitted", std::move(left));
    return result;
}

Identified identify_coupling(const IdentifyArguments& arguments) {
    if (!arguments.gap || !arguments.stiffness)
        throw InputError("gap or stiffness are not known", "give --gap and --stiffness, in the units of the record");
    std::vector<StaticLoad> loads;
    Channel displacement, current;
    for_each_file(arguments, [&](const std::string&, RecordStages& stages) {
        const RecordHeader& header = stages.header();
        const std::size_t q = header.channel(name_or(arguments.displacement, "q"), "--displacement"),
                          i = header.channel(name_or(arguments.current, "I"), "--current");
        displacement = header.channels[q];
        current = header.channels[i];
        const Samples all = read_all(stages.source(), most_samples);
        for (std::size_t row = 0; row < all.rows(); ++row)
            loads.push_back({all.values[q][row], all.values[i][row]});
    });
    CouplingSettings settings;
    settings.gap = *arguments.gap;
    settings.gap_error = arguments.gap_error;
    settings.stiffness = *arguments.stiffness;
    settings.stiffness_error = arguments.stiffness_error;
    if (!arguments.noise.empty()) {
        settings.displacement_noise = arguments.noise[0];
        settings.current_noise = arguments.noise[1];
    }
    const Coupling found = coupling(loads, settings);
    const std::string length = displacement.unit, product = length == "m" && current.unit == "A" ? "H m" : "";
    Identified result;
    result.values = {{"beta1", product, found.beta1},
                     {"beta2", length, found.beta2},
                     {"correlation", "", {found.correlation, 0, 0}},
                     {"beta1_of_regression", product, {found.regression_beta1, 0, 0}},
                     {"beta2_of_regression", length, {found.regression_beta2, 0, 0}}};
    FigurePanel panel = panel_of(current, displacement);
    FigureSeries measured{"measured", Style::circles, 0, {}}, fitted{"fitted", Style::line, 1, {}};
    std::vector<PlanePoint> left;
    double furthest = 0;
    for (std::size_t i = 0; i < loads.size(); ++i) {
        measured.points.push_back({loads[i].current, loads[i].displacement});
        left.push_back({loads[i].current, found.residuals[i]});
        furthest = std::max(furthest, loads[i].displacement);
    }
    constexpr int points = 200;
    for (int i = 0; i <= points && found.beta1.value > 0; ++i) {
        const double q = furthest * i / points;
        fitted.points.push_back(
            {(settings.gap + found.beta2.value - q) * std::sqrt(2 * settings.stiffness * q / found.beta1.value), q});
    }
    panel.series = {std::move(measured), std::move(fitted)};
    result.figure = fit_figure(std::move(panel), "measured less fitted", std::move(left));
    return result;
}

Identified identify_impedance(const IdentifyArguments& arguments) {
    if (arguments.beta1.empty() != arguments.beta2.empty() || (!arguments.beta1.empty() && !arguments.gap))
        throw InputError("a leakage inductance needs beta1, beta2 and the gap",
                         "give --beta1, --beta2 and --gap, or none");
    std::vector<Estimate> frequencies, resistances, inductances, leakages;
    Identified result;
    std::vector<PlanePoint> left;
    FigurePanel panel;
    std::string ohm, henry, hertz;
    for_each_file(arguments, [&](const std::string& file, RecordStages& stages) {
        const RecordHeader header = stages.header();
        const std::size_t v = header.channel(name_or(arguments.voltage, "V"), "--voltage"),
                          c = header.channel(name_or(arguments.current, "I"), "--current");
        const Samples all = read_all(stages.source(), most_samples);
        const Impedance found = impedance(all.times, all.values[v], all.values[c],
                                          arguments.frequency ? 2 * std::numbers::pi * *arguments.frequency : 0);
        frequencies.push_back({found.frequency / (2 * std::numbers::pi), 0, 0});
        resistances.push_back(found.resistance);
        inductances.push_back(found.inductance);
        const auto warn = [&](const char* what, const Estimate& one, const char* remedy) {
            if (one.value < 0)
                result.warnings.push_back(
                    fmt::format("{}: the {} comes out below zero, as none of a coil does; {}", file, what, remedy));
        };
        warn("resistance", found.resistance, "look at the sign of the current or the voltage (--scale NAME=-1)");
        warn("inductance", found.inductance,
             "the current leads the voltage: look at which channel is which, at the frequency, and at filters that "
             "delay one of them");
        if (!arguments.beta1.empty())
            leakages.push_back(leakage_inductance(found.inductance, known_value(arguments.beta1, "--beta1"),
                                                  known_value(arguments.beta2, "--beta2"), *arguments.gap,
                                                  arguments.clamped));
        hertz = header.time.unit == "s" ? "Hz" : header.time.unit.empty() ? "" : "1/" + header.time.unit;
        if (header.channels[v].unit == "V" && header.channels[c].unit == "A") {
            ohm = "ohm";
            henry = header.time.unit == "s" ? "H" : "";
        }
        if (file != arguments.reading.files.front())
            return;
        panel = panel_of(header.time, header.channels[c]);
        FigureSeries measured{"measured", Style::dots, 0, {}}, fitted{"fitted", Style::line, 1, {}};
        const double middle = 0.5 * (all.times.front() + all.times.back());
        constexpr double shown = 3; // periods
        for (std::size_t i = 0; i < all.rows(); ++i) {
            const double t = all.times[i];
            if (t > all.times.front() + shown * 2 * std::numbers::pi / found.frequency)
                break;
            const double angle = found.frequency * (t - middle);
            const double value =
                found.current.offset + found.current.sine * std::sin(angle) + found.current.cosine * std::cos(angle);
            measured.points.push_back({t, all.values[c][i]});
            fitted.points.push_back({t, value});
            left.push_back({t, all.values[c][i] - value});
        }
        panel.series = {std::move(measured), std::move(fitted)};
    });
    const auto put = [&](const char* name, const std::string& unit, const std::vector<Estimate>& sets) {
        if (!sets.empty())
            result.values.push_back({name, unit, combine(sets).mean});
        if (sets.size() > 1)
            result.values.push_back(
                {fmt::format("{}_spread_between_records", name), unit, {combine(sets).spread, 0, 0}});
    };
    put("resistance", ohm, resistances);
    put("inductance", henry, inductances);
    put("leakage_inductance", henry, leakages);
    for (std::size_t i = 0; i < frequencies.size(); ++i)
        result.values.push_back({frequencies.size() == 1 ? "frequency" : "frequency of " + arguments.reading.files[i],
                                 hertz, frequencies[i]});
    result.figure = fit_figure(std::move(panel), "measured less fitted", std::move(left));
    return result;
}

} // namespace graze
