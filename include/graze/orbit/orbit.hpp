#pragma once

#include "graze/flow/system.hpp"
#include "graze/orbit/signature.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// A periodic orbit of a hybrid system, or a candidate for one. Each segment has a start (the state just after the jump
/// before it) and a duration.
struct Orbit {
    Signature signature;
    std::vector<double> parameters;          ///< the independent parameters, in the model's order
    std::vector<std::vector<double>> starts; ///< state in which each segment starts
    std::vector<double> durations;           ///< duration of each segment
    /// Set for a half orbit: index of the model's symmetry that maps the end of the last segment to the start of the
    /// first. The second half of the orbit is the image of the segments.
    std::optional<std::size_t> symmetry;
    /// Set for an orbit that is homoclinic to a cycle, and does not close: number of segments of the cycle, which the
    /// first and the last segments repeat. It begins beside the cycle, leaves it, and comes back beside it.
    std::optional<std::size_t> cycle{};

    std::size_t segments() const { return signature.size(); }
    /// Returns the sum of the durations: the time after which the start, or its image, recurs.
    double return_time() const;
    /// Returns the period: the sum of the durations, doubled for a half orbit.
    double period() const;
};

/// A direction in which an orbit changes, such as the tangent of a branch: derivatives of the orbit's numbers.
struct OrbitDirection {
    std::vector<std::vector<double>> starts; ///< state in which each segment starts
    std::vector<double> durations;           ///< duration of each segment
    std::vector<double> parameters;          ///< of the varying parameters, the branch parameter first

    bool is_empty() const { return starts.empty(); }
    bool operator==(const OrbitDirection&) const = default;
};

/// Returns the whole orbit of a half orbit by appending the images of its segments; other orbits are returned
/// unchanged.
Orbit whole_orbit(const System& system, const Orbit& orbit);

/// Returns the image of a segment under a symmetry: in the image mode, the transition whose event function is the image
/// of the segment's. Event functions are compared by their values at states of the orbit. @throws InputError when no
/// transition is the image
Segment image_of(const System& system, std::size_t symmetry, const Segment& segment, const Orbit& orbit);

/// @throws InputError unless all sizes fit the model, all numbers are finite and the model's graph allows the signature
void validate_orbit(const Model& model, const Orbit& orbit);

} // namespace graze
