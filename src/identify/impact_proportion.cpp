#include "identify/impact_proportion.hpp"

#include "graze/identify/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace graze {

namespace {

double dot_product(const std::vector<double>& one, const std::vector<double>& other) {
    return std::inner_product(one.begin(), one.end(), other.begin(), 0.0);
}

/// Subtracts the component of a column along a unit vector.
void take_out(std::vector<double>& column, const std::vector<double>& direction) {
    const double along = dot_product(column, direction);
    for (std::size_t i = 0; i < column.size(); ++i)
        column[i] -= along * direction[i];
}

/// Residuals of the line through the origin, and of fits with further terms, in standard errors.
class WeighedImpacts {
public:
    WeighedImpacts(std::span<const RecordedImpact> impacts, double e) {
        for (const RecordedImpact& one : impacts) {
            // An error of the impact's time shifts both velocities, so their errors are correlated.
            const double variance = one.after_error * one.after_error + e * e * one.before_error * one.before_error +
                                    2 * e * one.covariance;
            weights_.push_back(1 / std::sqrt(std::max(variance, least_variance)));
            before_.push_back(one.before);
            left_.push_back(weights_.back() * (one.after + e * one.before));
        }
        directions_ = {column([](double v, double) { return v; })};
        information_ = dot_product(directions_.front(), directions_.front());
        normalise(directions_.front());
        take_out(left_, directions_.front());
    }

    double squares() const { return dot_product(left_, left_); }
    /// Inverse variance of the coefficient by the velocities' own errors.
    double information() const { return information_; }
    std::size_t count() const { return left_.size(); }

    /// The p value of further terms by the velocities' own errors; 1 if the residuals exceed these errors even with the
    /// terms.
    template <class... Term>
    double chance(const Term&... terms) const {
        constexpr double too_much = 1e-3;
        std::vector<std::vector<double>> directions = directions_;
        std::vector<double> left = left_;
        (add(directions, left, column(terms)), ...);
        const std::size_t further = directions.size() - 1;
        if (further == 0 || count() < 2 + further)
            return 1;
        const double rest = dot_product(left, left);
        const std::size_t freedom = count() - 1 - further;
        if (chi_square_tail(rest, freedom) < too_much)
            return 1;
        const double scale = std::max(1.0, rest / static_cast<double>(freedom));
        return chi_square_tail((squares() - rest) / scale, further);
    }

private:
    static constexpr double least_variance = 1e-300;
    static bool normalise(std::vector<double>& column) {
        const double length = std::sqrt(dot_product(column, column));
        for (double& value : column)
            value = length > 0 ? value / length : 0;
        return length > 0;
    }
    /// Adds the part of a term that is orthogonal to those before (Gram-Schmidt), if there is one.
    static void add(std::vector<std::vector<double>>& directions, std::vector<double>& left,
                    std::vector<double> column) {
        constexpr double independent = 1e-4;
        normalise(column);
        for (const std::vector<double>& direction : directions)
            take_out(column, direction);
        if (!(dot_product(column, column) > independent * independent) || !normalise(column))
            return;
        take_out(left, column);
        directions.push_back(std::move(column));
    }
    template <class Term>
    std::vector<double> column(const Term& term) const {
        std::vector<double> result;
        for (std::size_t i = 0; i < weights_.size(); ++i)
            result.push_back(weights_[i] * term(before_[i], static_cast<double>(i)));
        return result;
    }

    std::vector<double> weights_, before_, left_;
    std::vector<std::vector<double>> directions_; ///< unit vector of the line itself
    double information_ = 0;
};

} // namespace

ImpactProportion test_proportion(std::span<const RecordedImpact> impacts, double e) {
    ImpactProportion result;
    if (impacts.size() < 3)
        return result;
    const WeighedImpacts weighed(impacts, e);
    const auto one = [](double, double) { return 1.0; };
    const auto row = [](double, double k) { return k; };
    const auto square = [](double v, double) { return v * std::abs(v); };
    const auto order = [](double v, double k) { return v * k; };
    result.scatter = weighed.squares() / static_cast<double>(weighed.count() - 1);
    constexpr double inexact = 2;
    // More scatter than that cannot come from inexact errors, and does not make a restitution above one more likely.
    result.excess = (e - 1) * std::sqrt(weighed.information() / std::clamp(result.scatter, 1.0, inexact));
    result.unlike = chi_square_tail(weighed.squares() / inexact, weighed.count() - 1);
    // Bonferroni correction: several terms are tested.
    result.offset = std::min(1.0, 2 * std::min(weighed.chance(one), weighed.chance(one, row)));
    result.change =
        std::min(1.0, 3 * std::min({weighed.chance(square), weighed.chance(order), weighed.chance(square, order)}));
    return result;
}

std::size_t doubtful_impacts(std::span<const RecordedImpact> impacts) {
    constexpr double errors = 2;
    return static_cast<std::size_t>(std::count_if(impacts.begin(), impacts.end(), [](const RecordedImpact& one) {
        // After a fully plastic impact the velocity may have either sign within its error.
        const bool goes_on = one.before * one.after > 0 && std::abs(one.after) > errors * one.after_error;
        return !(std::abs(one.before) > errors * one.before_error) || goes_on;
    }));
}

} // namespace graze
