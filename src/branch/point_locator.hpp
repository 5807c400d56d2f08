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
    /// What was known of earlier points is of no use for other equations.
    void forget() { older_.clear(); }

private:
    void accept_limit(SpecialPoint& special, bool was_admissible) const;
    std::vector<std::pair<TestValue, TestValue>> brackets_of(std::size_t test, double before);
    std::optional<SpecialPoint> locate(std::size_t test, const TestValue& low, const TestValue& high);
    std::optional<SpecialPoint> locate_zero(std::size_t test, const TestValue& begin, const TestValue& end);
    std::optional<SpecialPoint> locate_branch_point(std::size_t test, const TestValue& low, const TestValue& high);
    std::optional<SpecialPoint> special_at(const BranchPoint& there, const BranchTest& here, double size);

    BranchState* state_;
    const BranchPoint* point_;
    const std::vector<BranchTest>* tests_;
    std::vector<BranchTest> older_; ///< at the point before the one from which the step was made
    double older_arclength_ = 0;
};

} // namespace graze
