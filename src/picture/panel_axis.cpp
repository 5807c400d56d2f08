#include "picture/panel_axis.hpp"

#include "picture/box.hpp"
#include "picture/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Fractions of an axis that stay free on both sides of the data.
constexpr double roomy_margin = 0.08, usual_margin = 0.03;
/// A range that is narrower than this, relative to its values, is drawn as a constant.
constexpr double resolution = 1e-9;
constexpr int least_power = -3, greatest_power = 5; ///< numbers outside these powers of ten get a common factor
constexpr int most_tics = 6;

bool is_in_range(double value, const std::optional<std::pair<double, double>>& range) {
    return !range || (value >= range->first && value <= range->second);
}

Extent extent_of(const FigurePanel& panel, bool horizontal) {
    Extent extent;
    const auto& other = horizontal ? panel.y_range : panel.x_range;
    for (const FigureSeries& series : panel.series) {
        for (const PlanePoint& point : series.points)
            if (is_drawn(point, panel) && is_in_range(horizontal ? point.y : point.x, other))
                extent.add(horizontal ? point.x : point.y);
        for (const PlaneBox& cell : series.cells) {
            extent.add(horizontal ? cell.left : cell.low);
            extent.add(horizontal ? cell.right : cell.high);
        }
    }
    return extent;
}

/// Widens the range of a constant, so that tic labels differ.
void widen_constant(double& low, double& high, bool logarithmic) {
    const double size = std::max(std::abs(low), std::abs(high));
    if (high - low > resolution * size && high > low)
        return;
    const double added = logarithmic || size == 0 ? 1 : 0.1 * size;
    low -= added;
    high += added;
}

void choose_range(PanelAxis& axis, const FigurePanel& panel, bool horizontal) {
    const auto there = [&](double value) { return axis.logarithmic ? std::log10(value) : value; };
    const auto back = [&](double place) { return axis.logarithmic ? std::pow(10, place) : place; };
    if (const auto& range = horizontal ? panel.x_range : panel.y_range;
        range && (!axis.logarithmic || range->first > 0)) {
        axis.low = range->first;
        axis.high = range->second;
        if (!(axis.high > axis.low) ||
            axis.high - axis.low > resolution * std::max(std::abs(axis.low), std::abs(axis.high)))
            return;
        double low = there(axis.low), high = there(axis.high);
        widen_constant(low, high, axis.logarithmic);
        axis.low = back(low);
        axis.high = back(high);
        return;
    }
    const Extent extent = extent_of(panel, horizontal);
    if (!(extent.least <= extent.greatest)) { // nothing is drawn
        axis.low = axis.logarithmic ? 0.1 : 0;
        axis.high = 1;
        return;
    }
    const bool has_cells = std::any_of(panel.series.begin(), panel.series.end(),
                                       [](const FigureSeries& series) { return !series.cells.empty(); });
    const double margin = has_cells ? 0 : (horizontal ? panel.roomy_x : panel.roomy_y) ? roomy_margin : usual_margin;
    double low = there(extent.least), high = there(extent.greatest);
    widen_constant(low, high, axis.logarithmic);
    const double free = margin * (high - low);
    axis.low = back(low - free);
    axis.high = back(high + free);
}

RichText number_label(double value, double tic, int power) {
    const double unit = std::pow(10, power);
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(tic / unit) - 1e-9)), 0, 12);
    std::string text = fmt::format("{:.{}f}", std::abs(value) < 0.01 * tic ? 0.0 : value / unit, digits);
    if (text.front() == '-')
        text.replace(0, 1, "−");
    return rich(text);
}

/// True when tic labels do not overlap.
bool fits(const PanelAxis& axis, bool horizontal, double length, double font) {
    constexpr double gap = 0.8, line = 1.5; // in units of the font size
    for (std::size_t i = 1; i < axis.tics.size(); ++i) {
        const PanelAxis::Tic &one = axis.tics[i - 1], &next = axis.tics[i];
        const double distance = length * (axis.share(next.value) - axis.share(one.value));
        const double needed = horizontal ? (width_of(one.text) + width_of(next.text)) / 2 + gap : line;
        if (distance < needed * font)
            return false;
    }
    return true;
}

void write_linear(PanelAxis& axis, int wanted) {
    constexpr double slack = 1e-6; // a tic may lie outside by rounding errors
    const double tic = axis_for(axis.low, axis.high, wanted, 0).tic;
    axis.tics.clear();
    const double first = std::ceil(axis.low / tic - slack);
    constexpr int most = 4 * most_tics; // bounds the loop, even if adding a tic does not change the value
    for (int i = 0; i < most && (first + i) * tic <= axis.high + slack * tic; ++i)
        axis.tics.push_back({(first + i) * tic + 0.0, number_label((first + i) * tic, tic, axis.power)});
}

/// Sets tics with labels at every `step`-th decade, and minor tics between them.
void write_decades(PanelAxis& axis, int step) {
    axis.tics.clear();
    axis.minor.clear();
    for (int decade = static_cast<int>(std::floor(std::log10(axis.low) + 1e-9));
         decade <= static_cast<int>(std::ceil(std::log10(axis.high))); ++decade) {
        const double value = std::pow(10, decade);
        const auto is_there = [&](double one) { return axis.share(one) > -1e-9 && axis.share(one) < 1 + 1e-9; };
        if (is_there(value)) {
            if (decade % step == 0)
                axis.tics.push_back({value, rich_power(decade)});
            else
                axis.minor.push_back(value);
        }
        for (int part = 2; step == 1 && part < 10; ++part)
            if (is_there(part * value))
                axis.minor.push_back(part * value);
    }
}

} // namespace

double PanelAxis::value_at(double share) const {
    return logarithmic ? low * std::pow(high / low, share) : low + share * (high - low);
}

double PanelAxis::share(double value) const {
    if (logarithmic)
        return value > 0 ? std::log(value / low) / std::log(high / low) : not_a_number;
    return (value - low) / (high - low);
}

bool is_drawn(const PlanePoint& point, const FigurePanel& panel) {
    return std::isfinite(point.x) && std::isfinite(point.y) && (!panel.logarithmic_x || point.x > 0) &&
           (!panel.logarithmic_y || point.y > 0);
}

PanelAxis panel_axis(const FigurePanel& panel, bool horizontal, double length, double font) {
    PanelAxis axis;
    axis.logarithmic = horizontal ? panel.logarithmic_x : panel.logarithmic_y;
    choose_range(axis, panel, horizontal);
    require_drawable(axis.low, axis.high, horizontal ? panel.x_label : panel.y_label);
    if (axis.logarithmic)
        require_drawable(0, axis.low, horizontal ? panel.x_label : panel.y_label);
    if (axis.logarithmic && axis.high / axis.low >= 10) {
        for (int step = 1; step < 100; ++step) {
            write_decades(axis, step);
            if (fits(axis, horizontal, length, font) || axis.tics.size() < 3)
                return axis;
        }
        return axis;
    }
    const double size = std::max(std::abs(axis.low), std::abs(axis.high));
    const int power = static_cast<int>(std::floor(std::log10(size)));
    axis.power = power < least_power || power >= greatest_power ? power : 0;
    for (int wanted = most_tics; wanted > 1; --wanted) {
        write_linear(axis, wanted);
        if (fits(axis, horizontal, length, font))
            return axis;
    }
    while (axis.tics.size() > 1 &&
           !fits(axis, horizontal, length, font)) // labels are too long for the axis: remove every second one
        for (std::size_t i = 1; i < axis.tics.size(); ++i)
            axis.tics.erase(axis.tics.begin() + static_cast<std::ptrdiff_t>(i));
    return axis;
}

} // namespace graze
