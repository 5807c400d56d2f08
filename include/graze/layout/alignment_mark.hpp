#pragma once

#include "graze/layout/layout_cell.hpp"

namespace graze {

constexpr std::int64_t least_mark = 20; ///< nanometres

/// An alignment mark about the origin: a cross on mask 1, and four squares on mask 2 between whose edges the cross is
/// to lie, a twentieth of the mark's size from each. @param size of the square around it, nanometres, at least
/// `least_mark`
LayoutCell alignment_mark(const std::string& name, std::int64_t size);

} // namespace graze
