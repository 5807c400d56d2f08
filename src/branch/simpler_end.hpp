#pragma once

#include "branch/branch_state.hpp"

#include <optional>
#include <vector>

namespace graze {

/// Watches how a curve of doubled orbits, or of asymmetric ones, comes to simpler orbits. Its equations are singular
/// there, so that steps may fail just before.
class SimplerEnd {
public:
    /// Takes the current point of the curve into account.
    void note(BranchState& state);
    /// Whether the curve has all but met simpler orbits.
    bool is_beside() const;
    /// The simpler orbit: halves of orbits differ by the square root of the distance from it, to which their mean and
    /// the parameters are extrapolated. Of doubled orbits only; others are returned as they are.
    Orbit estimate(const Orbit& orbit) const;

private:
    struct Place {
        Orbit mean;        ///< both halves are the mean of the halves
        double square = 0; ///< of the difference of the halves, in units of the greatest on the curve
    };

    std::vector<double> widest_; ///< greatest difference of the halves on the curve, for each of its numbers
    std::optional<Place> here_;  ///< the current one
    std::vector<Place> places_;  ///< some before it, each nearer to the end
};

} // namespace graze
