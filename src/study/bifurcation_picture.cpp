#include "study/picture_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace graze {

namespace {

constexpr std::size_t most_marks = 8;
constexpr double least_stretch = 0.01; ///< share of a sweep on both sides of a change that is marked

/// Where something changes that lasted before and lasts after.
std::vector<double> changes(const StoredRun& run, const std::string& direction) {
    auto rows = run.rows({.columns = {"label", "period", "symmetric", "chain", "signature"},
                          .quantities = {run.record.coordinates.front().name},
                          .directions = {direction}});
    struct Stretch {
        std::string kind;
        double first, last;
        std::size_t points;
    };
    std::vector<Stretch> stretches;
    std::size_t all = 0;
    while (rows.next()) {
        if (rows.integer(3) != 0)
            return {}; // several chains: their changes would hide one another
        const std::string kind = fmt::format("{} {} {} {}", rows.text(0), rows.text(1), rows.text(2), rows.text(4));
        if (stretches.empty() || stretches.back().kind != kind)
            stretches.push_back({kind, rows.number(5), rows.number(5), 0});
        stretches.back().last = rows.number(5);
        ++stretches.back().points;
        ++all;
    }
    struct Mark {
        double at;
        std::size_t points; ///< of the shorter of the stretches that it separates
    };
    std::vector<Mark> found;
    const double least = least_stretch * static_cast<double>(all);
    const Stretch* before = nullptr;
    for (const Stretch& stretch : stretches) {
        if (static_cast<double>(stretch.points) < least)
            continue;
        if (before && before->kind != stretch.kind)
            found.push_back({0.5 * (before->last + stretch.first), std::min(before->points, stretch.points)});
        before = &stretch;
    }
    // Of many, those that part the longest stretches.
    std::stable_sort(found.begin(), found.end(), [](const Mark& a, const Mark& b) { return a.points > b.points; });
    found.resize(std::min(found.size(), most_marks));
    std::vector<double> marks;
    for (const Mark& mark : found)
        marks.push_back(mark.at);
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

} // namespace

Figure bifurcation_picture(const StudyPicture& picture, const ResultFile& file) {
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
            for (std::size_t v = 0; v < values.size(); ++v) {
                const std::string& value = values[v];
                FigurePanel panel = panel_of(picture, run, x, value, v);
                const char letter = static_cast<char>('a' + figure.panels.size());
                panel.title = fmt::format("({}) {}", letter,
                                          direction.empty() ? shown_name(picture, name)
                                                            : fmt::format("{} {}", shown_name(picture, x), direction));
                std::map<std::string, std::size_t> series;
                for (std::size_t s = 0; s < samplings.size(); ++s) {
                    series[samplings[s]] = s;
                    panel.series.push_back({samplings.size() > 1 ? shown_name(picture, samplings[s]) : "",
                                            FigureSeries::Style::dots,
                                            s,
                                            {}});
                }
                auto rows = run.rows({.samples = true,
                                      .columns = {"sampling"},
                                      .quantities = {x},
                                      .values = {value},
                                      .directions = {direction},
                                      .samplings = samplings});
                while (rows.next())
                    if (const auto at = series.find(rows.text(0)); at != series.end() && !rows.is_null(2))
                        panel.series[at->second].points.push_back({rows.number(1), rows.number(2)});
                if (!panel.x_range && picture.x.empty())
                    panel.x_range = run.extent(run.record.coordinates.front().name);
                if (run.record.kind == "sweep" && picture.x.empty())
                    panel.marks = changes(run, direction);
                figure.panels.push_back(std::move(panel));
            }
    }
    share_axes(figure);
    return figure;
}

} // namespace graze
