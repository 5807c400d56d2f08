#pragma once

#include "branch/equilibrium_tests.hpp"
#include "branch/test_history.hpp"
#include "graze/branch/continuation.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace graze {

/// Locates the special points of a branch of equilibria within the last step of its continuation.
class EquilibriumLocator {
public:
    EquilibriumLocator(const EquilibriumPath& path, Continuation& continuation)
        : path_(&path), continuation_(&continuation) {}

    /// Returns the points between two successive points, in the order of the branch.
    std::vector<SpecialPoint> locate_all(const DescribedEquilibrium& before, const DescribedEquilibrium& here);
    /// Forgets the point before the last step, after a start.
    void forget() { history_.forget(); }
    /// True when the points found account for the change of the number of unstable eigenvalues.
    static bool explains(const std::vector<SpecialPoint>& found, const DescribedEquilibrium& before,
                         const DescribedEquilibrium& here);

    /// Finds the point of a step at which several eigenvalues cross the imaginary axis at once, of which no test tells.
    std::optional<SpecialPoint> crossing_of_several(const DescribedEquilibrium& before,
                                                    const DescribedEquilibrium& here);

private:
    using Bracket = std::pair<TestValue, TestValue>;
    std::vector<Bracket> brackets_of(std::size_t test, const BranchTest& before, const BranchTest& here);
    std::optional<DescribedEquilibrium> describe_between(double fraction);
    std::optional<DescribedEquilibrium> zero_of(std::size_t test, TestValue low, TestValue high);
    std::optional<SpecialPoint> locate(std::size_t test, const Bracket& bracket, const DescribedEquilibrium& before,
                                       const DescribedEquilibrium& here);
    bool confirm(SpecialPoint& special, const BranchTest& test, const DescribedEquilibrium& there, double size);
    bool confirm_bound(SpecialPoint& special, const BranchTest& test);
    std::string hopf_in_words(const DescribedEquilibrium& there) const;

    const EquilibriumPath* path_;
    Continuation* continuation_;
    TestHistory history_;
};

} // namespace graze
