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

/// A harmonic of the circle of a torus, of one state: even * cos(2 pi harmonic turns) + odd * sin(2 pi harmonic turns).
struct CircleTerm {
    std::size_t harmonic = 0; ///< 0: the mean
    std::size_t state = 0;
    double even = 0, odd = 0;
    friend bool operator==(const CircleTerm&, const CircleTerm&) = default;
};

/// A torus computed by a run of kind `torus`; see Torus and TorusFacts.
struct TorusRecord {
    double rotation = 0;       ///< rotation number, in turns per return
    std::size_t harmonics = 0; ///< of its series
    double tail = 0;           ///< share of the last harmonics
    double growth = 0;         ///< mean factor per return of the slowest deviation from the torus
    std::vector<CircleTerm> circle;
    friend bool operator==(const TorusRecord&, const TorusRecord&) = default;
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
    /// Set for a torus; the orbit is then one return of a motion on it, which does not close.
    std::optional<TorusRecord> torus = std::nullopt;
};

} // namespace graze
