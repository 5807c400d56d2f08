#pragma once

#include "graze/branch/orbit_branch.hpp"
#include "graze/branch/torus.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// How finely tori are resolved.
struct TorusResolution {
    static constexpr std::size_t fewest_harmonics = 3, most_harmonics = 512;
    static constexpr double least_tail = 1e-14, largest_tail = 1e-2;
    std::size_t harmonics = 64; ///< largest number of harmonics; the work grows with its third power
    double tail = 1e-9;         ///< largest share of the last harmonics, beyond which more are taken
    /// @throws InputError naming the number that is out of range
    void validate() const;
};

/// Phase locking: where the rotation number of tori passes p/q there are, in an interval of the parameter, a stable and
/// an unstable orbit of q returns (or several), and no quasi-periodic motion. The interval ends at their folds.
struct PhaseLocking {
    enum class Width {
        located, ///< both ends are known
        bounded, ///< the interval is narrower than the accuracy of orbits shows
        one_end, ///< an end was found, and the other not; `problem` says why
        unknown, ///< nothing was found; `problem` says why
    };
    Resonance resonance;
    Width known = Width::unknown;
    double parameter = 0; ///< within the interval
    double width = 0;     ///< of the interval; where it is bounded, the bound
    /// The folds, of type `locking`, in the order of the branch.
    std::vector<SpecialPoint> ends;
    std::string problem;
};

/// A computed torus of a branch.
struct TorusPoint {
    Torus torus;
    TorusFacts facts;
    Orbit motion; ///< one return from the angle 0, which does not close
    double parameter = 0, arclength = 0;
    bool stable = false;
    std::size_t step = 0, iterations = 0;
    std::vector<double> monitors; ///< extremes over the whole torus
    /// Resonances between the torus before and this one, in the order of the branch.
    std::vector<PhaseLocking> passed;
};

/// Why a branch of tori has ended, or that it has not.
enum class TorusOutcome {
    going,          ///< it has not ended
    no_start,       ///< no first torus was found
    steps,          ///< the largest number of steps has been made
    bound,          ///< a bound of the parameter has been reached
    unphysical,     ///< beyond, the model would not make the same segments from all angles: the torus grazes
    not_resolved,   ///< more harmonics are needed than are allowed: the torus is about to break down, or locks
    no_convergence, ///< the step has become too small
    undefined,      ///< the motion cannot be followed to its return
};
std::string_view name_of(TorusOutcome outcome);

/// Follows the tori that begin at a torus point (NS) of a branch of orbits, in one parameter: an iterator that can be
/// stopped after any step. The circle of each torus is a Fourier series that satisfies its equation at as many angles
/// as there are terms (E. Castella and A. Jorba, Celest. Mech. Dyn. Astron. 76, 2000; F. Schilder, H. M. Osinga and W.
/// Vogt, SIAM J. Appl. Dyn. Syst. 4, 2005). The return makes the segments of the orbit, with derivatives through its
/// contacts. Intervals in which tori lock are found where rotation numbers with denominators up to Resonance::largest
/// are passed; the branch goes on beyond those that it cannot step over.
class TorusBranch {
public:
    /// @param point of type `torus` @param settings of which the parameter, its bounds, the number of steps, the steps
    /// of the continuation, the tolerances of orbits and monitors of the kinds maximum and minimum are used
    /// @throws InputError for other points and settings, and for orbits that contain complete chatter
    TorusBranch(const System& system, const SpecialPoint& point, const BranchSettings& settings,
                const TorusResolution& resolution = {});
    ~TorusBranch();
    TorusBranch(TorusBranch&&) noexcept;

    /// Computes the first torus, a small one. @return false when none is found; detail() says why
    bool start();
    /// @return false when the branch has ended. At a bound, and where the torus grazes, the last torus is there.
    bool step();
    const TorusPoint& point() const;
    /// Where the branch has ended in a locking, or has not been able to begin beside one: that locking.
    const std::vector<PhaseLocking>& last_locking() const;
    TorusOutcome outcome() const;
    const std::string& detail() const;

private:
    class Follower;
    std::unique_ptr<Follower> follower_;
};

} // namespace graze
