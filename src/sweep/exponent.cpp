#include "sweep/exponent.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace graze {

namespace {

constexpr std::size_t batches = 10;
constexpr std::size_t returns_to_settle = 10;
constexpr double most_lost = 0.05;        ///< allowed share of returns without derivatives
constexpr double student = 2.26;          ///< 95 % quantile of Student's distribution with nine degrees of freedom
constexpr double clear_of_zero = 3;       ///< standard errors
constexpr double integration_errors = 10; ///< error of the growth over a return, in tolerances
/// Logarithm of the length of a tangent vector that has vanished at a sticking contact.
constexpr double least_growth = -100;
/// Bounds of the tangent vector's length before it is rescaled: far from overflow and underflow.
constexpr double shortest_tangent = 1e-100, longest_tangent = 1e100;

} // namespace

void Exponent::begin(std::span<const double> parameters, std::span<const double> scale, double time, bool sticks) {
    carried_ = !derivatives_ || sticks;
    workspace_ = map_->workspace(parameters);
    parameters_.assign(parameters.begin(), parameters.end());
    scale_.assign(scale.begin(), scale.end());
    growth_.clear();
    times_.clear();
    lost_ = 0;
    grown_ = most_grown_ = 0;
    last_time_ = time;
    to_settle_ = returns_to_settle;
    begun_ = true;
    seeds_.assign(map_->states() + parameters.size(), 0);
    for (std::size_t i = 0; i < map_->states(); ++i)
        if (map_->takes_part(i))
            seeds_[i] = scale_[i] / (1.0 + static_cast<double>(i)); // a generic direction
}

void Exponent::seed(Trajectory& trajectory) {
    if (!carried_)
        derivatives_->begin(parameters_, scale_, seed_column(), [this](const MotionDerivatives::Mark& mark) {
            if (!add(mark, derivatives_->derivatives(), derivatives_->valid()))
                derivatives_->set(seed_column());
        });
    else
        trajectory.carry_tangents(seeds_, 1);
    seed_here();
    last_time_ = trajectory.time();
}

/// Starts the vector at the seeds.
void Exponent::seed_here() {
    length_ = 0;
    for (std::size_t i = 0; i < map_->states(); ++i)
        length_ += std::pow(seeds_[i] / scale_[i], 2);
    length_ = 0.5 * std::log(length_);
}

Eigen::MatrixXd Exponent::seed_column() const {
    return Eigen::Map<const Eigen::VectorXd>(seeds_.data(), static_cast<Eigen::Index>(map_->states()));
}

Eigen::MatrixXd Exponent::carried(const Trajectory& trajectory) const {
    Eigen::MatrixXd tangent(static_cast<Eigen::Index>(map_->states()), 1);
    std::ranges::copy(trajectory.tangents(), tangent.data());
    return tangent;
}

void Exponent::add_return(Trajectory& trajectory) {
    if (!carried_)
        return;
    if (!add({trajectory.time(), trajectory.mode(), trajectory.state()}, carried(trajectory),
             trajectory.tangents_valid()))
        trajectory.carry_tangents(seeds_, 1);
}

bool Exponent::vanishes(const Trajectory& trajectory) {
    constexpr double round_off = 1e-11; ///< relative to the vector's length at the last return
    if (!carried_ || !trajectory.tangents_valid())
        return false;
    Eigen::MatrixXd tangent = carried(trajectory);
    if (!map_->project(workspace_, trajectory.mode(), trajectory.state(), tangent))
        return false;
    const double length = length_of(tangent);
    return !(length > 0) || std::log(length) - length_ < std::log(round_off);
}

void Exponent::catch_up() {
    if (begun_ && !carried_)
        derivatives_->carry();
}

/// @return false if the vector must be restarted from the seeds
bool Exponent::add(const MotionDerivatives::Mark& here, Eigen::MatrixXd tangent, bool valid) {
    const double time = here.time - last_time_;
    last_time_ = here.time;
    const auto anew = [this] {
        seed_here();
        return false;
    };
    const auto lose = [&] {
        ++lost_;
        return anew(); // no derivatives: this return is not counted
    };
    if (!valid || !map_->project(workspace_, here.mode, here.state, tangent))
        return lose();
    const double length = length_of(tangent);
    if (!std::isfinite(length))
        return lose();
    const double growth = length > 0 ? std::max(std::log(length) - length_, least_growth) : least_growth;
    most_grown_ = std::max(most_grown_, grown_ += growth);
    if (to_settle_ > 0) {
        --to_settle_; // the vector still turns towards the fastest growing direction
    } else {
        growth_.push_back(growth);
        times_.push_back(time);
    }
    length_ = std::log(length);
    if (length > shortest_tangent && length < longest_tangent)
        return true;
    // Restart in the same direction or, if the vector has vanished, in the initial one.
    if (length > 0)
        aim(tangent / length);
    return anew();
}

double Exponent::length_of(const Eigen::MatrixXd& tangent) const {
    double square = 0;
    for (std::size_t i = 0; i < map_->states(); ++i)
        if (map_->takes_part(i))
            square += std::pow(tangent(static_cast<Eigen::Index>(i), 0) / scale_[i], 2);
    return std::sqrt(square);
}

/// Sets the seeds to this direction.
void Exponent::aim(const Eigen::MatrixXd& direction) {
    for (std::size_t i = 0; i < map_->states(); ++i)
        seeds_[i] = map_->takes_part(i) ? direction(static_cast<Eigen::Index>(i), 0) : 0;
}

bool Exponent::known() const {
    // Returns without derivatives are those where neighbours separate most: the others alone would be biased.
    return begun_ && growth_.size() >= 2 * batches &&
           static_cast<double>(lost_) <= most_lost * static_cast<double>(growth_.size());
}

Eigen::VectorXd Exponent::vector(const Trajectory& trajectory) const {
    if (!carried_)
        return derivatives_->derivatives().col(0);
    const auto size = static_cast<Eigen::Index>(map_->states());
    return Eigen::Map<const Eigen::VectorXd>(trajectory.tangents().data(), size);
}

double Exponent::time() const {
    return std::accumulate(times_.begin(), times_.end(), 0.0);
}

double Exponent::time_per_return() const {
    return time() / static_cast<double>(times_.size());
}

double Exponent::value() const {
    return std::accumulate(growth_.begin(), growth_.end(), 0.0) / time();
}

double Exponent::value_over_last(double share) const {
    const auto count = static_cast<double>(growth_.size());
    return growth(growth_.size() - static_cast<std::size_t>(share * count), growth_.size());
}

bool Exponent::is_positive() const {
    return value() > error() && value() > clear_of_zero * standard_error();
}

double Exponent::growth(std::size_t first, std::size_t last) const {
    double growth = 0, time = 0;
    for (std::size_t k = first; k < last; ++k) {
        growth += growth_[k];
        time += times_[k];
    }
    return growth / time;
}

double Exponent::standard_error() const {
    const std::size_t size = growth_.size() / batches;
    const double mean = value();
    double square = 0;
    for (std::size_t b = 0; b < batches; ++b)
        square += std::pow(growth(b * size, (b + 1) * size) - mean, 2);
    return std::sqrt(square / static_cast<double>(batches * (batches - 1)));
}

double Exponent::variation(std::size_t first, std::size_t last) const {
    const double mean = growth(first, last);
    double sum = 0, least = 0, greatest = 0;
    for (std::size_t k = first; k < last; ++k) {
        sum += growth_[k] - mean * times_[k];
        least = std::min(least, sum);
        greatest = std::max(greatest, sum);
    }
    return greatest - least;
}

bool Exponent::is_bounded() const {
    constexpr double not_more = 1.3; ///< factor over either half; growth like the square root of time would give 1.4
    const std::size_t count = growth_.size(), half = count / 2;
    return variation() <= not_more * std::max(variation(0, half), variation(half, count));
}

double Exponent::error() const {
    const std::size_t count = growth_.size(), half = count / 2;
    const double all = time();
    // Random error: the mean of ten batches has Student's distribution.
    const double random = student * standard_error();
    // Error that decreases like 1/time, since the vector's length varies between bounds.
    const double bounded = variation() / all;
    // Error that decreases more slowly, for example where neighbours separate in proportion to time.
    const double drifting = std::abs(growth(0, half) - growth(half, count));
    const double integration =
        map_->simulation().options().tolerance * integration_errors * static_cast<double>(count) / all;
    return std::max({random, bounded, drifting}) + integration;
}

} // namespace graze
