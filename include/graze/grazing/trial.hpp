#pragma once

#include "graze/grazing/map_motion.hpp"
#include "graze/grazing/verdict.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

struct TrialOptions {
    std::size_t cycles = 400; ///< cycles that are simulated at each distance from the touch; raise it where contacts
                              ///< follow one another rarely
    double tolerance = 1e-14; ///< relative tolerance of the integration, 1e-16 .. 1e-2
    std::function<bool()> interrupted; ///< called at each step; returns true to stop
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

enum class TrialOutcome {
    agreed,       ///< the simulation agrees with the verdict
    contradicted, ///< the simulation contradicts the verdict
    undecided,    ///< double precision does not allow motions near enough to the touch to tell, or the verdict is
                  ///< undecided
};
/// Returns the stable name for tables and files, such as "agreed".
std::string_view name_of(TrialOutcome outcome);

/// One simulated motion just beyond a touch, started on the orbit that would exist without contact.
struct TrialMotion {
    double parameter = 0; ///< value of the parameter
    double clearance = 0; ///< clearance of the orbit without contact: negative
    double predicted = 0; ///< largest approach speed (depth, for a compliant contact) of the motion of the map
    double largest = 0;   ///< largest simulated approach speed or depth
    std::size_t contacts = 0;
    bool ended = false;    ///< the motion ended before the end time, as by snap-through
    bool followed = false; ///< the motion was followed to that end, or for all cycles
};

struct Trial {
    TrialOutcome outcome = TrialOutcome::undecided;
    std::string reason; ///< explanation of the outcome, in one line
    std::vector<TrialMotion> motions;
};

/// Checks a verdict by simulation at several distances beyond the touch. Where an attractor persists, approach speeds
/// must shrink with the square root of the distance, as those of the map do; where it is lost, they must grow at any
/// distance.
/// @param map of the cycle, computed with the parameter that moves the orbit
/// @return undecided if the verdict is, or if the map has no clearance rate
/// @throws InputError if the map does not belong to the system
Trial try_verdict(const System& system, const CycleMap& map, const Verdict& verdict, ParameterId parameter,
                  const TrialOptions& options = {});

/// What the map of a cycle settles on at a distance beyond the touch.
struct MotionBeyond {
    int digits = 0;       ///< the clearance is 10^-digits of the orbit's size
    double parameter = 0; ///< its value there
    MapMotion motion;
};

/// What becomes of an orbit beyond its touch.
struct TouchReport {
    Verdict verdict;
    std::vector<MotionBeyond> beyond; ///< of square_root maps whose attractors persist
    std::optional<Trial> trial;       ///< the verdict, checked by simulation
};

/// @param map of the touch, with respect to the parameter; @param parameter that moves the orbit from the touch; none:
///        nothing is told of the motion beyond it
/// @param verify whether the verdict is checked by simulation; @param options of that
/// @throws InputError where it is to be checked and no parameter is given
TouchReport touch_report(const System& system, const CycleMap& map, std::optional<ParameterId> parameter, bool verify,
                         const TrialOptions& options = {});

} // namespace graze
