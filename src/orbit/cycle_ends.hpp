#pragma once

#include "orbit/end_distances.hpp"
#include "orbit/saddle_cycle.hpp"

#include <optional>

namespace graze {

/// The ends of an orbit that is homoclinic to a saddle cycle. It begins beside the start of the cycle, in the linear
/// unstable space, and comes back beside it in the linear stable space (W.-J. Beyn and J.-M. Kleinkauf, "The numerical
/// computation of homoclinic orbits for maps", SIAM J. Numer. Anal. 34, 1997). These are as many equations as the
/// closure of a periodic orbit, so that such an orbit exists without a condition on parameters, as long as the stable
/// and the unstable manifold of the cycle cross.
///
/// Each turn beside the cycle is a part of the orbit, so that the distances follow from the number of turns.
class CycleEnds {
public:
    /// @param orbit with `cycle` set, which begins and ends with one turn beside the cycle at least
    CycleEnds(const Simulation& simulation, const Orbit& orbit, std::vector<ParameterId> free);

    /// Refers the equations to the present spaces, in these units. @param scales of the states
    void set_scales(const Eigen::VectorXd& scales);
    /// Moves the cycle to other parameters. @return false, with `problem` set, where it is lost
    bool set_parameters(std::span<const double> parameters);
    const std::string& problem() const { return problem_; }
    const SaddleCycle& cycle() const { return cycle_; }

    /// The equations at the ends, in the units of the states: the first n - 1 demand that the orbit begins in the
    /// unstable space, the last one that it ends in the stable one. The spaces turn with the parameters, of which the
    /// derivatives are left out: they act in proportion to the distances, and are below round-off in the orbit.
    struct Equations {
        Eigen::VectorXd values;
        Eigen::MatrixXd by_begin, by_end, by_parameters;
    };
    /// @param period_rates derivatives of the periods of cyclic states, states x free
    Equations equations(std::span<const double> begin, std::span<const double> end,
                        const Eigen::MatrixXd& period_rates) const;
    /// Derivatives of these equations with respect to the last state.
    Eigen::MatrixXd by_end() const;
    /// The distances from the cycle at which an orbit begins and ends.
    EndDistances distances(std::span<const double> begin, std::span<const double> end) const;

private:
    Eigen::MatrixXd by_begin() const;
    void find_cycle(const Simulation& simulation, const Orbit& orbit);

    std::vector<ParameterId> free_;
    SaddleCycle cycle_;
    Eigen::VectorXd reference_; ///< the unstable direction when the units were chosen, of length 1 in them
    Eigen::MatrixXd across_;    ///< orthonormal rows across it
    std::string problem_;
};

/// An orbit with other turns beside its cycle.
struct TurnsChanged {
    Orbit orbit;
    /// Number of segments that were added (positive) or left out at the beginning and at the end.
    std::ptrdiff_t before = 0, after = 0;
    /// Returns the direction of the new orbit: added segments do not change along it.
    OrbitDirection of(OrbitDirection direction) const;
};
/// Returns an orbit that begins and ends so near its cycle that its error by that is round-off, but no nearer: turns
/// beside the cycle are added, to first order, or left out. @param end its last state
TurnsChanged with_suitable_turns(const CycleEnds& ends, const Orbit& orbit, std::span<const double> end);
/// True when turns are missing, or several are superfluous.
bool turns_need_renewal(const CycleEnds& ends, const Orbit& orbit, std::span<const double> end);

} // namespace graze
