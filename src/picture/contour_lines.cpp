#include "picture/contour_lines.hpp"

#include "base/special_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// The next number 1, 2 or 5 times a power of ten that is not below the step.
double round_step(double step) {
    const double decade = std::pow(10.0, std::floor(std::log10(step)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (step <= factor * decade * (1 + 1e-12))
            return factor * decade;
    return 10 * decade;
}

} // namespace

std::vector<double> contour_levels(const ContourGrid& grid, std::size_t about) {
    double least = std::numeric_limits<double>::infinity(), greatest = -least;
    for (const double value : grid.values)
        if (std::isfinite(value)) {
            least = std::min(least, value);
            greatest = std::max(greatest, value);
        }
    std::vector<double> levels;
    if (!(least < greatest) || about == 0)
        return levels;
    const double step = round_step((greatest - least) / static_cast<double>(about));
    // Levels are multiples of the step. Rounding may leave none between values that are large and nearly equal.
    const double first = std::ceil(least / step), last = std::floor(greatest / step);
    // The loop is bounded: for large values, adding 1 may not change `first`.
    for (std::size_t k = 0; k <= 2 * about + 2 && first + static_cast<double>(k) <= last; ++k)
        if (const double level = (first + static_cast<double>(k)) * step; level > least && level < greatest)
            if (levels.empty() || level > levels.back())
                levels.push_back(level);
    return levels;
}

std::vector<PlanePoint> contour_line(const ContourGrid& grid, double level) {
    const std::size_t across = grid.x.size();
    std::vector<PlanePoint> points;
    for (std::size_t j = 0; j + 1 < grid.y.size(); ++j)
        for (std::size_t i = 0; i + 1 < across; ++i) {
            const std::array<PlanePoint, 4> corners{{{grid.x[i], grid.y[j]},
                                                     {grid.x[i + 1], grid.y[j]},
                                                     {grid.x[i + 1], grid.y[j + 1]},
                                                     {grid.x[i], grid.y[j + 1]}}};
            const std::array<double, 4> values{grid.values[j * across + i], grid.values[j * across + i + 1],
                                               grid.values[(j + 1) * across + i + 1],
                                               grid.values[(j + 1) * across + i]};
            if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
                continue;
            std::vector<PlanePoint> crossings;
            for (std::size_t k = 0; k < corners.size(); ++k) {
                const std::size_t next = (k + 1) % corners.size();
                if ((values[k] < level) == (values[next] < level))
                    continue;
                const double share = (level - values[k]) / (values[next] - values[k]);
                crossings.push_back({corners[k].x + share * (corners[next].x - corners[k].x),
                                     corners[k].y + share * (corners[next].y - corners[k].y)});
            }
            // Two crossings, or four at a saddle, where either pairing is valid.
            for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
                points.insert(points.end(), {crossings[k], crossings[k + 1], {not_a_number, not_a_number}});
        }
    return points;
}

} // namespace graze
