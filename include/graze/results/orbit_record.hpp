#pragma once

#include "graze/branch/special_point.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// One orbit that a run of kind `orbit` or `continue` has computed: a point of a branch, special or not.
struct OrbitRecord {
    std::size_t number = 0; ///< in the run
    std::string part;       ///< of the run: the way in which the branch was followed, such as "up"
    std::string label;      ///< type and count within the run, such as "GR1"; empty for regular points
    bool stable = false;
    SpecialPoint point; ///< its type says whether it is special; its solution has the orbit
};

} // namespace graze
