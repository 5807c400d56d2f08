#pragma once

#include "graze/identify/decay_wave.hpp"
#include "graze/record/period.hpp"

#include <Eigen/Core>

#include <cmath>
#include <optional>
#include <vector>

namespace graze {

/// Where an oscillation comes to rest, and the noise about it.
struct Rest {
    double value = 0, error = 0;
    double noise = 0;              ///< standard deviation of a sample
    double peak = 0, distance = 1; ///< time of one of the oscillation's peaks, and from one to the next
    double height = 0, decay = 0;  ///< of that one, and how the others' logarithms fall with time
    DecayWave wave{};

    double height_at(double time) const { return height * std::exp(-decay * (time - peak)); }

    double peak_in(const Period& period) const {
        const double middle = 0.5 * (period.begin + period.end);
        return peak + distance * std::round((middle - peak) / distance);
    }
};

/// c + exp(-decay s) (a cos(turn s) + b sin(turn s)) through the samples of whole periods by least squares, with s from
/// 0 to 1.
class DampedSine {
public:
    DampedSine(const std::vector<Period>& periods, const Samples& samples, std::size_t channel, double level);
    /// @return none where the samples do not follow such an oscillation
    std::optional<Rest> fit();

private:
    void fill(Eigen::MatrixXd& slopes, Eigen::VectorXd& left, const Eigen::VectorXd& linear) const;
    Rest rest_of(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& left, const Eigen::VectorXd& linear) const;
    DecayWave wave_of(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& left) const;

    double level_, begin_ = 0, length_ = 1, turn_ = 0, decay_ = 0;
    std::vector<double> places_, values_;
};

} // namespace graze
