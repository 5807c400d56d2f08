#pragma once

#include "branch/branch_state.hpp"
#include "branch/crossing.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace graze {

/// Finds what happens within the last step of a branch.
class PointLocator {
public:
    /// @param tests at the last point
    PointLocator(BranchState& state, const BranchPoint& point, const std::vector<BranchTest>& tests)
        : state_(&state), point_(&point), tests_(&tests) {}

    /// All special points within the step, in their order.
    /// @param before the point from which the step was made; @param tests those there
    std::vector<SpecialPoint> locate_all(const BranchPoint& before, const std::vector<BranchTest>& tests);
    /// Adds points where multipliers cross that no test has told of, as two of them that cross within the step.
    /// @param found those of `locate_all`
    void add_missed(std::vector<SpecialPoint>& found, const BranchPoint& before, const std::vector<BranchTest>& tests);
    /// Whether the last step has gone beyond a bound although no point on it was found: by its end, or by one of those
    /// that were found. @param tests at the point from which the step was made
    bool misses_bound(const std::vector<SpecialPoint>& found, const std::vector<BranchTest>& tests) const;
    /// What was known of earlier points is of no use for other equations.
    void forget() { older_.clear(); }

private:
    void accept_limit(SpecialPoint& special, bool was_admissible) const;
    std::vector<std::pair<TestValue, TestValue>> brackets_of(std::size_t test, double before);
    std::optional<SpecialPoint> locate(std::size_t test, const TestValue& low, const TestValue& high);
    std::optional<SpecialPoint> locate_zero(std::size_t test, const TestValue& begin, const TestValue& end,
                                            bool& complete);
    std::optional<SpecialPoint> locate_by_crossing(std::size_t test, const TestValue& low, const TestValue& high);
    void add_bounds_before(std::vector<SpecialPoint>& found, const std::vector<BranchTest>& tests);
    bool is_beyond(const SpecialPoint& special, const std::vector<BranchTest>& tests) const;
    void sort_by_place(std::vector<SpecialPoint>& found) const;
    void note(SpecialPoint& special, const BranchPoint& before, bool singular);
    std::optional<SpecialPoint> special_at(const BranchPoint& there, const BranchTest& here, double size);

    BranchState* state_;
    const BranchPoint* point_;
    const std::vector<BranchTest>* tests_;
    std::vector<BranchTest> older_; ///< at the point before the one from which the step was made
    double older_arclength_ = 0;
};

} // namespace graze
