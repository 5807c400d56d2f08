#pragma once

#include "graze/branch/ladder.hpp"
#include "graze/results/stored_orbit.hpp"
#include "graze/results/table.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A ladder that begins at a point of a result file, and how far it is climbed.
struct LadderRequest {
    std::string point;        ///< a grazing as users name it, such as "chain:GR1"
    std::string parameter{};  ///< that is followed; empty: the one that the point's run follows
    std::size_t grazings = 8; ///< at most, the first one included
    Place point_place{"point", 0, 0}, parameter_place{"parameter", 0, 0}; ///< for messages
    std::function<void(std::size_t grazing)> progress{}; ///< called with the number of the grazing that is being sought
    std::function<bool()> interrupted{};                 ///< asked after each step
};

/// A ladder of grazings, with what is found between them.
struct StoredLadder {
    /// The first fold and the first flip of the branch that leaves a grazing: values of the parameter.
    struct Leaving {
        std::optional<double> fold, flip;
    };
    StoredOrbit first;     ///< the grazing at which it begins
    ParameterId parameter; ///< that is followed
    Ladder ladder;
    std::vector<Leaving> leaving; ///< of each branch that was followed
    ChatterLimit limit;           ///< where the ladder leads
    bool interrupted = false;     ///< the ladder then has the grazings that were reached, and no limit
};

/// Climbs a ladder with the settings of the run that has its first grazing, as a run of kind ladder does.
/// @throws InputError when there is no such point or parameter, and as Ladder does
StoredLadder stored_ladder(const ResultFile& file, const LadderRequest& request);

/// A row for each grazing: its number, the value of the parameter, the ratio `lambda` of successive distances, and the
/// first flip and fold of the branch that leaves it.
Table ladder_table(const StoredLadder& ladder);

} // namespace graze
