#include "sweep/exponent.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace graze {

namespace {

constexpr std::size_t batches = 10;
constexpr std::size_t returns_to_settle = 10;
/// Of a tangent vector that a sticking contact has made vanish.
constexpr double least_growth = -100;

} // namespace

void Exponent::begin(std::span<const double> parameters, std::span<const double> scale, double time) {
    workspace_ = map_->workspace(parameters);
    scale_.assign(scale.begin(), scale.end());
    growth_.clear();
    times_.clear();
    last_time_ = time;
    to_settle_ = returns_to_settle;
    begun_ = true;
    seeds_.assign(map_->states() + parameters.size(), 0);
    for (std::size_t i = 0; i < map_->states(); ++i)
        if (map_->takes_part(i))
            seeds_[i] = scale_[i] / (1.0 + static_cast<double>(i)); // in no special direction
}

void Exponent::seed(Trajectory& trajectory) {
    trajectory.carry_tangents(seeds_, 1);
    length_ = 0;
    for (std::size_t i = 0; i < map_->states(); ++i)
        length_ += std::pow(seeds_[i] / scale_[i], 2);
    length_ = 0.5 * std::log(length_);
    last_time_ = trajectory.time();
}

void Exponent::add_return(Trajectory& trajectory) {
    const double time = trajectory.time() - last_time_;
    last_time_ = trajectory.time();
    Eigen::MatrixXd tangent(static_cast<Eigen::Index>(map_->states()), 1);
    std::copy(trajectory.tangents().begin(), trajectory.tangents().end(), tangent.data());
    if (!trajectory.tangents_valid() || !map_->project(workspace_, trajectory.mode(), trajectory.state(), tangent))
        return seed(trajectory); // no derivatives here: this return does not count
    double square = 0;
    for (std::size_t i = 0; i < map_->states(); ++i)
        if (map_->takes_part(i))
            square += std::pow(tangent(static_cast<Eigen::Index>(i), 0) / scale_[i], 2);
    const double length = std::sqrt(square);
    if (!std::isfinite(length))
        return seed(trajectory);
    if (to_settle_ > 0) {
        --to_settle_; // the vector still turns towards the direction that grows most
    } else {
        growth_.push_back(length > 0 ? std::max(std::log(length) - length_, least_growth) : least_growth);
        times_.push_back(time);
    }
    length_ = std::log(length);
    if (length > 1e-100 && length < 1e100)
        return;
    // Anew in the same direction or, if there is none left, in the first.
    for (std::size_t i = 0; i < map_->states() && length > 0; ++i)
        seeds_[i] = map_->takes_part(i) ? tangent(static_cast<Eigen::Index>(i), 0) / length : 0;
    seed(trajectory);
}

bool Exponent::known() const {
    return begun_ && growth_.size() >= 2 * batches;
}

double Exponent::time_per_return() const {
    return std::accumulate(times_.begin(), times_.end(), 0.0) / static_cast<double>(times_.size());
}

double Exponent::value() const {
    return std::accumulate(growth_.begin(), growth_.end(), 0.0) / std::accumulate(times_.begin(), times_.end(), 0.0);
}

double Exponent::error() const {
    const std::size_t size = growth_.size() / batches;
    const double mean = value();
    double square = 0;
    for (std::size_t b = 0; b < batches; ++b) {
        double growth = 0, time = 0;
        for (std::size_t k = b * size; k < (b + 1) * size; ++k) {
            growth += growth_[k];
            time += times_[k];
        }
        square += std::pow(growth / time - mean, 2);
    }
    return std::sqrt(square / static_cast<double>(batches * (batches - 1)));
}

} // namespace graze
