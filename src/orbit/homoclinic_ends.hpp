#pragma once

#include "orbit/saddle.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// The ends of a homoclinic orbit. It begins in the linear unstable space of its saddle and ends in the linear stable
/// space (W.-J. Beyn, "The numerical computation of connecting orbits in dynamical systems", IMA J. Numer. Anal. 10,
/// 1990), each at a distance from the saddle that the equations keep: that of the orbit with which they were made. In
/// this way the durations of the first and the last segment are finite and follow from the equations.
class HomoclinicEnds {
public:
    HomoclinicEnds(const System& system, std::size_t mode, std::vector<ParameterId> free)
        : system_(system), mode_(mode), free_(std::move(free)) {}

    /// Keeps the distances of an orbit. @param scales of the states
    void keep_distances(std::span<const double> begin, std::span<const double> end, std::span<const double> parameters,
                        const Eigen::VectorXd& scales);
    /// Moves the saddle to other parameters. @return false, with `problem` set, where it is lost
    bool set_parameters(std::span<const double> parameters);
    const std::string& problem() const { return problem_; }
    /// Requires `keep_distances`, as all functions below.
    const Saddle& saddle() const { return *saddle_; }
    /// The kept distances, in units of the scales.
    double departure() const { return departure_; }
    double approach() const { return approach_; }

    /// A condition on a state, zero where it holds, with its gradient with respect to states and free parameters.
    struct Condition {
        double value = 0;
        Eigen::VectorXd gradient;
    };
    /// The excess of the distance at which the orbit begins, and of that at which it ends.
    Condition departs(std::span<const double> begin) const;
    Condition approaches(std::span<const double> end) const;
    /// The coordinates that vanish at the ends: the stable ones where the orbit begins, then the unstable ones where it
    /// ends.
    struct Projections {
        Eigen::VectorXd values;
        Eigen::MatrixXd by_begin, by_end, by_parameters;
    };
    Projections projections(std::span<const double> begin, std::span<const double> end) const;
    /// True when the spaces have turned so far that distances should be measured anew.
    bool have_turned() const;

private:
    Condition distance(const Eigen::MatrixXd& measured_by, double kept, std::span<const double> state) const;

    System system_;
    std::size_t mode_;
    std::vector<ParameterId> free_;
    std::optional<Saddle> saddle_;
    /// Distances are measured by the coordinates of the first saddle, which do not turn with the parameters.
    Eigen::MatrixXd by_unstable_, by_stable_;
    double departure_ = 0, approach_ = 0;
    std::string problem_;
};

} // namespace graze
