#pragma once

#include "graze/branch/chatter_limit.hpp"
#include "graze/branch/switching.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// From one grazing to the next: the branch that leaves with one more contact is followed until it grazes the same
/// event again, and so on (W. Chin, E. Ott, H. E. Nusse and
/// C. Grebogi, "Grazing bifurcations in impact oscillators", Phys. Rev. E 50, 1994).
///
/// The caller follows the branches: `next` gives the start of one, `take` is told where it has ended; `climb` does both
/// in turn.
class Ladder {
public:
    /// @param grazing at which an arc touches; of a curve of touches any point will do
    /// @param settings of the branches: their parameter and bounds; they stop at grazings whatever is said there
    /// @throws InputError for other points, and for one outside of the bounds
    Ladder(const System& system, const SpecialPoint& grazing, const BranchSettings& settings);

    const BranchSettings& settings() const { return settings_; }
    /// The branch that leaves the last grazing. @return none where there is none, or none has been reached
    std::optional<BranchStart> next();
    /// @param end the special point in which it has ended, if it has ended in one, not after one; @param outcome how it
    /// has ended
    /// @return whether that is the next grazing
    bool take(const std::optional<SpecialPoint>& end, const std::string& outcome);

    /// The first one, and all that have been reached.
    const std::vector<SpecialPoint>& grazings() const { return grazings_; }
    /// Why the ladder ends; empty as long as it does not.
    const std::string& why() const { return why_; }
    /// Where it leads.
    ChatterLimit limit() const;

private:
    std::string beyond_resolution() const;

    System system_;
    BranchSettings settings_;
    std::vector<SpecialPoint> grazings_;
    std::string why_;
};

/// Where a branch that leaves a grazing has ended.
struct RungEnd {
    std::optional<SpecialPoint> point; ///< the special point in which it has ended; none: it has not ended in one
    std::string outcome;               ///< in words
    bool wanted = true;                ///< whether the next branch is to be followed
};
/// Follows a branch that leaves a grazing. @param number of the grazing that it may lead to: 2 for the first branch
/// @return none when interrupted
using RungFollower = std::function<std::optional<RungEnd>(std::size_t number, const BranchStart& start)>;
/// Climbs until the ladder ends or has so many grazings, the first one included.
/// @return false when a branch was interrupted
bool climb(Ladder& ladder, std::size_t grazings, const RungFollower& follow);

/// Climbs a ladder. @param grazings at most, the first one included
/// @param visit called with the number of each rung (2 for the first branch) and its branch; returning false ends it
/// @param interrupted asked after each step; what has been reached by then is returned
Ladder climb(const System& system, const SpecialPoint& grazing, const BranchSettings& settings, std::size_t grazings,
             const std::function<bool(std::size_t rung, const Branch& branch)>& visit = {},
             const std::function<bool()>& interrupted = {});

} // namespace graze
