#include "graze/results/regression.hpp"
#include "graze/base/require.hpp"

#include <cmath>
#include <numeric>

namespace graze {

Regression regression(std::span<const double> x, std::span<const double> y) {
    require_size(y.size(), x.size(), "values of y beside those of x");
    require_finite(x, "a value of x");
    require_finite(y, "a value of y");
    Regression result;
    const auto count = static_cast<double>(x.size());
    if (x.size() < 2)
        return result;
    const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / count;
    const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / count;
    double xx = 0, xy = 0, squares = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    if (!(xx > 0))
        return result;
    result.points = x.size();
    result.slope = xy / xx;
    result.intercept = mean_y - result.slope * mean_x;
    for (std::size_t i = 0; i < x.size(); ++i)
        squares += std::pow(y[i] - result.intercept - result.slope * x[i], 2);
    if (x.size() > 2) {
        const double variance = squares / (count - 2);
        result.slope_error = std::sqrt(variance / xx);
        result.intercept_error = std::sqrt(variance * (1 / count + mean_x * mean_x / xx));
    }
    return result;
}

} // namespace graze
