#include "graze/identify/coupling.hpp"

#include "base/linear_systems.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/identify/residual_test.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace graze {

namespace {

/// Residual of the equilibrium, times (beta2 + d - q)^2, and its derivatives.
struct LoadBalance {
    double rest = 0;
    double by_displacement = 0, by_current = 0, by_beta1 = 0, by_beta2 = 0, by_stiffness = 0;

    LoadBalance(const StaticLoad& load, const CouplingSettings& settings, double beta1, double beta2) {
        const double q = load.displacement, space = beta2 + settings.gap - q, k = 2 * settings.stiffness;
        rest = k * q * space * space - beta1 * load.current * load.current;
        by_displacement = k * (space * space - 2 * q * space);
        by_current = -2 * beta1 * load.current;
        by_beta1 = -load.current * load.current;
        by_beta2 = 2 * k * q * space; // also the derivative by the gap
        by_stiffness = 2 * q * space * space;
    }
};

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

/// Returns reasons why loads are not equilibria of such a magnet with random noise, in words; empty if no test fails.
/// @param points estimated true equilibria of the loads. Derivatives are taken there, since derivatives at the loads
/// are correlated with the residuals
/// @param noise_q, noise_i standard deviations; only their ratio matters
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

/// Solves the regression of Eqs. (5.14) to (5.16), which is linear in the root of beta1 and in beta2.
Eigen::Vector2d regression_of(std::span<const StaticLoad> loads, const CouplingSettings& settings) {
    std::vector<Eigen::Vector3d> rows;
    for (const StaticLoad& load : loads)
        if (load.displacement > 0) {
            const double root = std::sqrt(2 * settings.stiffness * load.displacement);
            rows.emplace_back(std::abs(load.current), -root, (settings.gap - load.displacement) * root);
        }
    if (rows.size() < 2)
        throw InputError("there are too few equilibria with a positive displacement", "give three or more");
    Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()), 2);
    Eigen::VectorXd right(matrix.rows());
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        matrix.row(i) = rows[static_cast<std::size_t>(i)].head<2>();
        right[i] = rows[static_cast<std::size_t>(i)][2];
    }
    const Eigen::Vector2d scale = matrix.colwise().norm();
    const PivotedQR factors(matrix * scale.cwiseInverse().asDiagonal());
    constexpr double too_small = 1e-10;
    if (!(std::abs(factors.pivot(1)) > too_small))
        throw InputError("the equilibria do not determine both constants", "load it with several currents");
    const Eigen::Vector2d found = factors.solve(right).cwiseQuotient(scale);
    return {found[0] * found[0], found[1]};
}

void require_loads(std::span<const StaticLoad> loads, const CouplingSettings& settings) {
    for (const StaticLoad& load : loads) {
        require_finite(load.displacement, "the displacement of an equilibrium");
        require_finite(load.current, "the current of an equilibrium");
    }
    for (const double value : {settings.gap, settings.stiffness, settings.gap_error, settings.stiffness_error,
                               settings.displacement_noise, settings.current_noise}) {
        require_finite(value, "a gap, stiffness, error or noise");
        if (value < 0)
            throw InputError("a gap, stiffness, error or noise is negative", "give positive numbers");
    }
    if (settings.gap == 0)
        throw InputError("there is no gap", "give the gap at rest");
    constexpr double noisy = 5; // standard deviations: noise may place a touching mass beyond the gap
    for (const StaticLoad& load : loads)
        if (load.displacement > settings.gap + noisy * settings.displacement_noise)
            throw InputError(fmt::format("a displacement of {:.4g} is larger than the gap at rest, {:.4g}, which is "
                                         "impossible",
                                         load.displacement, settings.gap),
                             "give the gap, the stiffness and displacements in the same unit of length (scale in "
                             "the run that has the record)");
    constexpr std::size_t fewest = 3;
    if (loads.size() < fewest || !(settings.stiffness > 0))
        throw InputError("there are too few equilibria, or no stiffness", "give three or more, and m w0^2");
}

} // namespace

Coupling coupling(std::span<const StaticLoad> loads, const CouplingSettings& settings) {
    require_loads(loads, settings);
    Coupling result;
    Eigen::Vector2d betas = regression_of(loads, settings);
    result.regression_beta1 = betas[0];
    result.regression_beta2 = betas[1];
    double noise_q = settings.displacement_noise, noise_i = settings.current_noise;
    if (noise_q == 0 && noise_i == 0)
        for (const StaticLoad& load : loads) {
            noise_q = std::max(noise_q, std::abs(load.displacement));
            noise_i = std::max(noise_i, std::abs(load.current));
        }
    const auto rows = static_cast<Eigen::Index>(loads.size());
    Eigen::MatrixXd matrix(rows, 2);
    Eigen::VectorXd rest(rows), by_gap(rows), by_stiffness(rows);
    // The true equilibria, on the curve, are estimated along with the constants (H. I. Britt and R. H. Luecke,
    // Technometrics 15 (1973) 233): derivatives at the noisy loads would be correlated with the residuals and bias the
    // constants.
    std::vector<StaticLoad> points(loads.begin(), loads.end());
    std::vector<double> deviations(loads.size());
    const auto weigh = [&] {
        for (std::size_t i = 0; i < loads.size(); ++i) {
            const LoadBalance balance(points[i], settings, betas[0], betas[1]);
            const double deviation = std::hypot(balance.by_displacement * noise_q, balance.by_current * noise_i);
            if (!(deviation > 0))
                throw InputError("the force balance at an equilibrium does not depend on the noisy quantities",
                                 "give noise of the currents, too");
            const auto row = static_cast<Eigen::Index>(i);
            deviations[i] = deviation;
            matrix.row(row) << balance.by_beta1 / deviation, balance.by_beta2 / deviation;
            rest[row] = (balance.rest + balance.by_displacement * (loads[i].displacement - points[i].displacement) +
                         balance.by_current * (loads[i].current - points[i].current)) /
                        deviation;
            by_gap[row] = balance.by_beta2 / deviation;
            by_stiffness[row] = balance.by_stiffness / deviation;
        }
    };
    const auto move_points = [&](const Eigen::VectorXd& left) {
        for (std::size_t i = 0; i < loads.size(); ++i) {
            const LoadBalance balance(points[i], settings, betas[0], betas[1]);
            const double share = left[static_cast<Eigen::Index>(i)] / deviations[i];
            points[i].displacement = loads[i].displacement - noise_q * noise_q * balance.by_displacement * share;
            points[i].current = loads[i].current - noise_i * noise_i * balance.by_current * share;
        }
    };
    constexpr int most_steps = 100;
    for (int step = 0; step < most_steps; ++step) {
        weigh();
        const Eigen::Vector2d scale = matrix.colwise().norm();
        const Eigen::Vector2d change =
            PivotedQR(matrix * scale.cwiseInverse().asDiagonal()).solve(-rest).cwiseQuotient(scale);
        move_points(rest + matrix * change);
        betas += change;
        if (!betas.allFinite())
            throw InputError("no constants of coupling fit these equilibria",
                             "look at displacements, currents and units");
        constexpr double enough = 1e-14;
        if ((change.cwiseAbs() - enough * betas.cwiseAbs()).maxCoeff() <= 0)
            break;
    }
    weigh();
    const Eigen::Vector2d scale = matrix.colwise().norm();
    const Eigen::MatrixXd scaled = matrix * scale.cwiseInverse().asDiagonal();
    const Eigen::Matrix2d inverse = (scaled.transpose() * scaled).inverse();
    const double freedom = static_cast<double>(rows - 2);
    const Eigen::Matrix2d by_noise = scale.cwiseInverse().asDiagonal() * (rest.squaredNorm() / freedom * inverse) *
                                     scale.cwiseInverse().asDiagonal();
    // Errors of gap and stiffness propagate to the constants by the linearised equations.
    const auto moved = [&](const Eigen::VectorXd& by, double error) -> Eigen::Vector2d {
        return -(inverse * (scaled.transpose() * by)).cwiseQuotient(scale) * error;
    };
    const Eigen::Vector2d by_known_gap = moved(by_gap, settings.gap_error),
                          by_known_stiffness = moved(by_stiffness, settings.stiffness_error);
    const auto estimate = [&](Eigen::Index k) {
        return Estimate{betas[k],
                        std::sqrt(by_noise(k, k) + by_known_gap[k] * by_known_gap[k] +
                                  by_known_stiffness[k] * by_known_stiffness[k]),
                        freedom};
    };
    result.beta1 = estimate(0);
    result.beta2 = estimate(1);
    const double both = std::sqrt(by_noise(0, 0) * by_noise(1, 1));
    result.correlation = both > 0 ? by_noise(0, 1) / both : 0;
    for (const StaticLoad& load : loads) {
        const LoadBalance balance(load, settings, betas[0], betas[1]);
        result.residuals.push_back(balance.by_displacement != 0 ? balance.rest / balance.by_displacement : 0);
    }
    result.reasons = reasons_against(loads, points, settings, betas[0], betas[1], noise_q, noise_i);
    return result;
}

} // namespace graze
