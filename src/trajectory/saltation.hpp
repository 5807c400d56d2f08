#pragma once

#include "graze/flow/system.hpp"

#include <span>

namespace graze {

// Derivatives of a motion in several directions at a contact (saltation: Aizerman and Gantmakher 1958; di Bernardo et
// al. 2008, section 2.5). Matrices are row by row, [state * directions + direction], and hold derivatives at fixed
// time.

/// Adds `column` (states) times `row` (directions) to a matrix.
void add_product(std::span<double> matrix, std::span<const double> column, std::span<const double> row);

/// A jump whose time changes with the direction by `shift`: at a contact, minus the derivatives of the event function
/// over its rate.
struct Saltation {
    std::span<const double> shift;
    std::span<const double> field_before, field_after; ///< rates of the states
    const System::CompiledJump& jump;
    std::span<const double> jacobian;        ///< values of the jump's entries
    std::span<const double> parameter_seeds; ///< [parameter * directions + direction]; empty: all are zero
};
/// Propagates derivatives through the jump. @param room workspace of the size of the matrix
void pass_jump(const Saltation& saltation, std::span<double> matrix, std::span<double> room);

} // namespace graze
