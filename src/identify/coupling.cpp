#include "graze/identify/coupling.hpp"

#include "base/linear_systems.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "identify/load_balance.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

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
