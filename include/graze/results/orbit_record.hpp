#pragma once

#include "graze/branch/special_point.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Result of the map near a touching orbit; the numbers are named as in the output of `graze grazing`.
struct TouchFindings {
    std::string map;              ///< name of a MapOrder
    std::string verdict;          ///< name of a GrazingOutcome
    std::string reason;           ///< why there is no map, or why the verdict is undecided
    std::size_t next_contact = 0; ///< number of cycles to the next contact; 0: none was found
    std::optional<double> projection, growth, jump_growth, reach, clearance_rate, speed_factor, fold_distance;
    friend bool operator==(const TouchFindings&, const TouchFindings&) = default;
};

/// One orbit computed by a run of kind `orbit` or `continue`: a regular or special point of a branch.
struct OrbitRecord {
    std::size_t number = 0; ///< number of the point in the run
    std::string part;       ///< direction in which the branch was followed, for example "up"
    std::string label;      ///< type and count within the run, for example "GR1"; empty for regular points
    bool stable = false;
    SpecialPoint point; ///< type of the point, and its orbit as the solution
    /// Set if the orbit touches and the run asks for the map there.
    std::optional<TouchFindings> touch = std::nullopt;
};

} // namespace graze
