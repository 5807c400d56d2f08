#include "graze/picture/residual_figure.hpp"

#include "picture/residual_panels.hpp"

#include <cmath>

namespace graze {

namespace {

constexpr std::size_t most_circles = 200; ///< more points are drawn as dots

void add_points(FigureSeries& series, const Identification::Curve& curve) {
    for (std::size_t i = 0; i < curve.x.size(); ++i)
        series.points.push_back({curve.x[i], curve.y[i]});
}

} // namespace

void add_residual_panels(Figure& figure, FigurePanel panel, const std::vector<Identification::Shown>& shown) {
    using Style = FigureSeries::Style;
    panel.roomy_x = panel.roomy_y = true;
    FigurePanel residuals = panel;
    residuals.y_label = "measured less fitted";
    residuals.y_words.clear();
    residuals.y_range.reset();
    FigureSeries measured{"measured", Style::circles, 0, {}}, fitted{"fitted", Style::line, 1, {}},
        left{"", Style::dots, 0, {}};
    for (const Identification::Shown& one : shown) {
        add_points(measured, one.measured);
        add_points(fitted, one.fitted);
        add_points(left, one.left);
        fitted.points.push_back({std::nan(""), std::nan("")}); // interrupts the line
    }
    if (measured.points.size() > most_circles)
        measured.style = Style::dots;
    panel.series = {std::move(measured), std::move(fitted)};
    residuals.series = {std::move(left)};
    figure.panels.push_back(std::move(panel));
    figure.panels.push_back(std::move(residuals));
}

Figure residual_figure(const Identification& found) {
    FigurePanel panel;
    panel.x_label = found.x.name;
    panel.x_unit = found.x.unit;
    panel.y_label = found.y.name;
    panel.y_unit = found.y.unit;
    Figure figure;
    add_residual_panels(figure, std::move(panel), found.shown);
    return figure;
}

} // namespace graze
