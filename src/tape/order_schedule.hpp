#pragma once

#include "tape/step_finder.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Steps that are computed together: one with a kernel, and those without a kernel behind it.
struct ScheduledUnit {
    std::size_t first, end; ///< indices of steps
    int lag;                ///< number of orders by which the unit is behind those of lag 0
};

/// Finds the sequence in which the steps of all orders take the least time (software pipelining). Each step waits for
/// others of the same order, and a processor looks only a few hundred instructions ahead: in the sequence order by
/// order it would find nothing to do but the longest chain of one order. Here, chains of several orders run side by
/// side. Coefficients are the same to the last bit.
/// @param steps those of order 2, in a sequence in which each finds its operands
/// @param is_state whether a step computes a state, from its rate at the order before
/// @return the units in the sequence in which each round computes them; empty where the sequence is best as it is
std::vector<ScheduledUnit> schedule_of(std::span<const KernelStep> steps, const std::vector<bool>& is_state);

} // namespace graze
