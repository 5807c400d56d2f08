#pragma once

#include "graze/symbolic/expression.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// What the motion along a surface is made of, where the fields of both sides push towards it.
enum class SlideConvention {
    filippov, ///< the combination of both fields that is tangent to the surface
    utkin,    ///< the equations with the value of a control at which they are tangent to it
};

/// A declaration: two modes meet at a surface without a jump, and the motion may slide along it. `Model::complete`
/// makes the sliding mode, which has the name of the slide, its events, and all transitions at the surface.
struct Slide {
    std::string name{}, text{};
    std::size_t surface = 0; ///< an event, a barrier; its function is positive in `right`, negative in `left`
    std::size_t left = 0, right = 0;
    SlideConvention convention = SlideConvention::filippov;
    std::string control{}; ///< of Utkin's convention: a name in the rates of both modes, -1 in `left`, 1 in `right`
    /// Events that the sliding mode watches besides those that end it; none: those that both modes watch.
    std::optional<std::vector<std::size_t>> watched{};
};

/// A declaration: dry friction between two bodies. Its name stands in rates of modes for the force against a positive
/// velocity: coefficient * normal where the velocity is positive, -coefficient * normal where it is negative, and what
/// keeps the velocity at zero in between. `Model::complete` replaces each mode with the name by modes for both
/// directions and for rest.
struct Friction {
    std::string name{}, text{};
    Expression velocity{}, normal{}, coefficient{};
    std::optional<Expression> static_coefficient{}; ///< of the greatest force at rest; none: the same
};

/// Of a mode that was made by a declaration: an event whose function is zero all along, and the events that end this.
/// Where both happen at once the continuation is not unique (a two-fold).
struct SlidingSurface {
    std::size_t surface = 0;
    std::array<std::size_t, 2> exits{};
};

} // namespace graze
