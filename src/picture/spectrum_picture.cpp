#include "picture/picture_kinds.hpp"

#include "graze/record/spectrum.hpp"
#include "graze/study/point_motion.hpp"
#include "record/even_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// The spectrum of a record; of a long one the mean over parts, with fewer frequencies.
Spectrum spectrum_of_rows(const std::vector<double>& times, const std::vector<double>& values) {
    constexpr std::size_t most = 16'384, part = 8192;
    if (values.size() <= most)
        return spectrum(values, even_sampling_frequency(times));
    StoredSamples record({{"t", ""}, {{"value", ""}}}, {times, {values}});
    return averaged_spectrum(record, 0, part);
}

} // namespace

ResultPicture spectrum_picture(const StudyPicture& picture, const ResultFile& file) {
    constexpr std::size_t wanted = 60;
    ResultPicture result;
    FigurePanel panel;
    for (std::size_t r = 0; r < picture.runs.size(); ++r) {
        const StoredRun run(file, picture.runs[r], picture.place);
        const std::string value = chosen_values(picture, run).front();
        const std::string sampling = shown_samplings(picture, run).front();
        require_values(picture, run, {value});
        std::vector<std::pair<std::string, PointRecord>> points;
        for (const auto& at : picture.at)
            points.emplace_back(shown_value(picture, run, at.first, at.second),
                                chosen_point(run, {at}, picture.directions, picture.place));
        if (points.empty())
            points.emplace_back(shown_name(picture, picture.runs[r]),
                                chosen_point(run, {}, picture.directions, picture.place));
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
            // Rows of a record have absolute amplitudes; samples of motions have amplitudes relative to the mean.
            const auto rows = row_samplings(run);
            const bool absolute = std::find(rows.begin(), rows.end(), sampling) != rows.end();
            const Spectrum parts = absolute ? spectrum_of_rows(times, values) : spectrum(values, 1 / spacing);
            if (parts.mean == 0 && !absolute)
                throw InputError(picture.place,
                                 fmt::format("the mean of '{}' is zero, of which a spectrum shows shares", value),
                                 "choose a value that does not vanish, as its square");
            FigureSeries series{title, absolute ? FigureSeries::Style::line : FigureSeries::Style::impulses,
                                panel.series.size()};
            if (result.table.rows() == 0)
                result.table =
                    Table({{"run", ""}, {"frequency", ""}, {absolute ? "amplitude" : "amplitude_percent", ""}});
            for (std::size_t k = 0; k < parts.frequencies.size(); ++k) {
                const double height = absolute ? parts.amplitudes[k] : 100 * parts.amplitudes[k] / std::abs(parts.mean);
                series.points.push_back({parts.frequencies[k], height});
                result.table.add(title, parts.frequencies[k], height);
            }
            panel.series.push_back(std::move(series));
            const std::string words = words_of(run, value);
            const std::string subject = words.empty() ? shown_name(picture, value) : words;
            panel.y_label =
                absolute ? fmt::format("amplitude of {}", subject) : fmt::format("amplitude / mean of {}", subject);
            panel.y_unit = absolute ? run.unit(value) : "%";
            panel.x_unit = run.model.time_unit == "s" ? "Hz" : "";
        }
    }
    panel.x_label = "frequency";
    panel.logarithmic_y = picture.logarithmic_y;
    apply_labels(panel, picture, 0);
    panel.x_range = picture.x_range;
    panel.y_range = picture.y_range;
    result.figure.panels.push_back(std::move(panel));
    return result;
}

} // namespace graze
