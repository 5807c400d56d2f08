#pragma once

#include "graze/branch/chatter_limit.hpp"
#include "graze/branch/switching.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A ladder of grazings: from a grazing the branch with one more contact is followed until it grazes the same event
/// again, and so on (W. Chin, E. Ott, H. E. Nusse and C. Grebogi, "Grazing bifurcations in impact oscillators", Phys.
/// Rev. E 50, 1994).
///
/// The caller follows the branches: `next` gives the start of one, `take` is told where it has ended; `climb` does both
/// in turn.
class Ladder {
public:
    /// @param grazing a grazing inside an arc, or any point of a curve of grazings
    /// @param settings of the branches: their parameter and bounds; `stop_at` is replaced by grazing
    /// @throws InputError for other points, and for a point outside the bounds
    Ladder(const System& system, const SpecialPoint& grazing, const BranchSettings& settings);

    const BranchSettings& settings() const { return settings_; }
    /// Returns the start of the branch that leaves the last grazing; empty when no branch leaves it or the ladder has
    /// ended.
    std::optional<BranchStart> next();
    /// @param end the special point in which the branch ended, if it ended in one; @param outcome how it ended, in
    /// words
    /// @return true if that point is the next grazing
    bool take(const std::optional<SpecialPoint>& end, const std::string& outcome);

    /// The first grazing and all that have been reached.
    const std::vector<SpecialPoint>& grazings() const { return grazings_; }
    /// Why the ladder has ended; empty while it continues.
    const std::string& why() const { return why_; }
    /// Computes the onset of chatter to which the ladder leads.
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

/// Climbs a ladder. @param grazings largest number of grazings, including the first
/// @param visit called with the number of each grazing reached (2 for the first branch) and its branch; returns false
/// to stop
/// @param interrupted called after each step, returns true to stop; the ladder up to then is returned
Ladder climb(const System& system, const SpecialPoint& grazing, const BranchSettings& settings, std::size_t grazings,
             const std::function<bool(std::size_t rung, const Branch& branch)>& visit = {},
             const std::function<bool()>& interrupted = {});

} // namespace graze
