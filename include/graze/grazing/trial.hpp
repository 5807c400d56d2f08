#pragma once

#include "graze/grazing/verdict.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

struct TrialOptions {
    std::size_t cycles = 400; ///< that are simulated at each distance
    double tolerance = 1e-14; ///< of the integration; 1e-16 .. 1e-2
    std::function<bool()> interrupted;
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

enum class TrialOutcome {
    agreed,       ///< what is simulated is what the verdict says
    contradicted, ///< it is something else
    undecided, ///< numbers do not come near enough to the touch for the difference to be seen, or there is no verdict
};
/// Stable name for tables and files, such as "agreed".
std::string_view name_of(TrialOutcome outcome);

/// One motion just beyond a touch, begun on the orbit that would be there without contact.
struct TrialMotion {
    double parameter = 0; ///< its value
    double clearance = 0; ///< of the orbit without contact: negative
    double predicted = 0; ///< greatest approach speed (depth, of a compliant contact) of the map's motion
    double largest = 0;   ///< greatest one that was simulated
    std::size_t contacts = 0;
    bool ended = false;    ///< the motion came to an end of its own, as by snap-through
    bool followed = false; ///< to that end, or for all cycles
};

struct Trial {
    TrialOutcome outcome = TrialOutcome::undecided;
    std::string reason; ///< in one line
    std::vector<TrialMotion> motions;
};

/// Checks a verdict by simulation beside the touch, at several distances. Where an attractor persists, speeds shrink
/// with the root of the distance as those of the map do; where it is lost they grow, however near the touch is.
/// @param map with respect to the parameter that moves the orbit
/// @return undecided without a verdict, or a parameter
/// @throws InputError for a map that does not fit the system
Trial try_verdict(const System& system, const CycleMap& map, const Verdict& verdict, ParameterId parameter,
                  const TrialOptions& options = {});

} // namespace graze
