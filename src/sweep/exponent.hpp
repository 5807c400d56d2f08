#pragma once

#include "sweep/motion_derivatives.hpp"
#include "sweep/section_map.hpp"

namespace graze {

/// The largest Lyapunov exponent from the growth of one tangent vector from return to return of a section (Benettin et
/// al. 1980), with saltation at contacts.
class Exponent {
public:
    /// @param derivatives that follow the motion; null: the trajectory itself propagates the vector
    Exponent(const SectionMap& map, MotionDerivatives* derivatives) : map_(&map), derivatives_(derivatives) {}

    /// @param scale unit of each state for lengths of the vector
    /// @param sticks whether contacts are likely to accumulate
    void begin(std::span<const double> parameters, std::span<const double> scale, double time, bool sticks);
    bool begun() const { return begun_; }
    /// Starts the vector at the present state; to be called after `begin`, and after the trajectory has been restarted.
    /// Either the trajectory propagates it, or the derivatives that follow the motion.
    void seed(Trajectory& trajectory);
    /// Returns the derivatives that must observe the motion; null if its trajectory propagates the vector.
    MotionDerivatives* external_derivatives() { return carried_ ? nullptr : derivatives_; }
    /// Records the growth since the last return from a trajectory that stopped at one, if it propagates the vector.
    void add_return(Trajectory& trajectory);
    /// Returns whether the vector has vanished (up to round-off) since the last return: all neighbouring motions have
    /// merged. To be called before `add_return`.
    bool vanishes(const Trajectory& trajectory);
    /// Returns the logarithm of the greatest length of the vector since it began, relative to its initial length.
    double most_grown() const { return most_grown_; }
    /// Records the growth over all observed returns, if derivatives follow the motion.
    void catch_up();

    std::size_t returns() const { return growth_.size(); }
    bool known() const;
    double value() const; ///< per unit of time
    /// Returns the exponent over this share of the returns, the last ones.
    double value_over_last(double share) const;
    /// Returns whether the exponent is positive beyond its error and beyond random fluctuation.
    bool is_positive() const;
    /// Returns the half width of the 95 % confidence interval: from means over batches, and from systematic errors.
    double error() const;
    double standard_error() const; ///< from means over batches only
    /// Returns whether the length of the vector varies between bounds, as on a torus; along a chaotic motion its
    /// variation grows like the square root of time.
    bool is_bounded() const;
    /// Returns the deviation of the logarithm of the vector's length from steady growth.
    double variation() const { return variation(0, growth_.size()); }
    /// Returns the tangent vector at its present place. @param trajectory the one that may propagate it
    Eigen::VectorXd vector(const Trajectory& trajectory) const;
    double time() const; ///< time over which the exponent is averaged
    double time_per_return() const;
    void clear() { begun_ = false; }

private:
    bool add(const MotionDerivatives::Mark& here, Eigen::MatrixXd tangent, bool valid);
    Eigen::MatrixXd carried(const Trajectory& trajectory) const;
    void seed_here();
    void aim(const Eigen::MatrixXd& direction);
    double length_of(const Eigen::MatrixXd& tangent) const;
    Eigen::MatrixXd seed_column() const;
    double growth(std::size_t first, std::size_t last) const;
    double variation(std::size_t first, std::size_t last) const;

    const SectionMap* map_;
    MotionDerivatives* derivatives_;
    SectionMap::Workspace workspace_;
    std::vector<double> parameters_, scale_, growth_, times_, seeds_;
    double length_ = 0, last_time_ = 0, grown_ = 0, most_grown_ = 0;
    std::size_t to_settle_ = 0, lost_ = 0;
    bool begun_ = false;
    bool carried_ = false; ///< the vector is propagated by the trajectory
};

} // namespace graze
