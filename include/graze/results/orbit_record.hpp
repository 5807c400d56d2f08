#pragma once

#include "graze/branch/special_point.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// What the map of the cycle says of an orbit that touches; names as of `graze grazing`.
struct TouchFindings {
    std::string map;              ///< MapOrder
    std::string verdict;          ///< GrazingOutcome
    std::string reason;           ///< why there is no map, or why the verdict is undecided
    std::size_t next_contact = 0; ///< 0: none
    std::optional<double> projection, growth, jump_growth, reach, clearance_rate, speed_factor, fold_distance;
    friend bool operator==(const TouchFindings&, const TouchFindings&) = default;
};

/// One orbit that a run of kind `orbit` or `continue` has computed: a point of a branch, special or not.
struct OrbitRecord {
    std::size_t number = 0; ///< in the run
    std::string part;       ///< of the run: the way in which the branch was followed, such as "up"
    std::string label;      ///< type and count within the run, such as "GR1"; empty for regular points
    bool stable = false;
    SpecialPoint point; ///< its type says whether it is special; its solution has the orbit
    /// Where the run asks for it and the orbit touches.
    std::optional<TouchFindings> touch = std::nullopt;
};

} // namespace graze
