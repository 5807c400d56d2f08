#include "picture/interleaved_crosses.hpp"

namespace graze {

namespace {

bool has_crosses(const FigureSeries& series) {
    constexpr int upright = 1, oblique = 2; // gnuplot's
    return series.style == FigureSeries::Style::symbols && (series.symbol == upright || series.symbol == oblique);
}

} // namespace

std::size_t last_of_crosses(const FigurePanel& panel, std::size_t series) {
    std::size_t last = series;
    while (has_crosses(panel.series[series]) && last + 1 < panel.series.size() && has_crosses(panel.series[last + 1]))
        ++last;
    return last;
}

std::vector<CrossLayer> interleaved_crosses(const FigurePanel& panel, std::size_t first, std::size_t last) {
    const std::size_t count = last - first + 1, layers = 3 * count; // each series is drawn last in three layers
    std::vector<CrossLayer> result;
    for (std::size_t layer = 0; layer < layers; ++layer)
        for (std::size_t turn = 0; turn < count; ++turn) {
            CrossLayer& one = result.emplace_back();
            one.series = first + (layer + turn) % count;
            const std::vector<PlanePoint>& points = panel.series[one.series].points;
            for (std::size_t i = layer; i < points.size(); i += layers)
                one.points.push_back(points[i]);
        }
    return result;
}

} // namespace graze
