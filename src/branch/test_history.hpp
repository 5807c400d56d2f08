#pragma once

#include "branch/point_kind.hpp"
#include "branch/test_dip.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace graze {

/// The values of a branch's tests at the points before its last step, which tell where a test may have two zeros within
/// the step although its sign is the same at both ends.
class TestHistory {
public:
    void forget() { points_.clear(); }
    bool is_empty() const { return points_.empty(); }
    /// Adds the start of the last step, before the next step. @param arclength of the branch there
    void add(double arclength, const std::vector<BranchTest>& tests);
    /// Returns values of a test before, between and behind two of its zeros within a step, at whose ends it has the
    /// same sign; see `possible_dip` and `dip_between`.
    /// @param begin, length arclength at the start of the step, and of it
    std::optional<Dip> find_dip(std::size_t test, double begin, double length, const TestValue& low,
                                const TestValue& high, double noise,
                                const std::function<double(double)>& value_at) const;

private:
    struct Point {
        double arclength = 0;
        std::vector<double> values;
    };
    static constexpr std::size_t most = 2;
    std::vector<Point> points_; ///< the newest is the first
};

} // namespace graze
