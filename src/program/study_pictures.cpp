#include "program/study_pictures.hpp"

#include "graze/results/regression.hpp"
#include "graze/results/spectrum.hpp"
#include "program/gnuplot_text.hpp"
#include "program/output_file.hpp"
#include "program/result_query.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

namespace graze {

namespace {

constexpr std::size_t most_marks = 8;
constexpr double least_stretch = 0.01; ///< share of a sweep on both sides of a change that is marked

std::string in_list(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) {
        text += text.empty() ? "'" : ",'";
        for (const char c : name)
            text += c == '\'' ? std::string("''") : std::string(1, c);
        text += '\'';
    }
    return text;
}

std::vector<std::string> chosen_values(const StudyPicture& picture, const StoredRun& run) {
    if (!picture.y.empty())
        return picture.y;
    std::vector<std::string> names;
    for (const ResultColumn& column : run.record.values)
        names.push_back(column.name);
    return names;
}

void require_values(const StudyPicture& picture, const StoredRun& run, const std::vector<std::string>& names) {
    std::vector<std::string> known;
    for (const ResultColumn& column : run.record.values)
        known.push_back(column.name);
    for (const std::string& name : names)
        if (!run.has_value(name))
            throw InputError(picture.place, fmt::format("run '{}' has no value '{}'", run.record.name, name),
                             name_advice(name, known, "it has none"));
}

std::string first_coordinate(const StudyPicture& picture, const StoredRun& run) {
    if (!picture.x.empty())
        return picture.x;
    if (run.record.coordinates.empty())
        throw InputError(picture.place, fmt::format("run '{}' varies nothing", run.record.name),
                         "draw its history instead");
    return run.record.coordinates.front().name;
}

std::vector<std::string> shown_samplings(const StudyPicture& picture, const StoredRun& run) {
    return picture.samplings.empty() ? run.record.samplings : picture.samplings;
}

FigurePanel panel_of(const StudyPicture& picture, const std::string& x, const std::string& x_unit, const std::string& y,
                     const std::string& y_unit) {
    FigurePanel panel;
    panel.x_label = x;
    panel.y_label = y;
    panel.x_unit = x_unit;
    panel.y_unit = y_unit;
    panel.logarithmic_x = picture.logarithmic_x;
    panel.logarithmic_y = picture.logarithmic_y;
    panel.x_range = picture.x_range;
    panel.y_range = picture.y_range;
    return panel;
}

/// From the least to the greatest value of what is swept.
std::optional<std::pair<double, double>> extent_of(const ResultFile& file, const StoredRun& run) {
    auto rows = file.query(fmt::format("SELECT min({0}), max({0}) FROM {1} AS p",
                                       run.column(run.record.coordinates.front().name), run.points));
    if (!rows.next() || rows.is_null(0) || !(rows.number(0) < rows.number(1)))
        return std::nullopt;
    return std::pair(rows.number(0), rows.number(1));
}

/// Where something changes that lasted before and lasts after.
std::vector<double> changes(const ResultFile& file, const StoredRun& run, const std::string& direction) {
    auto rows = file.query(fmt::format(
        "SELECT {}, label, period, symmetric, chain, signature FROM {} AS p WHERE direction = '{}' ORDER BY "
        "number",
        run.column(run.record.coordinates.front().name), run.points, direction));
    struct Stretch {
        std::string kind;
        double first, last;
        std::size_t points;
    };
    std::vector<Stretch> stretches;
    std::size_t all = 0;
    while (rows.next()) {
        if (rows.integer(4) != 0)
            return {}; // several chains: their changes would hide one another
        const std::string kind = fmt::format("{} {} {} {}", rows.text(1), rows.text(2), rows.text(3), rows.text(5));
        if (stretches.empty() || stretches.back().kind != kind)
            stretches.push_back({kind, rows.number(0), rows.number(0), 0});
        stretches.back().last = rows.number(0);
        ++stretches.back().points;
        ++all;
    }
    std::vector<double> marks;
    const double least = least_stretch * static_cast<double>(all);
    const Stretch* before = nullptr;
    for (const Stretch& stretch : stretches) {
        if (static_cast<double>(stretch.points) < least)
            continue;
        if (before && before->kind != stretch.kind)
            marks.push_back(0.5 * (before->last + stretch.first));
        before = &stretch;
    }
    if (marks.size() > most_marks)
        marks.clear();
    return marks;
}

/// Panels of the same value get the same axis, for up and down to be compared.
void share_axes(Figure& figure) {
    std::map<std::string, std::pair<double, double>> extents;
    for (const FigurePanel& panel : figure.panels)
        for (const FigureSeries& series : panel.series)
            for (const PlanePoint& point : series.points) {
                const auto [at, first] = extents.try_emplace(panel.y_label, point.y, point.y);
                at->second.first = std::min(at->second.first, point.y);
                at->second.second = std::max(at->second.second, point.y);
            }
    constexpr double margin = 0.04;
    for (FigurePanel& panel : figure.panels)
        if (const auto at = extents.find(panel.y_label);
            at != extents.end() && !panel.y_range && !panel.logarithmic_y) {
            const auto [low, high] = at->second;
            if (low < high)
                panel.y_range = std::pair(low - margin * (high - low), high + margin * (high - low));
        }
}

Figure bifurcation(const StudyPicture& picture, const ResultFile& file) {
    Figure figure;
    for (const std::string& name : picture.runs) {
        const StoredRun run(file, name, picture.place);
        const std::vector<std::string> values = chosen_values(picture, run), samplings = shown_samplings(picture, run);
        require_values(picture, run, values);
        const std::string x = first_coordinate(picture, run);
        const std::vector<std::string> directions =
            picture.directions.empty() ? run.record.directions : picture.directions;
        figure.columns = values.size() > 1 ? values.size() : directions.size();
        for (const std::string& direction : directions)
            for (const std::string& value : values) {
                FigurePanel panel = panel_of(picture, x, run.unit(x), value, run.unit(value));
                const char letter = static_cast<char>('a' + figure.panels.size());
                panel.title =
                    fmt::format("({}) {}", letter, direction.empty() ? name : fmt::format("{} {}", x, direction));
                std::map<std::string, std::size_t> series;
                for (std::size_t s = 0; s < samplings.size(); ++s) {
                    series[samplings[s]] = s;
                    panel.series.push_back(
                        {samplings.size() > 1 ? samplings[s] : "", FigureSeries::Style::dots, s, {}});
                }
                auto rows = file.query(
                    fmt::format("SELECT {}, {}, s.sampling FROM {} WHERE p.direction = '{}' AND s.sampling IN ({})",
                                run.column(x), run.value_column(value), run.joined, direction, in_list(samplings)));
                while (rows.next())
                    if (!rows.is_null(1))
                        panel.series[series.at(rows.text(2))].points.push_back({rows.number(0), rows.number(1)});
                if (!panel.x_range && picture.x.empty())
                    panel.x_range = extent_of(file, run);
                if (run.record.kind == "sweep" && picture.x.empty())
                    panel.marks = changes(file, run, direction);
                figure.panels.push_back(std::move(panel));
            }
    }
    share_axes(figure);
    return figure;
}

/// Tells attractors apart: by what they are and, for orbits, by the means of what was sampled, which do not depend on
/// where along the orbit one begins.
class AttractorNames {
public:
    std::size_t index(const std::string& kind, const std::vector<double>& means, const std::vector<double>& spreads) {
        for (std::size_t i = 0; i < known_.size(); ++i) {
            bool same = known_[i].kind == kind;
            for (std::size_t v = 0; same && v < means.size(); ++v)
                same = std::abs(means[v] - known_[i].means[v]) <= 1e-6 * spreads[v];
            if (same)
                return i;
        }
        known_.push_back({kind, means});
        return known_.size() - 1;
    }
    const std::string& kind(std::size_t index) const { return known_[index].kind; }
    std::size_t count() const { return known_.size(); }

private:
    struct Known {
        std::string kind;
        std::vector<double> means;
    };
    std::vector<Known> known_;
};

std::string kind_text(const ResultFile::Rows& row) {
    std::string text = row.text(2);
    if (text == "periodic")
        text = fmt::format("period {}{}{}", row.text(3), row.text(4).empty() ? "" : ", ", row.text(4));
    return text;
}

ResultPicture basin(const StudyPicture& picture, const ResultFile& file) {
    const StoredRun run(file, picture.runs.front(), picture.place);
    if (run.record.coordinates.size() < 2)
        throw InputError(picture.place, fmt::format("run '{}' varies fewer than two things", run.record.name),
                         "draw a bifurcation diagram or a scatter plot of it");
    const std::string x = first_coordinate(picture, run);
    const std::string y = picture.y.empty() ? run.record.coordinates[1].name : picture.y.front();
    std::string means, ranges;
    for (const ResultColumn& column : run.record.values) {
        means += ", avg(" + run.value_column(column.name) + ")";
        ranges += (ranges.empty() ? "" : ", ") + fmt::format("max({0}) - min({0})", run.value_column(column.name));
    }
    std::vector<double> spreads;
    if (auto rows = file.query(fmt::format("SELECT {} FROM {} AS s", ranges.empty() ? "0" : ranges, run.samples));
        rows.next())
        for (std::size_t v = 0; v < run.record.values.size(); ++v)
            spreads.push_back(rows.number(v));
    auto rows = file.query(
        fmt::format("SELECT {}, {}, p.label, p.period, p.signature{} FROM {} AS p LEFT JOIN {} AS s ON s.rowid >= "
                    "p.number * 16777216 AND s.rowid < (p.number + 1) * 16777216 GROUP BY p.number ORDER BY p.number",
                    run.column(x), run.column(y), means, run.points, run.samples));
    ResultPicture result;
    FigurePanel panel = panel_of(picture, x, run.unit(x), y, run.unit(y));
    AttractorNames names;
    while (rows.next()) {
        std::vector<double> mean(run.record.values.size());
        const bool periodic = rows.text(2) == "periodic";
        for (std::size_t v = 0; periodic && v < mean.size(); ++v)
            mean[v] = rows.number(5 + v);
        const std::size_t index = names.index(kind_text(rows), mean, spreads);
        if (index >= panel.series.size())
            panel.series.push_back({"", FigureSeries::Style::dots, index, {}});
        panel.series[index].points.push_back({rows.number(0), rows.number(1)});
    }
    result.table = Table({{"attractor", ""}, {"kind", ""}, {"points", ""}});
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
        panel.series[i].title = fmt::format("{} ({})", names.kind(i), panel.series[i].points.size());
        result.table.add(static_cast<double>(i + 1));
        result.table.add(names.kind(i));
        result.table.add(static_cast<double>(panel.series[i].points.size()));
    }
    result.figure.panels.push_back(std::move(panel));
    return result;
}

std::vector<double> samples_of(const PointRecord& point, const StoredRun& run, const std::string& value,
                               const std::string& sampling, std::vector<double>* times) {
    std::vector<double> result;
    const SampleSet& samples = point.result.samples;
    std::size_t column = 0;
    while (column < run.record.values.size() && run.record.values[column].name != value)
        ++column;
    for (std::size_t s = 0; s < samples.size() && column < samples.width; ++s)
        if (run.record.samplings[samples.samplings[s]] == sampling) {
            result.push_back(samples.values[s * samples.width + column]);
            if (times)
                times->push_back(samples.times[s]);
        }
    return result;
}

ResultPicture spectra(const StudyPicture& picture, const ResultFile& file) {
    constexpr std::size_t wanted = 60;
    ResultPicture result;
    result.table = Table({{"run", ""}, {"frequency", ""}, {"amplitude_percent", ""}});
    FigurePanel panel;
    for (std::size_t r = 0; r < picture.runs.size(); ++r) {
        const StoredRun run(file, picture.runs[r], picture.place);
        const std::string value = chosen_values(picture, run).front();
        const std::string sampling = shown_samplings(picture, run).front();
        require_values(picture, run, {value});
        std::vector<std::pair<std::string, PointRecord>> points;
        for (const auto& at : picture.at) {
            StudyPicture one = picture;
            one.at = {at};
            points.emplace_back(fmt::format("{} = {}", at.first, number_text(at.second)), chosen_point(file, run, one));
        }
        if (points.empty())
            points.emplace_back(picture.runs[r], chosen_point(file, run, picture));
        for (const auto& [title, point] : points) {
            std::vector<double> times, values = samples_of(point, run, value, sampling, &times);
            double spacing = 0;
            if (point.result.label == Label::periodic && !values.empty()) {
                spacing = point.result.duration / static_cast<double>(values.size());
                const std::vector<double> period = values;
                while (values.size() + period.size() <= wanted)
                    values.insert(values.end(), period.begin(), period.end());
            } else if (times.size() > 1) {
                spacing = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
            }
            if (values.size() < 2 || !(spacing > 0))
                throw InputError(picture.place,
                                 fmt::format("run '{}' has too few samples for a spectrum", run.record.name),
                                 "choose another sampling or point");
            const Spectrum parts = spectrum(values, 1 / spacing);
            FigureSeries series{title, FigureSeries::Style::impulses, panel.series.size(), {}};
            for (std::size_t k = 0; k < parts.frequencies.size(); ++k) {
                const double percent = 100 * parts.amplitudes[k] / std::abs(parts.mean);
                series.points.push_back({parts.frequencies[k], percent});
                result.table.add(title);
                result.table.add(parts.frequencies[k]);
                result.table.add(percent);
            }
            panel.series.push_back(std::move(series));
            panel.y_label = fmt::format("amplitude of {} / mean", value);
            panel.y_unit = "%";
            panel.x_unit = run.model.time_unit == "s" ? "Hz" : "";
        }
    }
    panel.x_label = "frequency";
    panel.logarithmic_y = picture.logarithmic_y;
    panel.x_range = picture.x_range;
    panel.y_range = picture.y_range;
    result.figure.panels.push_back(std::move(panel));
    return result;
}

/// Histories and portraits: one panel for each point (portrait) or value (history).
Figure motions(const StudyPicture& picture, const ResultFile& file, bool portrait) {
    Figure figure;
    std::size_t colour = 0;
    for (const std::string& name : picture.runs) {
        const StoredRun run(file, name, picture.place);
        std::vector<StudyPicture> chosen;
        for (const auto& at : picture.at) {
            chosen.push_back(picture);
            chosen.back().at = {at};
        }
        if (chosen.empty())
            chosen.push_back(picture);
        const std::vector<std::string> values = chosen_values(picture, run);
        const std::string x = !portrait ? "t" : picture.x.empty() ? values.front() : picture.x;
        for (const StudyPicture& one : chosen) {
            const PointRecord point = chosen_point(file, run, one);
            std::string title = one.at.empty()
                                    ? name
                                    : fmt::format("{} = {}", one.at.front().first, number_text(one.at.front().second));
            if (point.result.label == Label::periodic)
                title += fmt::format(": period {}", point.result.period);
            else if (run.record.kind != "simulate")
                title += fmt::format(": {}", name_of(point.result.label));
            const bool curve = run.record.kind == "simulate" || point.result.label == Label::periodic;
            std::vector<std::string> names{x};
            for (const std::string& value : values)
                if (!portrait || picture.x.empty() ? value != x : true)
                    names.push_back(value);
            const auto motion =
                curve ? dense_motion(run, point, names, picture.place) : std::vector<std::vector<double>>{};
            for (std::size_t v = 1; v < names.size(); ++v) {
                const std::size_t index = portrait ? figure.panels.size() : v - 1;
                if (index >= figure.panels.size()) {
                    figure.panels.push_back(panel_of(picture, x, x == "t" ? run.model.time_unit : run.unit(x), names[v],
                                                     run.unit(names[v])));
                    if (portrait)
                        figure.panels.back().title = fmt::format("({}) {}", static_cast<char>('a' + index), title);
                }
                FigurePanel& panel = figure.panels[index];
                if (curve) {
                    FigureSeries series{portrait ? "" : title, FigureSeries::Style::line, portrait ? 7 : colour, {}};
                    for (std::size_t i = 0; i < motion[0].size(); ++i)
                        series.points.push_back({motion[0][i], motion[v][i]});
                    panel.series.push_back(std::move(series));
                }
                const auto samplings = shown_samplings(picture, run);
                for (std::size_t s = 0; s < samplings.size(); ++s) {
                    std::vector<double> times;
                    const auto ys = samples_of(point, run, names[v], samplings[s], &times);
                    const auto xs = portrait ? samples_of(point, run, x, samplings[s], nullptr) : times;
                    FigureSeries series{portrait ? samplings[s] : "",
                                        curve ? FigureSeries::Style::circles : FigureSeries::Style::dots,
                                        portrait ? s : colour,
                                        {}};
                    for (std::size_t i = 0; i < std::min(xs.size(), ys.size()); ++i)
                        series.points.push_back({xs[i], ys[i]});
                    panel.series.push_back(std::move(series));
                }
            }
            ++colour;
        }
    }
    figure.columns = portrait && figure.panels.size() > 1 ? 2 : 1;
    return figure;
}

ResultPicture fitted(const StudyPicture& picture, const ResultFile& file) {
    ResultPicture result;
    const StoredRun run(file, picture.runs.front(), picture.place);
    const std::string y = chosen_values(picture, run).front();
    require_values(picture, run, {y});
    const std::string x = picture.successive ? y : first_coordinate(picture, run);
    const std::string group = picture.group.empty() ? "0" : run.column(picture.group);
    auto rows = file.query(fmt::format("SELECT {}, p.number, {}, {} FROM {} WHERE s.sampling IN ({}) ORDER BY 1, "
                                       "p.number, s.rowid",
                                       group, picture.successive ? "0" : run.column(x), run.value_column(y), run.joined,
                                       in_list(shown_samplings(picture, run))));
    std::map<double, std::vector<PlanePoint>> groups;
    std::int64_t last = -1;
    double before = 0;
    while (rows.next()) {
        const double value = rows.number(3);
        if (!picture.successive)
            groups[rows.number(0)].push_back({rows.number(2), value});
        else if (rows.integer(1) == last)
            groups[rows.number(0)].push_back({before, value});
        last = rows.integer(1);
        before = value;
    }
    FigurePanel panel = panel_of(picture, picture.successive ? y + " of one contact" : x, run.unit(x),
                                 picture.successive ? y + " of the next" : y, run.unit(y));
    result.table = Table({{picture.group.empty() ? "group" : picture.group, run.unit(picture.group)},
                          {"slope", ""},
                          {"slope_error", ""},
                          {"intercept", ""},
                          {"intercept_error", ""},
                          {"points", ""}});
    panel.key_inside = true;
    std::size_t colour = 0;
    for (const auto& [value, points] : groups) {
        std::vector<double> xs, ys;
        double least = std::numeric_limits<double>::infinity(), greatest = -least;
        for (const PlanePoint& point : points) {
            const bool in_range = !picture.fit || (point.x > picture.fit->first && point.x < picture.fit->second);
            if (!in_range || (picture.logarithmic_x && !(point.x > 0)) || (picture.logarithmic_y && !(point.y > 0)))
                continue;
            xs.push_back(picture.logarithmic_x ? std::log10(point.x) : point.x);
            ys.push_back(picture.logarithmic_y ? std::log10(point.y) : point.y);
            least = std::min(least, point.x);
            greatest = std::max(greatest, point.x);
        }
        const Regression line = regression(xs, ys);
        const std::string title =
            picture.group.empty() ? "" : fmt::format("{} = {}: ", picture.group, number_text(value));
        panel.series.push_back({"", FigureSeries::Style::dots, colour, points});
        if (line.points > 1) {
            FigureSeries fit{fmt::format("{}slope {:.4f}, intercept {:.4f}", title, line.slope, line.intercept),
                             FigureSeries::Style::line,
                             colour,
                             {}};
            for (const double end : {least, greatest}) {
                const double at = line.intercept + line.slope * (picture.logarithmic_x ? std::log10(end) : end);
                fit.points.push_back({end, picture.logarithmic_y ? std::pow(10, at) : at});
            }
            panel.series.push_back(std::move(fit));
        }
        for (const double number : {value, line.slope, line.slope_error, line.intercept, line.intercept_error,
                                    static_cast<double>(line.points)})
            result.table.add(number);
        ++colour;
    }
    result.figure.panels.push_back(std::move(panel));
    return result;
}

Figure scatter(const StudyPicture& picture, const ResultFile& file) {
    Figure figure;
    for (std::size_t r = 0; r < picture.runs.size(); ++r) {
        const StoredRun run(file, picture.runs[r], picture.place);
        const std::string x = first_coordinate(picture, run);
        const std::vector<std::string> ys = picture.y.empty() ? std::vector<std::string>{"lyapunov"} : picture.y;
        for (std::size_t v = 0; v < ys.size(); ++v) {
            if (v >= figure.panels.size())
                figure.panels.push_back(panel_of(picture, x, run.unit(x), ys[v], run.unit(ys[v])));
            FigureSeries series{picture.runs.size() > 1 ? picture.runs[r] : "", FigureSeries::Style::impulses, r, {}};
            series.style = FigureSeries::Style::circles;
            auto rows = file.query(fmt::format("SELECT {}, {} FROM {} AS p ORDER BY number", run.column(x),
                                               run.column(ys[v]), run.points));
            while (rows.next())
                if (!rows.is_null(0) && !rows.is_null(1))
                    series.points.push_back({rows.number(0), rows.number(1)});
            figure.panels[v].series.push_back(std::move(series));
        }
    }
    return figure;
}

} // namespace

StudyPicture default_picture(const RunRecord& run) {
    StudyPicture picture;
    picture.name = run.name;
    picture.runs = {run.name};
    if (run.kind == "sweep")
        picture.kind = "bifurcation";
    else if (run.kind == "basin" && run.coordinates.size() > 1)
        picture.kind = "basin";
    else if (run.kind == "basin")
        picture.kind = "scatter";
    else
        picture.kind = "history";
    return picture;
}

ResultPicture make_picture(const StudyPicture& given, const ResultFile& file) {
    StudyPicture picture = given;
    if (picture.kind.empty())
        if (const auto run = file.find_run(picture.runs.front()))
            picture.kind = default_picture(*run).kind;
    ResultPicture result;
    if (picture.kind == "basin")
        result = basin(picture, file);
    else if (picture.kind == "spectrum")
        result = spectra(picture, file);
    else if (picture.kind == "regression")
        result = fitted(picture, file);
    else if (picture.kind == "history" || picture.kind == "portrait")
        result.figure = motions(picture, file, picture.kind == "portrait");
    else if (picture.kind == "scatter")
        result.figure = scatter(picture, file);
    else
        result.figure = bifurcation(picture, file);
    result.figure.title = picture.title;
    return result;
}

std::vector<std::string> draw_study_pictures(const Study& study, const ResultFile& file, const std::string& folder,
                                             const Console& console) {
    std::vector<StudyPicture> pictures = study.pictures;
    if (pictures.empty())
        for (const StudyRun& run : study.runs)
            if (const auto record = file.find_run(run.name))
                pictures.push_back(default_picture(*record));
    std::vector<std::string> written;
    for (const StudyPicture& picture : pictures) {
        const std::string base = (std::filesystem::path(folder) / picture.name).string();
        try {
            const ResultPicture made = make_picture(picture, file);
            if (made.table.rows() > 0) {
                std::ostringstream text;
                write_table(text, made.table, TableFormat::csv, 17, {});
                write_file(base + ".csv", text.view());
                written.push_back(base + ".csv");
            }
            draw_figure(made.figure, base + "." + picture.format, "");
            written.push_back(base + "." + picture.format);
        } catch (const InputError& error) {
            console.err << fmt::format("graze: warning: picture '{}' was not drawn: {}\n", picture.name, error.what());
        }
    }
    return written;
}

} // namespace graze
