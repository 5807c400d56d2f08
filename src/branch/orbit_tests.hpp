#pragma once

#include "graze/branch/orbit_branch.hpp"
#include "orbit/orbit_equations.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// A function along a branch whose change of sign means that something happens.
struct BranchTest {
    PointType type = PointType::end;
    std::size_t segment = 0, event = 0;
    double value = 0;    ///< NaN where it has no meaning, as the least value of a gap that only grows
    double time = 0;     ///< of an interior minimum
    bool at_end = false; ///< of grazing: the segment's own event
    double rate = 0;     ///< of two_events: of the other event's function
    /// Of bound and crossing: which monitor, and which of its crossings. None for bounds of the parameter.
    std::optional<std::size_t> monitor;
    std::size_t crossing = 0;
    bool singular = false; ///< the equations cannot be solved where it is zero
    double noise = 0;      ///< up to which its sign says nothing, since on whole branches it may be zero
};

/// All of them at a point, always in the same order for one signature.
/// @param tangent, determinant of the branch there
/// @param monitors their values there
std::vector<BranchTest> branch_tests(const OrbitEquations& equations, const OrbitEvaluation& at,
                                     const OrbitSolution& solution, const std::vector<double>& tangent,
                                     double determinant, const std::vector<double>& monitors,
                                     const BranchSettings& settings);

} // namespace graze
