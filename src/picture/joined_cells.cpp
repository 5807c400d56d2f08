#include "picture/joined_cells.hpp"

#include <algorithm>

namespace graze {

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
    return joined;
}

} // namespace graze
