#pragma once

#include "graze/trajectory/trajectory.hpp"
#include "sweep/motion_derivatives.hpp"
#include "sweep/section_map.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// The largest Lyapunov exponent from the growth of one tangent vector, from return to return of a section (Benettin
/// et al. 1980), saltation included.
class Exponent {
public:
    /// @param derivatives to follow the motion with; null: its trajectory is to carry the vector
    Exponent(const SectionMap& map, MotionDerivatives* derivatives) : map_(&map), derivatives_(derivatives) {}

    /// @param scale of each state, in which lengths are measured from now on
    /// @param sticks whether contacts are likely to accumulate
    void begin(std::span<const double> parameters, std::span<const double> scale, double time, bool sticks);
    bool begun() const { return begun_; }
    /// Makes a trajectory carry the vector: after `begin`, and after the trajectory has been started anew. Or what
    /// follows it begins here.
    void seed(Trajectory& trajectory);
    /// What is to be told of all that happens to the motion; null if its trajectory carries the vector.
    MotionDerivatives* follower() { return carried_ ? nullptr : derivatives_; }
    /// Takes the growth since the last return from a trajectory that stopped at one, if that carries the vector.
    void add_return(Trajectory& trajectory);
    /// Whether all that has happened since the last return has made the vector vanish, but for round-off: all
    /// neighbours are one there. To be asked before `add_return`.
    bool vanishes(const Trajectory& trajectory);
    /// Logarithm of the greatest length that the vector has had since it began, in units of that at the beginning.
    double most_grown() const { return most_grown_; }
    /// Takes the growth over all returns that have been seen of a motion that is followed.
    void catch_up();

    std::size_t returns() const { return growth_.size(); }
    bool known() const;
    double value() const; ///< per unit of time
    /// Over this share of the returns, the last.
    double value_over_last(double share) const;
    /// Whether it is positive beyond its error and beyond what is random.
    bool is_positive() const;
    /// Within which it lies in 19 of 20 cases: by means over batches, and by what is systematic.
    double error() const;
    double standard_error() const; ///< by means over batches alone
    /// Whether the vector's length varies between bounds, as on a torus: along a chaotic motion its variation grows
    /// like the root of time.
    bool is_bounded() const;
    /// By how much the logarithm of the vector's length departs from a steady growth.
    double variation() const { return variation(0, growth_.size()); }
    /// The tangent vector where it has been carried to. @param trajectory which may carry it
    Eigen::VectorXd vector(const Trajectory& trajectory) const;
    double time() const; ///< over which it is averaged
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
    bool carried_ = false; ///< by the trajectory
};

} // namespace graze
