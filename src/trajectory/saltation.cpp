#include "trajectory/saltation.hpp"

#include <algorithm>

namespace graze {

void add_product(std::span<double> matrix, std::span<const double> column, std::span<const double> row) {
    for (std::size_t i = 0; i < column.size(); ++i)
        for (std::size_t d = 0; d < row.size(); ++d)
            matrix[i * row.size() + d] += column[i] * row[d];
}

void pass_jump(const Saltation& saltation, std::span<double> matrix, std::span<double> room) {
    const std::size_t directions = saltation.shift.size(), states = saltation.field_before.size();
    const System::CompiledJump& jump = saltation.jump;
    add_product(matrix, saltation.field_before, saltation.shift);
    for (const std::size_t i : jump.changed)
        std::fill_n(&room[i * directions], directions, 0.0);
    for (std::size_t k = 0; k < jump.entries.size(); ++k) {
        const double entry = saltation.jacobian[k];
        const auto [i, j] = jump.entries[k];
        if (entry == 0 || (j >= states && saltation.parameter_seeds.empty()))
            continue;
        const double* from =
            j < states ? &matrix[j * directions] : &saltation.parameter_seeds[(j - states) * directions];
        for (std::size_t d = 0; d < directions; ++d)
            room[i * directions + d] += entry * from[d];
    }
    for (const std::size_t i : jump.changed)
        std::copy_n(&room[i * directions], directions, &matrix[i * directions]);
    for (std::size_t i = 0; i < states; ++i)
        for (std::size_t d = 0; d < directions; ++d)
            matrix[i * directions + d] -= saltation.field_after[i] * saltation.shift[d];
}

} // namespace graze
