#pragma once

#include "branch/orbit_condition.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "graze/branch/switching.hpp"
#include "orbit/certify.hpp"
#include "orbit/orbit_equations.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace graze {

class BranchState;

/// Whether points of a type are touches, or contacts without speed, on branches or on curves of such.
inline bool is_grazing(PointType type) {
    return type == PointType::grazing || type == PointType::double_grazing;
}

/// A function along a branch whose change of sign means that something happens.
struct BranchTest {
    PointType type = PointType::end;
    std::size_t segment = 0, event = 0;
    double value = 0;    ///< NaN where it has no meaning, as the least value of a gap that only grows
    double noise = 0;    ///< up to which its sign says nothing, since on whole branches it may be zero
    double time = 0;     ///< of an interior minimum
    bool at_end = false; ///< of grazing: the segment's own event
    double rate = 0;     ///< of two_events: of the other event's function
    /// Of bound and crossing: which monitor, and which of its crossings. None for bounds of parameters.
    std::optional<std::size_t> monitor = std::nullopt;
    std::size_t crossing = 0;
    std::optional<std::size_t> free = std::nullopt;      ///< of bound: which of the settings' free bounds
    std::optional<std::size_t> parameter = std::nullopt; ///< of extremum: which that varies; none: the period
    bool singular = false;                               ///< the equations cannot be solved where it is zero
    bool appears = false; ///< it may lose its meaning at a negative value, which has then become one within the step
};

/// A point of a branch as its test functions see it.
struct TestedPoint {
    const OrbitEquations& equations;
    const OrbitEvaluation& at;
    const OrbitSolution& solution;
    std::span<const double> tangent; ///< of the unknowns
    double determinant;              ///< of the equations bordered by the tangent
    std::span<const double> monitors;
    const BranchSettings& settings;
    std::span<const Degeneracy> degeneracies; ///< of the points that a curve keeps
};

/// Whether points of this type are what the branch is a curve of: then the test is zero all along it.
inline bool is_kept(const TestedPoint& point, PointType type) {
    return point.settings.kept && point.settings.kept->type == type;
}
inline bool is_kept(const TestedPoint& point, PointType type, std::size_t segment, std::size_t event) {
    return is_kept(point, type) && point.settings.kept->segment == segment && point.settings.kept->event == event;
}

/// One kind of special points, all that is done for it: what the table has an entry for.
struct PointRule {
    PointKind kind;
    /// Adds its test functions, always as many for one signature. Null: it is not looked for.
    void (*test)(const TestedPoint& point, std::vector<BranchTest>& tests) = nullptr;
    /// Whether a located zero means what its test stands for; puts it into words. Null: if it has been located.
    bool (*confirm)(BranchState& state, SpecialPoint& special, const BranchTest& test) = nullptr;
    /// Of several things at one place, the one that tells most has the lowest rank. Null: it excludes no other.
    int (*rank)(const SpecialPoint& point) = nullptr;
    /// What is zero at it, as a condition that can be held: the same thing in the other role. Null: it has none, as a
    /// branch point, of which any change of the equations leaves nothing; none: not for this point.
    std::unique_ptr<OrbitCondition> (*condition)(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                 const SpecialPoint& point) = nullptr;
    /// Where one can go on from it. Null: nowhere.
    std::vector<BranchStart> (*leave)(const System& system, const SpecialPoint& point,
                                      const BranchSettings& settings) = nullptr;
};

/// All of them, in the order of their types: a new kind of special points is one more entry.
std::span<const PointRule> point_rules();
const PointRule& rule_of(PointType type);

/// To what an orbit is held by a point's condition, of what decides whether it is admissible.
std::optional<HeldLimit> held_limit_of(const SpecialPoint& point);

/// All test functions at a point, always in the same order for one signature.
std::vector<BranchTest> branch_tests(const TestedPoint& point);

} // namespace graze
