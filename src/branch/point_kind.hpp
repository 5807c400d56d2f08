#pragma once

#include "branch/orbit_condition.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "graze/branch/switching.hpp"
#include "graze/grazing/cycle_map.hpp"
#include "orbit/certify.hpp"
#include "orbit/orbit_equations.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace graze {

class BranchState;

/// True for touches and contacts of zero speed, on branches and on curves of touches.
inline bool is_grazing(PointType type) {
    return type == PointType::grazing || type == PointType::double_grazing;
}

/// Returns a point as a grazing at one of the touches of its orbit.
SpecialPoint grazing_at(const SpecialPoint& point, const OrbitTouch& touch);

/// Returns the minimum of an event function in a segment that is nearest to zero; empty if it has none.
std::optional<OrbitMinimum> touch_in(const Certificate& certificate, std::size_t segment, std::size_t event);
/// Returns the minimum of an event function that is nearest to zero, in units of the function's size along its arc;
/// empty if none is nearer than a hundredth.
std::optional<OrbitMinimum> nearest_touch(const Certificate& certificate, std::size_t event);

/// True when the branch is a curve of touches inside arcs.
inline bool keeps_touch(const BranchSettings& settings) {
    return settings.kept && settings.kept->type == PointType::grazing && !settings.kept->at_end;
}

/// True when a monitor refers to the start or end of a segment.
inline bool refer_to_segments(const std::vector<Monitor>& monitors) {
    return std::any_of(monitors.begin(), monitors.end(), [](const Monitor& one) {
        return !one.segment.empty() || one.kind == Monitor::Kind::value || one.kind == Monitor::Kind::start;
    });
}

/// A test function along a branch: a change of its sign indicates a special point.
struct BranchTest {
    PointType type = PointType::end;
    std::size_t segment = 0, event = 0;
    double value = 0;    ///< NaN where it is not defined, as the minimum of a gap that only grows
    double noise = 0;    ///< magnitude up to which its sign is not significant, since it may vanish on whole branches
    double time = 0;     ///< time of an interior minimum
    bool at_end = false; ///< for grazing: the event that ends the segment
    double rate = 0;     ///< for two_events: rate of the other event's function
    /// For bound and crossing: index of the monitor, and of its crossing. Empty for bounds of parameters.
    std::optional<std::size_t> monitor = std::nullopt;
    std::size_t crossing = 0;
    std::optional<std::size_t> free = std::nullopt; ///< for bound: index in BranchSettings::free_bounds
    /// For extremum: index of the varying parameter; empty: the period.
    std::optional<std::size_t> parameter = std::nullopt;
    bool singular = false; ///< the equations are singular at the zero
    bool appears = false;  ///< the value may become undefined while negative; it then counts as a zero within the step
};

/// The data of a branch point that test functions use.
struct TestedPoint {
    const OrbitEquations& equations;
    const OrbitEvaluation& at;
    const OrbitSolution& solution;
    std::span<const double> tangent; ///< tangent of the unknowns
    double determinant;              ///< determinant of the equations bordered by the tangent
    std::span<const double> monitors;
    const BranchSettings& settings;
    std::span<const Degeneracy> degeneracies; ///< degeneracies of the points along a curve
    /// Along a family: gradient of what is conserved, with respect to the unknowns; null: nothing is declared.
    const Eigen::RowVectorXd* rise = nullptr;
};

/// True when the branch is a curve of points of this type, so that the test is zero all along it.
inline bool is_kept(const TestedPoint& point, PointType type) {
    return point.settings.kept && point.settings.kept->type == type;
}
inline bool is_kept(const TestedPoint& point, PointType type, std::size_t segment, std::size_t event) {
    return is_kept(point, type) && point.settings.kept->segment == segment && point.settings.kept->event == event;
}

/// A kind of special points with all its functions: an entry of the table.
struct PointRule {
    // Types of functions.
    using Test = void(const TestedPoint& point, std::vector<BranchTest>& tests);
    using Confirm = bool(BranchState& state, SpecialPoint& special, const BranchTest& test);
    using Rank = int(const SpecialPoint& point);
    using Condition = std::unique_ptr<OrbitCondition>(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                      const SpecialPoint& point);
    using Leave = std::vector<BranchStart>(const System& system, const SpecialPoint& point,
                                           const BranchSettings& settings);

    PointKind kind;
    Test* test = nullptr;       ///< adds its test functions, always the same number for one signature; null: none
    Confirm* confirm = nullptr; ///< confirms a located zero of the test and sets `detail`; null: confirmed if located
    Rank* rank = nullptr;       ///< rank among points at the same place: the lowest is kept; null: it excludes no other
    /// Returns the condition that holds the point along a curve; null where it is not available. Null: there is none,
    /// as for branch points, which disappear under perturbation.
    Condition* condition = nullptr;
    Leave* leave = nullptr; ///< returns the branches that leave the point; null: none
};

/// Returns all rules, in the order of their types: a new kind of special points is one more entry.
std::span<const PointRule> point_rules();
const PointRule& rule_of(PointType type);

/// Returns the constraint by which a point's condition places its orbits at the limit of admissibility; empty if it
/// does not.
std::optional<HeldLimit> held_limit_of(const SpecialPoint& point);
/// The same for the kept point of a curve; empty for branches that are no curves.
inline std::optional<HeldLimit> held_limit_of(const BranchSettings& settings) {
    return settings.kept ? held_limit_of(*settings.kept) : std::nullopt;
}

/// Returns all test functions at a point, always in the same order for one signature.
std::vector<BranchTest> branch_tests(const TestedPoint& point);

} // namespace graze
