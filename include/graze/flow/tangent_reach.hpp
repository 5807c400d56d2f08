#pragma once

#include "graze/tape/jet.hpp"

#include <cstddef>
#include <functional>
#include <span>

namespace graze {

/// Sizes below which derivatives need not be known, [state * width + lane]: asked for only where the derivatives' own
/// sizes are too small a measure.
using TangentFloors = std::function<std::span<const double>()>;

/// How differences between slopes of derivatives' polynomials and the variational equations are judged.
struct TangentCheck {
    /// Of rates, which is allowed in any case.
    static constexpr double round_off = 1e4 * 0x1p-53;
    /// What is left out falls with a high power of the step. What does not is the round-off of derivatives that have
    /// only begun to differ from zero: no shorter step would be better. So many halvings have to gain so much.
    static constexpr int most_halvings = 8;
    static constexpr double least_gain = 0.1;
};

/// How far the series of derivatives in a tangent jet may be followed: the last two terms of each must stay below a
/// tolerance relative to its first three, as for the states themselves. A motion may be much slower than what
/// disturbs it, such as an oscillation that follows a slow force: then steps that are right for the states are too
/// long for their derivatives.
/// @param states whose derivatives count; @param count lanes that are in use, after the first
/// @param tolerance of the derivatives: the last two terms are some orders of magnitude larger than what is cut off
/// @return the step itself, or less
double tangent_reach(const Jet& jet, std::size_t states, std::size_t count, double tolerance, double step,
                     const TangentFloors& floors = {});

/// Follows the series of a tangent jet for a step, or for a part of it over which the derivatives' polynomials are what
/// the variational equations say at the end, as StepCheck asks of states.
/// @param next jet of the same tape, lanes and parameters, which is begun at the end; @param times, sums, slopes room
/// to work in, as `Jet::evaluate_states` needs it; sums are those at the end
/// @param tolerance that derivatives are allowed; @param noise by how much round-off may change rates, asked for only
/// where they differ from slopes, as floors are; @param seen whether sums, slopes and `next` are those at the end
/// already
/// @return the step, or the part
double follow_tangents(const Jet& jet, Jet& next, std::size_t states, std::size_t count, double tolerance, double step,
                       std::span<double> times, std::span<double> sums, std::span<double> slopes,
                       const TangentFloors& floors = {}, const TangentFloors& noise = {}, bool seen = false);

} // namespace graze
