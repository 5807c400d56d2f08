#include "identify/damped_sine.hpp"

#include "base/linear_systems.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <limits>
#include <numbers>

namespace graze {

namespace {

double range_of_samples(const Period& period, std::size_t channel) {
    const std::vector<double>& values = period.samples.values[channel];
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    return *greatest - *least;
}

class DampedSine {
public:
    DampedSine(const std::vector<Period>& periods, const Samples& samples, std::size_t channel, double level)
        : level_(level) {
        const double begin = periods.front().begin, end = periods.back().end;
        for (std::size_t i = 0; i < samples.rows(); ++i)
            if (samples.times[i] >= begin && samples.times[i] <= end) {
                places_.push_back((samples.times[i] - begin) / (end - begin));
                values_.push_back(samples.values[channel][i] - level);
            }
        begin_ = begin;
        length_ = end - begin;
        turn_ = 2 * std::numbers::pi * static_cast<double>(periods.size());
        decay_ = 0;
        if (periods.size() > 1)
            decay_ = std::log(range_of_samples(periods.front(), channel) / range_of_samples(periods.back(), channel)) *
                     static_cast<double>(periods.size()) / static_cast<double>(periods.size() - 1);
    }

    std::optional<DecayFit> fit() {
        constexpr Eigen::Index unknowns = 5;
        const auto rows = static_cast<Eigen::Index>(places_.size());
        if (rows <= 2 * unknowns || !std::isfinite(decay_))
            return std::nullopt;
        Eigen::MatrixXd slopes(rows, unknowns);
        Eigen::VectorXd left(rows);
        Eigen::VectorXd linear = Eigen::VectorXd::Zero(3); // c, a, b
        constexpr int steps = 100;
        constexpr double longest = 0.5; // change of the phase in a step, at the end
        double before = std::numeric_limits<double>::infinity();
        for (int step = 0; step < steps; ++step) {
            fill(slopes, left, linear);
            if (step == 0) { // initial guess of the linear unknowns
                linear = PivotedQR(slopes.leftCols(3)).solve(left);
                fill(slopes, left, linear);
            }
            const PivotedQR factors(slopes);
            const Eigen::VectorXd change = factors.solve(left);
            linear += change.head(3);
            const double size = std::abs(change[3]) + std::abs(change[4]);
            if (!std::isfinite(size))
                return std::nullopt;
            const double share = std::min(1.0, longest / size);
            turn_ += share * change[3];
            decay_ += share * change[4];
            constexpr double enough = 1e-13, nearly = 1e-9;
            if (size < enough * turn_ || (size < nearly * turn_ && size >= before))
                return result_of(slopes, left, linear);
            before = size;
        }
        return std::nullopt;
    }

private:
    void fill(Eigen::MatrixXd& slopes, Eigen::VectorXd& left, const Eigen::VectorXd& linear) const {
        for (Eigen::Index i = 0; i < left.size(); ++i) {
            const double s = places_[static_cast<std::size_t>(i)], falls = std::exp(-decay_ * s),
                         c = falls * std::cos(turn_ * s), d = falls * std::sin(turn_ * s);
            slopes.row(i) << 1, c, d, s * (linear[2] * c - linear[1] * d), -s * (linear[1] * c + linear[2] * d);
            left[i] = values_[static_cast<std::size_t>(i)] - linear[0] - linear[1] * c - linear[2] * d;
        }
    }

    DecayFit result_of(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& left,
                       const Eigen::VectorXd& linear) const {
        const double variance = left.squaredNorm() / static_cast<double>(left.size() - slopes.cols());
        const Eigen::MatrixXd covariance =
            variance *
            (slopes.transpose() * slopes).ldlt().solve(Eigen::MatrixXd::Identity(slopes.cols(), slopes.cols()));
        const double lag = std::atan(decay_ / turn_),
                     top = std::atan2(linear[2], linear[1]) - lag; // phase of the maximum
        return {level_ + linear[0],
                std::sqrt(std::max(0.0, covariance(0, 0))),
                std::sqrt(variance),
                begin_ + top / turn_ * length_,
                2 * std::numbers::pi / turn_ * length_,
                std::hypot(linear[1], linear[2]) * std::exp(-decay_ * top / turn_) * std::cos(lag),
                decay_ / length_,
                wave_of(covariance, left)};
    }

    /// Converts frequency and decay, which the fit has over the whole window, to rates in time.
    DecayWave wave_of(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& left) const {
        const ResidualTest test = test_residuals({left.data(), static_cast<std::size_t>(left.size())}, values_);
        const double scale = std::pow(test.widening / length_, 2);
        return {turn_ / length_,
                decay_ / length_,
                scale * covariance(3, 3),
                scale * covariance(4, 4),
                scale * covariance(3, 4),
                static_cast<double>(left.size() - covariance.rows()),
                test};
    }

    double level_, begin_ = 0, length_ = 1, turn_ = 0, decay_ = 0;
    std::vector<double> places_, values_;
};

} // namespace

std::optional<DecayFit> fit_damped_sine(const std::vector<Period>& periods, const Samples& samples, std::size_t channel,
                                        double level) {
    return DampedSine(periods, samples, channel, level).fit();
}

} // namespace graze
