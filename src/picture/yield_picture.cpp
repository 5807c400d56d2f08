#include "graze/picture/yield_picture.hpp"

#include "graze/base/input_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace graze {

namespace {

/// Number of bars of a histogram: their width is twice the interquartile range divided by the cube root of the number
/// of values (D. Freedman and P. Diaconis, "On the histogram as a density estimator", 1981).
std::size_t bars_of(const std::vector<double>& sorted) {
    constexpr double fewest = 5, most = 200;
    const std::size_t n = sorted.size();
    const double middle = sorted[3 * n / 4] - sorted[n / 4], width = 2 * middle / std::cbrt(static_cast<double>(n));
    const double bars = width > 0 ? (sorted.back() - sorted.front()) / width : fewest;
    return static_cast<std::size_t>(std::clamp(std::ceil(bars), fewest, most));
}

} // namespace

Figure yield_picture(const Yield& yield, const std::string& parameter, const std::string& unit,
                     std::optional<double> least, std::optional<double> greatest) {
    std::vector<double> values;
    for (const Device& device : yield.devices)
        if (device.outcome == DeviceOutcome::found)
            values.push_back(device.value);
    std::sort(values.begin(), values.end());
    if (values.empty() || !(values.front() < values.back()))
        throw InputError("the devices do not differ, or none was found", "vary parameters on which the value depends");
    const std::size_t bars = bars_of(values);
    const double low = values.front(), width = (values.back() - low) / static_cast<double>(bars);
    std::vector<double> counts(bars, 0.0);
    for (const double value : values)
        counts[std::min(bars - 1, static_cast<std::size_t>((value - low) / width))] += 1;
    FigurePanel panel{.x_label = parameter, .y_label = "devices", .x_unit = unit, .roomy_y = true};
    FigureSeries found{"devices", FigureSeries::Style::cells};
    double highest = 0;
    for (std::size_t i = 0; i < bars; ++i) {
        const double left = low + static_cast<double>(i) * width;
        found.cells.push_back({left, left + width, 0, counts[i]});
        highest = std::max(highest, counts[i]);
    }
    panel.series.push_back(std::move(found));
    if (const double deviation = yield.linear_deviation; deviation > 0) {
        FigureSeries linear{"by the derivatives alone", FigureSeries::Style::line, FigureSeries::black};
        constexpr int points = 200;
        const double peak = static_cast<double>(values.size()) * width / (deviation * std::sqrt(2 * std::numbers::pi));
        for (int i = 0; i <= points; ++i) {
            const double z = 8.0 * i / points - 4;
            linear.points.push_back({yield.nominal + z * deviation, peak * std::exp(-0.5 * z * z)});
        }
        highest = std::max(highest, peak);
        panel.series.push_back(std::move(linear));
    }
    panel.y_range = {0, 1.08 * highest};
    for (const std::optional<double>& limit : {least, greatest})
        if (limit)
            panel.marks.push_back(*limit);
    return {.panels = {std::move(panel)}, .symbols = {parameter}};
}

} // namespace graze
