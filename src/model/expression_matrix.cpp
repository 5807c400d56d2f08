#include "model/expression_matrix.hpp"

#include "graze/symbolic/transform.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace graze {

Expression eliminate(ExpressionMatrix& rows, const Expression& one) {
    Expression determinant = one;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const auto found = std::find_if(rows.begin() + static_cast<std::ptrdiff_t>(k), rows.end(),
                                        [&](const auto& row) { return !row[k].is_number(0); });
        if (found == rows.end())
            return one.graph()->number(0);
        if (found != rows.begin() + static_cast<std::ptrdiff_t>(k)) {
            std::swap(*found, rows[k]);
            determinant = -determinant;
        }
        determinant = determinant * rows[k][k];
        for (std::size_t j = k + 1; j < rows[k].size(); ++j)
            rows[k][j] = rows[k][j] / rows[k][k];
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (i != k && !rows[i][k].is_number(0))
                for (std::size_t j = k + 1; j < rows[k].size(); ++j)
                    if (!rows[k][j].is_number(0))
                        rows[i][j] = rows[i][j] - rows[i][k] * rows[k][j];
    }
    return determinant;
}

Expression determinant(const ExpressionMatrix& rows, const Expression& one) {
    if (rows.empty())
        return one;
    Expression sum = one.graph()->number(0);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].front().is_number(0))
            continue;
        ExpressionMatrix minor;
        for (std::size_t k = 0; k < rows.size(); ++k)
            if (k != i)
                minor.emplace_back(rows[k].begin() + 1, rows[k].end());
        const Expression term = rows[i].front() * determinant(minor, one);
        sum = i % 2 == 0 ? sum + term : sum - term;
    }
    return sum;
}

} // namespace graze
