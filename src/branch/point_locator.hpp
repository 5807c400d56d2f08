#pragma once

#include "branch/branch_state.hpp"
#include "branch/crossing.hpp"
#include "branch/test_history.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace graze {

/// Finds the special points within the last step of a branch.
class PointLocator {
public:
    /// @param here the last point, which the caller updates
    PointLocator(BranchState& state, const DescribedPoint& here) : state_(&state), here_(&here) {}

    /// Returns all special points within the step, in the order of the branch.
    /// @param before the start point of the step
    std::vector<SpecialPoint> locate_all(const DescribedPoint& before);
    /// Adds points at which multipliers cross without a sign change of a test, as two of them within one step.
    /// @param found points of `locate_all`
    void add_missed(std::vector<SpecialPoint>& found, const DescribedPoint& before);
    /// True when the end of the step, or a found point, lies beyond a bound although no point on the bound was found.
    bool misses_bound(const std::vector<SpecialPoint>& found, const DescribedPoint& before) const;
    /// Forgets earlier tests, after a change of the equations.
    void forget() { history_.forget(); }

private:
    using Bracket = std::pair<TestValue, TestValue>;
    std::vector<Bracket> brackets_of(std::size_t test, double before);
    double unknown_values(const BranchTest& test, const TestValue& low, const TestValue& high) const;
    void sample_first_step();
    std::optional<SpecialPoint> locate(std::size_t test, const TestValue& low, const TestValue& high);
    std::vector<SpecialPoint> locate_pair_of_crossings(std::size_t test, const std::vector<Bracket>& brackets);
    std::optional<SpecialPoint> crossing_at(const ContinuationPoint& at, std::size_t test, double first, double last);
    std::optional<SpecialPoint> locate_zero(std::size_t test, const TestValue& begin, const TestValue& end,
                                            bool& complete);
    std::optional<SpecialPoint> locate_by_crossing(std::size_t test, const TestValue& low, const TestValue& high);
    std::optional<SpecialPoint> locate_simpler();
    void add_bounds_before(std::vector<SpecialPoint>& found, const DescribedPoint& before);
    bool is_beyond(const SpecialPoint& special, const std::vector<BranchTest>& tests) const;
    void sort_by_place(std::vector<SpecialPoint>& found) const;
    void note(SpecialPoint& special, const BranchPoint& before, bool singular);
    std::optional<SpecialPoint> special_at(const BranchPoint& there, const BranchTest& here, double size);

    BranchState* state_;
    const DescribedPoint* here_;
    TestHistory history_;
};

} // namespace graze
