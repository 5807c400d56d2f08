#include "graze/identify/estimate.hpp"

#include "graze/base/input_error.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Continued fraction of the incomplete beta function (by W. Lentz's method).
double beta_fraction(double a, double b, double x) {
    constexpr double tiny = 1e-300, enough = 1e-16;
    constexpr int most = 10'000;
    double c = 1, d = 1 / std::max(tiny, std::abs(1 - (a + b) * x / (a + 1)));
    double result = d;
    for (int m = 1; m < most; ++m) {
        const double k = m;
        for (const double factor : {k * (b - k) * x / ((a + 2 * k - 1) * (a + 2 * k)),
                                    -(a + k) * (a + b + k) * x / ((a + 2 * k) * (a + 2 * k + 1))}) {
            d = 1 + factor * d;
            c = 1 + factor / c;
            d = 1 / (std::abs(d) < tiny ? tiny : d);
            c = std::abs(c) < tiny ? tiny : c;
            result *= d * c;
        }
        if (std::abs(d * c - 1) < enough)
            break;
    }
    return result;
}

/// Regularised incomplete beta function.
double incomplete_beta(double a, double b, double x) {
    if (x <= 0 || x >= 1)
        return x <= 0 ? 0 : 1;
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
    return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a : 1 - front * beta_fraction(b, a, 1 - x) / b;
}

} // namespace

double student_quantile(double probability, double freedom) {
    if (!(probability > 0 && probability < 1) || !(freedom > 0))
        throw InputError("there is no such quantile",
                         "give a probability between 0 and 1, and positive degrees of freedom");
    const auto beyond = [&](double t) { return incomplete_beta(0.5 * freedom, 0.5, freedom / (freedom + t * t)); };
    double low = 0, high = 1;
    while (beyond(high) > 1 - probability && high < 1e150)
        high *= 2;
    constexpr int steps = 200;
    for (int i = 0; i < steps && high - low > 1e-15 * high; ++i) {
        const double t = 0.5 * (low + high);
        (beyond(t) > 1 - probability ? low : high) = t;
    }
    return 0.5 * (low + high);
}

double fisher_tail(double ratio, double first, double second) {
    if (!(ratio >= 0) || !(first > 0) || !(second > 0))
        throw InputError("there is no such ratio of mean squares",
                         "give a ratio that is not negative, and positive degrees of freedom");
    return incomplete_beta(0.5 * second, 0.5 * first, second / (second + first * ratio));
}

double chi_square_tail(double squares, std::size_t freedom) {
    if (freedom == 0 || !(squares > 0))
        return 1;
    // Recurrence of the incomplete gamma function in its parameter, from 1/2 or 1 up to freedom/2; all terms are
    // positive, so nothing cancels.
    const double x = 0.5 * squares;
    const bool odd = freedom % 2 == 1;
    double tail = odd ? std::erfc(std::sqrt(x)) : std::exp(-x);
    for (std::size_t k = odd ? 1 : 2; k + 2 <= freedom; k += 2) {
        const double a = 0.5 * static_cast<double>(k);
        tail += std::exp(a * std::log(x) - x - std::lgamma(a + 1));
    }
    return tail < 1 ? tail : 1;
}

double Estimate::half_width(double probability) const {
    return freedom > 0 ? student_quantile(probability, freedom) * error : 0;
}

Combined combine(std::span<const Estimate> sets) {
    if (sets.empty())
        throw InputError("there are no estimates to be combined", "give one or more");
    Combined result;
    result.mean = sets.front();
    const auto count = static_cast<double>(sets.size());
    if (sets.size() == 1)
        return result;
    double least = 0;
    for (const Estimate& set : sets)
        least = set.error > 0 && (least == 0 || set.error < least) ? set.error : least;
    const auto variance_of = [&](const Estimate& set) { return std::pow(std::max(set.error, 1e-3 * least), 2); };
    const auto mean_of = [&](double spread, double& weights, double& departures) {
        const auto weight_of = [&](const Estimate& set) { return least > 0 ? 1 / (variance_of(set) + spread) : 1; };
        double sum = 0;
        weights = departures = 0;
        for (const Estimate& set : sets) {
            weights += weight_of(set);
            sum += weight_of(set) * set.value;
        }
        for (const Estimate& set : sets)
            departures += weight_of(set) * std::pow(set.value - sum / weights, 2);
        return sum / weights;
    };
    double weights = 0, departures = 0, squares = 0;
    mean_of(0, weights, departures);
    for (const Estimate& set : sets)
        squares += least > 0 ? std::pow(variance_of(set), -2) : 1;
    const double spread = least > 0 ? std::max(0.0, (departures - (count - 1)) / (weights - squares / weights)) : 0;
    result.mean.value = mean_of(spread, weights, departures);
    const double scale = departures / (count - 1);
    result.mean.error = std::sqrt((least > 0 ? std::max(scale, spread > 0 ? 0.0 : 1.0) : scale) / weights);
    result.mean.freedom = count - 1;
    if (least > 0 && spread == 0) { // no excess scatter: the pooled error has the degrees of freedom of all sets
        result.mean.freedom = 0;
        for (const Estimate& set : sets)
            result.mean.freedom += set.freedom;
    }
    result.spread = std::sqrt(spread);
    return result;
}

} // namespace graze
