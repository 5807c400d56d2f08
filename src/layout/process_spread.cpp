#include "graze/layout/process_spread.hpp"

#include "base/random_number.hpp"
#include "graze/base/input_error.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace graze {

namespace {

constexpr std::array spread_fields{
    DepartureField{"bias", &ProcessSpread::bias, &ProcessDeparture::bias, "um"},
    DepartureField{"thickness", &ProcessSpread::thickness, &ProcessDeparture::thickness, "um"},
    DepartureField{"taper", &ProcessSpread::taper, &ProcessDeparture::taper, "deg"},
    DepartureField{"stop_gap", &ProcessSpread::stop_gap, &ProcessDeparture::stop_gap, "um"},
};

/// Returns a root of the correlation matrix, which correlates independent numbers.
Eigen::MatrixXd root_of_correlations(std::span<const SitePlace> sites, double length) {
    const auto n = static_cast<Eigen::Index>(sites.size());
    Eigen::MatrixXd correlations(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index k = 0; k < n; ++k) {
            const SitePlace &a = sites[static_cast<std::size_t>(i)], &b = sites[static_cast<std::size_t>(k)];
            const double distance = std::hypot(a.x - b.x, a.y - b.y) / length;
            correlations(i, k) = std::exp(-0.5 * distance * distance);
        }
    // For close sites the matrix is singular up to round-off, which may make a pivot negative.
    const Eigen::LDLT<Eigen::MatrixXd> factored(correlations);
    const Eigen::VectorXd pivots = factored.vectorD().cwiseMax(0).cwiseSqrt();
    const Eigen::MatrixXd lower = factored.matrixL();
    return factored.transpositionsP().transpose() * (lower * pivots.asDiagonal());
}

} // namespace

bool ProcessSpread::is_empty() const {
    return std::all_of(spread_fields.begin(), spread_fields.end(), [this](const DepartureField& field) {
        const SpreadParts& parts = this->*field.spread;
        return parts.wafer == 0 && parts.radial == 0 && parts.device == 0;
    });
}

std::span<const DepartureField> departure_fields() {
    return spread_fields;
}

std::vector<ProcessDeparture> departures_of(const ProcessSpread& spread, std::span<const SitePlace> sites,
                                            double wafer_radius, std::uint64_t seed, std::size_t wafer) {
    constexpr std::size_t most = 2000;
    const bool is_field = spread.correlation > 0;
    if (is_field && sites.size() > most)
        throw InputError(fmt::format("{} devices on a wafer are too many for a correlation length", sites.size()),
                         fmt::format("give no more than {} devices, or no correlation", most));
    const Eigen::MatrixXd root = is_field ? root_of_correlations(sites, spread.correlation) : Eigen::MatrixXd();
    std::vector<ProcessDeparture> result(sites.size());
    for (std::size_t k = 0; k < spread_fields.size(); ++k) {
        const SpreadParts& parts = spread.*spread_fields[k].spread;
        Eigen::VectorXd own(static_cast<Eigen::Index>(sites.size()));
        for (std::size_t i = 0; i < sites.size(); ++i)
            own[static_cast<Eigen::Index>(i)] = drawn_normal(seed, wafer, spread_fields.size() * (i + 1) + k);
        if (is_field)
            own = root * own;
        const double common = parts.wafer * drawn_normal(seed, wafer, k);
        for (std::size_t i = 0; i < sites.size(); ++i) {
            const double distance = std::hypot(sites[i].x, sites[i].y) / wafer_radius;
            result[i].*spread_fields[k].departure =
                common + parts.radial * distance * distance + parts.device * own[static_cast<Eigen::Index>(i)];
        }
    }
    return result;
}

} // namespace graze
