#include "study/picture_kinds.hpp"

#include "graze/results/point_motion.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

/// Histories and portraits: one panel for each point (portrait) or value (history).
Figure motion_picture(const StudyPicture& picture, const ResultFile& file, bool portrait) {
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
            const PointRecord point = chosen_point(run, one.at, one.directions, one.place);
            std::string title = one.at.empty()
                                    ? name
                                    : fmt::format("{} = {}", one.at.front().first, title_number(one.at.front().second));
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

} // namespace graze
