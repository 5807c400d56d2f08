#include "model/moved_together.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

using Rows = std::vector<std::vector<double>>;

/// The rows of all gradients, with the greatest entry 1. Rows that are zero or not finite are left out.
Rows scaled_rows(const std::vector<double>& gradients, std::size_t states) {
    const auto n = static_cast<std::ptrdiff_t>(states);
    Rows rows;
    for (auto row = gradients.begin(); row != gradients.end(); row += n) {
        double size = 0;
        bool finite = true;
        for (auto entry = row; entry != row + n; ++entry) {
            finite = finite && std::isfinite(*entry);
            size = std::max(size, std::abs(*entry));
        }
        if (!finite || size == 0)
            continue;
        rows.emplace_back(row, row + n);
        for (double& entry : rows.back())
            entry /= size;
    }
    return rows;
}

/// Makes the entries of a column zero in all rows but that of its pivot, which becomes 1.
void eliminate(Rows& rows, std::size_t pivot, std::size_t column) {
    const double divisor = rows[pivot][column];
    for (double& entry : rows[pivot])
        entry /= divisor;
    for (std::size_t r = 0; r < rows.size(); ++r)
        if (const double factor = rows[r][column]; r != pivot && factor != 0)
            for (std::size_t k = 0; k < rows[r].size(); ++k)
                rows[r][k] -= factor * rows[pivot][k];
}

/// The states of pivots whose columns add up to zero with this one, and this one; empty if other multiples of them do.
std::vector<std::size_t> moved_with(const Rows& rows, const std::vector<std::size_t>& pivots, std::size_t column) {
    constexpr double same = 1e-6; // what is meant; keep_motion decides to the last digits
    std::vector<std::size_t> set;
    for (std::size_t p = 0; p < pivots.size(); ++p)
        if (std::abs(rows[p][column] + 1) < same)
            set.push_back(pivots[p]);
        else if (std::abs(rows[p][column]) > same)
            return {};
    set.push_back(column);
    return set;
}

/// True when no gradient changes if all these states are translated together.
bool keep_motion(const Rows& rows, const std::vector<std::size_t>& set) {
    constexpr double same = 1e-11;
    return std::ranges::all_of(rows, [&](const std::vector<double>& row) {
        double sum = 0, size = 0;
        for (const std::size_t state : set) {
            sum += row[state];
            size += std::abs(row[state]);
        }
        return std::abs(sum) <= same * size;
    });
}

} // namespace

std::vector<std::vector<std::size_t>> sets_moved_together(const std::vector<double>& gradients, std::size_t states) {
    constexpr double none = 1e-9;
    const Rows given = scaled_rows(gradients, states);
    Rows rows = given;
    std::vector<std::size_t> pivots;
    std::vector<std::vector<std::size_t>> result;
    // Gauss's elimination: a column without a pivot is a combination of those before it.
    for (std::size_t column = 0; column < states; ++column) {
        const auto first = rows.begin() + static_cast<std::ptrdiff_t>(pivots.size());
        const auto greatest = std::max_element(
            first, rows.end(), [&](const auto& a, const auto& b) { return std::abs(a[column]) < std::abs(b[column]); });
        if (greatest != rows.end() && std::abs((*greatest)[column]) > none) {
            std::iter_swap(first, greatest);
            eliminate(rows, pivots.size(), column);
            pivots.push_back(column);
        } else if (std::vector<std::size_t> set = moved_with(rows, pivots, column);
                   set.size() > 1 && keep_motion(given, set)) {
            result.push_back(std::move(set));
        }
    }
    return result;
}

} // namespace graze
