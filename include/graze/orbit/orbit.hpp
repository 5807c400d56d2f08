#pragma once

#include "graze/flow/system.hpp"
#include "graze/orbit/signature.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// A periodic orbit of a hybrid system, or a candidate for one: for each segment the state in which it starts (just
/// after the jump before it) and its duration.
struct Orbit {
    Signature signature;
    std::vector<double> parameters;          ///< the independent ones, in the model's order
    std::vector<std::vector<double>> starts; ///< of each segment
    std::vector<double> durations;           ///< of each segment
    /// A symmetry of the model of which the segments are the first half: its image of the last segment's end is the
    /// first segment's start.
    std::optional<std::size_t> symmetry;

    std::size_t segments() const { return signature.size(); }
    /// Sum of the durations: time after which the start, or its image, comes again.
    double round() const;
    /// Time after which everything repeats: twice the sum of durations for a half orbit.
    double period() const;
};

/// A direction in which an orbit changes, as along a branch: what its numbers gain.
struct OrbitDirection {
    std::vector<std::vector<double>> starts; ///< of each segment
    std::vector<double> durations;           ///< of each segment
    std::vector<double> parameters;          ///< of those that vary, the branch's own first

    bool is_empty() const { return starts.empty(); }
    bool operator==(const OrbitDirection&) const = default;
};

/// The whole of an orbit that is given by its half: segments of the second half are images of those of the first.
/// Others are returned as they are.
Orbit whole_orbit(const System& system, const Orbit& orbit);

/// The image of a segment under a symmetry: in the image of its mode, the transition whose event function is the image
/// of its own, which is judged by values at states of the orbit. @throws InputError when there is none
Segment image_of(const System& system, std::size_t symmetry, const Segment& segment, const Orbit& orbit);

/// @throws InputError unless numbers fit the model and are finite, and the signature is possible
void validate_orbit(const Model& model, const Orbit& orbit);

} // namespace graze
