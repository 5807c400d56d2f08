#include "graze/record/harmonic.hpp"

#include "base/linear_systems.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace graze {

namespace {

constexpr std::size_t unknowns = 3;

} // namespace

double Harmonic::at(double time) const {
    return offset + sine * std::sin(frequency * time) + cosine * std::cos(frequency * time);
}

double Harmonic::amplitude() const {
    return std::hypot(sine, cosine);
}

double Harmonic::amplitude_error() const {
    const double size = amplitude();
    if (size == 0)
        return std::hypot(sine_error, cosine_error);
    return std::sqrt(std::max(0.0, std::pow(sine * sine_error, 2) + std::pow(cosine * cosine_error, 2) +
                                       2 * sine * cosine * covariance)) /
           size;
}

double Harmonic::phase() const {
    return std::atan2(cosine, sine);
}

double Harmonic::phase_error() const {
    const double square = sine * sine + cosine * cosine;
    if (square == 0)
        return std::numbers::pi;
    return std::sqrt(std::max(0.0, std::pow(cosine * sine_error, 2) + std::pow(sine * cosine_error, 2) -
                                       2 * sine * cosine * covariance)) /
           square;
}

Harmonic fit_harmonic(std::span<const double> times, std::span<const double> values, double frequency) {
    require_size(values.size(), times.size(), "values of a channel");
    require_finite(frequency, "the frequency");
    if (times.size() <= unknowns || !(frequency > 0))
        throw InputError("there are too few samples of a harmonic", "give four or more, and a positive frequency");
    const auto rows = static_cast<Eigen::Index>(times.size());
    Eigen::MatrixXd matrix(rows, 3);
    for (Eigen::Index i = 0; i < rows; ++i) {
        const double angle = frequency * times[static_cast<std::size_t>(i)];
        matrix.row(i) << 1, std::sin(angle), std::cos(angle);
    }
    const Eigen::Map<const Eigen::VectorXd> right(values.data(), rows);
    const LeastSquares fitted = least_squares(matrix, right);
    const Eigen::Vector3d solution = fitted.solution;
    const Eigen::Matrix3d triangle = fitted.triangle;
    const Eigen::Vector3d pivots = triangle.diagonal().cwiseAbs();
    constexpr double too_small = 1e-6; // below this, too many digits are lost
    if (!(pivots.minCoeff() > too_small * pivots.maxCoeff()))
        throw InputError("the samples cover too short a part of a period to determine its amplitude",
                         "record a period or more");
    const Eigen::Matrix3d inverse = triangle.triangularView<Eigen::Upper>().solve(Eigen::Matrix3d::Identity());
    const double squares = (right - matrix * solution).squaredNorm(),
                 noise = std::sqrt(squares / static_cast<double>(times.size() - unknowns));
    const Eigen::Matrix3d covariance = noise * noise * inverse * inverse.transpose();
    const Eigen::Vector3d errors = covariance.diagonal().cwiseSqrt();
    return {frequency, solution[0], solution[1],      solution[2], errors[0],
            errors[1], errors[2],   covariance(1, 2), noise,       times.size()};
}

double fit_frequency(std::span<const double> times, std::span<const std::span<const double>> channels, double guess) {
    if (times.size() < 2 || channels.empty())
        throw InputError("there are no samples whose frequency could be found", "give samples of a channel");
    // Gauss-Newton in the frequency alone: the other unknowns are eliminated by projecting its column off theirs
    // (Golub and Pereyra, SIAM J. Numer. Anal. 10 (1973) 413; Kaufman's simplification).
    const double origin = 0.5 * (times.front() + times.back()), length = times.back() - times.front();
    std::vector<double> centred(times.size());
    std::transform(times.begin(), times.end(), centred.begin(), [&](double t) { return t - origin; });
    double frequency = guess;
    constexpr int most_steps = 50;
    for (int step = 0; step < most_steps; ++step) {
        double numerator = 0, denominator = 0;
        for (const std::span<const double> values : channels) {
            const Harmonic fit = fit_harmonic(centred, values, frequency);
            const double squares = fit.noise * fit.noise * static_cast<double>(fit.samples - unknowns);
            const double weight = 1 / std::max(squares, 1e-28 * (fit.sine * fit.sine + fit.cosine * fit.cosine));
            std::vector<double> slope(centred.size());
            for (std::size_t i = 0; i < centred.size(); ++i)
                slope[i] = centred[i] * (fit.sine * std::cos(frequency * centred[i]) -
                                         fit.cosine * std::sin(frequency * centred[i]));
            const Harmonic of_slope = fit_harmonic(centred, slope, frequency);
            for (std::size_t i = 0; i < centred.size(); ++i) {
                const double angle = frequency * centred[i], s = std::sin(angle), c = std::cos(angle);
                const double rest = slope[i] - of_slope.offset - of_slope.sine * s - of_slope.cosine * c;
                const double left = values[i] - fit.offset - fit.sine * s - fit.cosine * c;
                numerator += weight * rest * left;
                denominator += weight * rest * rest;
            }
        }
        if (!(denominator > 0))
            throw InputError("the samples do not determine a frequency", "give a channel with an amplitude");
        // Limit the step so that the phase at the ends is not lost.
        const double change = std::clamp(numerator / denominator, -1 / length, 1 / length);
        frequency += change;
        constexpr double enough = 4e-16;
        if (std::abs(change) <= enough * frequency)
            break;
    }
    return frequency;
}

double amplitude(const Period& period, std::size_t channel) {
    require_index(channel, period.samples.values.size(), "channel");
    std::vector<double> times, values;
    for (std::size_t i = 0; i < period.samples.rows(); ++i)
        if (period.samples.times[i] >= period.begin && period.samples.times[i] < period.end) {
            times.push_back(period.samples.times[i] - period.begin);
            values.push_back(period.samples.values[channel][i]);
        }
    return fit_harmonic(times, values, 2 * std::numbers::pi / period.duration()).amplitude();
}

} // namespace graze
