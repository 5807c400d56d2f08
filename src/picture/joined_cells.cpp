#include "picture/joined_cells.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

namespace graze {

namespace {

/// Joins boxes above one another. @param boxes row by row, upwards
std::vector<PlaneBox> joined_rows(const std::vector<PlaneBox>& boxes) {
    std::map<std::pair<double, double>, std::size_t> last; // by left and right
    std::vector<PlaneBox> joined;
    for (const PlaneBox& box : boxes) {
        const auto [found, is_new] = last.try_emplace({box.left, box.right}, joined.size());
        if (!is_new && joined[found->second].high == box.low) {
            joined[found->second].high = box.high;
        } else {
            found->second = joined.size();
            joined.push_back(box);
        }
    }
    return joined;
}

} // namespace

std::vector<PlaneBox> joined_cells(const FigureSeries& series) {
    if (series.numbers.empty())
        return series.cells;
    std::vector<PlaneBox> joined;
    for (const PlaneBox& cell : series.cells) {
        const auto is_beside = [&](const PlaneBox& last) {
            return cell.low == last.low && cell.high == last.high && cell.left >= last.left && cell.left <= last.right;
        };
        if (joined.empty() || !is_beside(joined.back()))
            joined.push_back(cell);
        joined.back().right = std::max(joined.back().right, cell.right);
    }
    return joined_rows(joined);
}

} // namespace graze
