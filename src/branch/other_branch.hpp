#pragma once

#include "branch/branch_state.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace graze {

/// Returns an orbit traversed twice, for the start of a period-doubled branch.
Orbit twice(const Orbit& orbit);

/// Returns the starts in both directions along the null vector of an orbit's equations that is orthogonal to `along`;
/// without one, at a fixed parameter, since a doubled or asymmetric branch has a parameter extremum there.
/// @param second true if the opposite direction leads to other orbits
/// @throws InputError when no null vector is found
std::vector<BranchStart> along_null_vector(const System& system, Orbit orbit, const BranchSettings& settings,
                                           const OrbitDirection& along, const std::string& how, bool second);

/// Searches for an orbit on another branch through a solution. Newton's method may return to the original branch; then
/// other distances are tried. Where states leave zero that are zero all along the original branch, their size is
/// unknown, so many orders of magnitude are tried, each with its own scales: at first those at which the other states
/// change clearly, then shorter ones, since an orbit may lie beyond a bound.
class OtherBranchSearch {
public:
    /// @param direction of the other branch, in unknowns of the current problem; @param distance of the first point
    OtherBranchSearch(BranchState& state, const Orbit& orbit, std::vector<double> direction, double distance);
    /// Starts the continuation at an orbit on another branch. @return false when all distances have been tried
    bool next();
    /// Returns why none was found; empty where Newton's method has not converged.
    std::string why() const;

private:
    bool reaches_other(const std::vector<double>& direction, double distance);
    bool bends_back(const std::vector<double>& direction, double distance);
    double change_of_others() const;
    double size_of(const Eigen::VectorXd& change) const;

    BranchState& state_;
    std::vector<double> u_, direction_;
    double distance_, length_; ///< length of the direction
    Eigen::VectorXd sized_;    ///< 1 for unknowns whose scales are their own size, 0 for others
    OrbitScales scales_;       ///< before the search
    bool was_simpler_, leaves_zero_ = false, came_back_ = false;
    int tried_ = 0;
};

} // namespace graze
