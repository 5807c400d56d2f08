#include "identify/load_balance.hpp"

#include "graze/identify/estimate.hpp"
#include "graze/identify/residual_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace graze {

namespace {

constexpr double test_level = 1e-4;           // significance level of the tests
constexpr double round_off_of_balance = 1e-9; // relative to the terms of the balance: round-off

/// Residuals of the balances of the loads, each divided by its standard deviation.
class LoadTest {
public:
    LoadTest(std::span<const StaticLoad> loads, std::span<const StaticLoad> points, const CouplingSettings& settings,
             double beta1, double beta2, double noise_q, double noise_i)
        : loads_(loads) {
        double squares = 0, sizes = 0;
        for (std::size_t i = 0; i < loads.size(); ++i) {
            const LoadBalance balance(points[i], settings, beta1, beta2);
            const double weight = 1 / std::hypot(balance.by_displacement * noise_q, balance.by_current * noise_i);
            left_.push_back(weight * LoadBalance(loads[i], settings, beta1, beta2).rest);
            own_[0].push_back(weight * balance.by_beta1);
            own_[1].push_back(weight * balance.by_beta2);
            by_displacement_.push_back(weight * balance.by_displacement);
            by_current_.push_back(weight * balance.by_current);
            squares += left_.back() * left_.back();
            sizes += std::pow(weight * balance.by_beta1 * beta1, 2);
        }
        is_exact_ = !(squares > round_off_of_balance * round_off_of_balance * sizes);
    }
    bool is_exact() const { return is_exact_; }

    /// The p value of errors of displacement or current of this form (offset, drift, curvature).
    template <class Form>
    double chance(bool of_displacement, const Form& form) const {
        std::vector<double> column = of_displacement ? by_displacement_ : by_current_;
        for (std::size_t i = 0; i < column.size(); ++i)
            column[i] *= form(i);
        return chance_of_fit(left_, own_, {column});
    }
    /// The load furthest from what all others predict, and its p value (an F test whose further column is that load
    /// alone).
    std::pair<std::size_t, double> furthest() const {
        const std::vector<double> first = unit(own_[0]), second = unit(without(own_[1], first)),
                                  left = without(without(left_, first), second);
        const auto freedom = static_cast<double>(left.size()) - 3;
        const double squares = dot(left, left);
        std::pair<std::size_t, double> found{0, 1};
        for (std::size_t i = 0; i < left.size() && freedom >= 2; ++i) {
            const double own = 1 - first[i] * first[i] - second[i] * second[i];
            constexpr double independent = 1e-8;
            const double gained = own > independent ? left[i] * left[i] / own : 0, rest = squares - gained;
            const double chance = gained > 0 ? rest > 0 ? fisher_tail(gained / (rest / freedom), 1, freedom) : 0 : 1;
            if (chance < found.second)
                found = {i, chance};
        }
        return found;
    }
    /// Tests the residuals in the order of displacements.
    ResidualTest in_order() const {
        std::vector<std::size_t> order(left_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return loads_[a].displacement < loads_[b].displacement; });
        std::vector<double> sorted;
        for (const std::size_t i : order)
            sorted.push_back(left_[i]);
        return test_residuals(sorted);
    }

private:
    static double dot(const std::vector<double>& one, const std::vector<double>& other) {
        return std::inner_product(one.begin(), one.end(), other.begin(), 0.0);
    }
    static std::vector<double> unit(std::vector<double> column) {
        const double length = std::sqrt(dot(column, column));
        for (double& value : column)
            value = length > 0 ? value / length : 0;
        return column;
    }
    static std::vector<double> without(std::vector<double> column, const std::vector<double>& direction) {
        const double along = dot(column, direction);
        for (std::size_t i = 0; i < column.size(); ++i)
            column[i] -= along * direction[i];
        return column;
    }

    std::span<const StaticLoad> loads_;
    std::vector<double> left_, by_displacement_, by_current_;
    std::vector<std::vector<double>> own_{2};
    bool is_exact_ = false;
};

} // namespace

std::vector<std::string> reasons_against(std::span<const StaticLoad> loads, std::span<const StaticLoad> points,
                                         const CouplingSettings& settings, double beta1, double beta2, double noise_q,
                                         double noise_i) {
    std::vector<std::string> reasons;
    const LoadTest test(loads, points, settings, beta1, beta2, noise_q, noise_i);
    if (test.is_exact())
        return reasons;
    const auto one = [](std::size_t) { return 1.0; };
    const auto row = [](std::size_t i) { return static_cast<double>(i); };
    const auto square_q = [&](std::size_t i) { return points[i].displacement * points[i].displacement; };
    const auto square_i = [&](std::size_t i) { return points[i].current * points[i].current; };
    const double offset = std::min(test.chance(true, one), test.chance(false, one)),
                 drift = std::min(test.chance(true, row), test.chance(false, row)),
                 bend = std::min(test.chance(true, square_q), test.chance(false, square_i));
    if (std::min({offset, drift, bend}) < test_level)
        reasons.emplace_back(offset <= drift && offset <= bend ? "displacement or current may have an offset"
                             : drift <= bend                   ? "displacement or current may drift from row to row"
                                             : "displacement or current may be no straight scale, or the "
                                               "gap another one");
    if (const auto [load, chance] = test.furthest(); chance * static_cast<double>(loads.size()) < test_level)
        reasons.push_back(fmt::format("load {} lies far off", load + 1));
    if (const ResidualTest order = test.in_order(); !order.is_noise())
        reasons.push_back("in the order of displacements: " + order.text());
    return reasons;
}

} // namespace graze
