#pragma once

#include "graze/model/model.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// A slide at a corner, with the slide along the same surface on the other side of the other surface.
struct CornerSurface {
    std::size_t below = 0, above = 0; ///< slides where the function of the other surface is negative, and positive
};

/// Where the surfaces of four slides between four modes meet: each slide separates two modes on one side of the other
/// surface. Motions may slide along both surfaces.
struct SlideCorner {
    std::string name{}; ///< of the mode that slides along both surfaces
    std::array<CornerSurface, 2> surfaces{};
};

/// Returns the corners of a model's slides at which the motion along both surfaces is unique: the fields of the four
/// modes are f + u g + v h with u, v = -1 or 1, so that all combinations of them that are tangent to both surfaces are
/// equal (V. I. Utkin 1992; A. F. Filippov 1988, section 9). Whether this holds is tried at random states and
/// parameters.
/// @param model before its slides are completed; its graph grows
std::vector<SlideCorner> corners_of(Model& model);

} // namespace graze
