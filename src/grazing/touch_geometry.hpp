#pragma once

#include "graze/grazing/discontinuity_map.hpp"
#include "orbit/eigen_index.hpp"

#include <cstddef>

namespace graze {

/// The function of an event and its rates along the flow of a mode at a state, with gradients: states, then parameters.
struct TouchGeometry {
    double value = 0, rate = 0, acceleration = 0;
    Eigen::VectorXd gradient, rate_gradient;
    Eigen::VectorXd field;
};

/// The event function and its rate, compiled for a mode and an event.
class TouchFunctions {
public:
    TouchFunctions(const System& system, std::size_t mode, std::size_t event);

    std::size_t mode() const { return mode_; }
    std::size_t event() const { return event_; }
    const System& system() const { return system_; }
    TouchGeometry at(std::span<const double> state, std::span<const double> parameters) const;

private:
    System system_;
    std::size_t mode_, event_;
    Function rate_; ///< rate of the event function, its gradient, then its own rate
};

/// Decides what counts as zero near a touch. Values and rates are compared with those that follow from the scales of
/// the states and from the time scale sqrt(size / acceleration) of the touched function.
class TouchSizes {
public:
    TouchSizes(const TouchState& touch, const TouchGeometry& geometry);

    bool is_zero(double value, const Eigen::VectorXd& gradient) const;
    bool is_zero_rate(double rate, const Eigen::VectorXd& gradient, const Eigen::VectorXd& field) const;
    /// True when the gain of a function per unit of approach speed is zero. @param gradient of the function
    bool is_zero_gain(double gain, const Eigen::VectorXd& gradient) const;
    /// True when the gain of the states per unit of approach speed is zero.
    bool is_zero_gain(const Eigen::VectorXd& gain) const;
    /// Returns the smallest direction, in scaled states, along which the function grows by 1 and its rate is constant.
    Eigen::VectorXd off_surface(const TouchGeometry& geometry) const;
    const Eigen::VectorXd& scales() const { return scales_; }
    double time() const { return time_; }

private:
    Eigen::VectorXd scales_;
    double time_ = 1, speed_ = 1;
};

} // namespace graze
