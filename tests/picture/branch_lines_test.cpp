#include "picture/branch_lines.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace graze::testing::branch_lines_test {

/// The abscissas of the lines of a stable branch with points of these types and abscissas.
std::vector<std::vector<double>> lines_through(const std::vector<std::pair<PointType, double>>& points) {
    DrawnBranch branch{"tori", {}};
    for (const auto& [type, x] : points) {
        const auto number = static_cast<std::int64_t>(branch.points.size());
        branch.points.push_back(
            {static_cast<std::size_t>(number), "tori", "", "", type, Look::stable, number, x, x, {0}});
    }
    FigurePanel panel;
    add_lines(panel, branch, 0);
    std::vector<std::vector<double>> lines;
    for (const FigureSeries& series : panel.series) {
        lines.emplace_back();
        for (const PlanePoint& one : series.points)
            lines.back().push_back(one.x);
    }
    return lines;
}

/// Orbits at the ends of a tongue are no tori: the line does not go through them, and there is none where there are no
/// tori.
TEST(BranchLines, LeaveOutTonguesOfTori) {
    using enum PointType;
    using Lines = std::vector<std::vector<double>>;
    const Lines narrow{{0, 1, 2}}, wide{{0, 1}, {2, 3}};
    EXPECT_EQ(lines_through({{end, 0}, {locking, 0.5}, {locking, 0.51}, {regular, 1}, {end, 2}}), narrow);
    EXPECT_EQ(lines_through({{end, 0}, {regular, 1}, {locking, 1.1}, {locking, 1.9}, {regular, 2}, {end, 3}}), wide);
    // The branch may begin beyond a tongue, or end before one.
    EXPECT_EQ(lines_through({{locking, -1}, {end, 0}, {regular, 1}, {end, 2}, {locking, 3}}), narrow);
}

} // namespace graze::testing::branch_lines_test
