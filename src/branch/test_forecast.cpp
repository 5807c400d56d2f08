#include "branch/test_forecast.hpp"

#include "base/special_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace graze {

/// Bounds of parameters are linear in the unknowns, and values up to their noise say nothing.
std::vector<double> TestForecast::values_of(const std::vector<BranchTest>& tests) {
    std::vector<double> values;
    std::ranges::transform(tests, std::back_inserter(values), [](const BranchTest& one) {
        const bool says_nothing =
            (one.type == PointType::bound && !one.monitor) || (one.noise > 0 && std::abs(one.value) <= one.noise);
        return says_nothing ? not_a_number : one.value;
    });
    return values;
}

void TestForecast::add(double arclength, const std::vector<BranchTest>& tests) {
    if (!points_.empty() && points_.front().values.size() != tests.size())
        forget();
    points_.push_back({arclength, values_of(tests)});
    if (points_.size() > count)
        points_.erase(points_.begin());
}

void TestForecast::rescale(double length, const std::vector<BranchTest>& tests) {
    const std::vector<double> values = values_of(tests);
    if (points_.empty() || values.size() != points_.back().values.size())
        return forget();
    const Point last = points_.back();
    for (Point& one : points_) {
        one.arclength = last.arclength + length * (one.arclength - last.arclength);
        for (std::size_t i = 0; i < values.size(); ++i)
            one.values[i] = one.values[i] == last.values[i] ? values[i] : one.values[i] * (values[i] / last.values[i]);
    }
}

/// The uncertainty is the difference of the cubic from the parabola through the last three values.
TestForecast::Prediction TestForecast::predict(std::size_t test, double arclength) const {
    std::array<double, count> terms{}; // divided differences, from the newest point backwards
    const auto point = [&](std::size_t i) -> const Point& { return points_[count - 1 - i]; };
    for (std::size_t i = 0; i < count; ++i)
        terms[i] = point(i).values[test];
    for (std::size_t order = 1; order < count; ++order)
        for (std::size_t i = count - 1; i >= order; --i)
            terms[i] = (terms[i] - terms[i - 1]) / (point(i).arclength - point(i - order).arclength);
    Prediction result;
    double product = 1;
    for (std::size_t i = 0; i < count; ++i) {
        const double term = terms[i] * product;
        result.value += term;
        result.uncertainty = std::abs(term);
        product *= arclength - point(i).arclength;
    }
    return result;
}

/// True when a test keeps its sign over a length, and does not come much nearer to zero, or is not defined at all.
bool TestForecast::stays_away(std::size_t test, double length) const {
    constexpr int places = 8;
    constexpr double near = 0.1; // share of the last value
    const auto is_undefined = [&](const Point& one) { return std::isnan(one.values[test]); };
    if (std::ranges::all_of(points_, is_undefined))
        return true;
    const double from = points_.back().arclength, last = points_.back().values[test], sign = last < 0 ? -1 : 1;
    for (int i = 1; i <= places; ++i) {
        const Prediction there = predict(test, from + length * i / places);
        if (!(sign * there.value - there.uncertainty > near * sign * last)) // also where it is not finite
            return false;
    }
    return true;
}

double TestForecast::length(double usual, double longest) const {
    constexpr double ahead = 4; // number of usual steps: zeros are searched with the values at their ends
    if (points_.size() < count)
        return usual;
    for (double length = longest; length > usual; length *= 0.5) {
        bool is_safe = true;
        for (std::size_t i = 0; is_safe && i < points_.back().values.size(); ++i)
            is_safe = stays_away(i, length + ahead * usual);
        if (is_safe)
            return length;
    }
    return usual;
}

bool TestForecast::foresees(double arclength, const std::vector<BranchTest>& tests) const {
    constexpr double inexact = 0.1; // share of the value
    if (points_.size() < count || points_.back().values.size() != tests.size())
        return false;
    const std::vector<double> values = values_of(tests);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double last = points_.back().values[i];
        if (std::isnan(last) && std::isnan(values[i]))
            continue;
        const Prediction there = predict(i, arclength);
        const double allowed = std::max(there.uncertainty, inexact * std::max(std::abs(values[i]), std::abs(last)));
        if (!(std::abs(values[i] - there.value) <= allowed) || (values[i] < 0) != (last < 0))
            return false;
    }
    return true;
}

} // namespace graze
