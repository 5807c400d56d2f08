#pragma once

#include "graze/layout/layout_cell.hpp"

#include <cstdint>
#include <string>

namespace graze {

constexpr std::int64_t least_mark = 20; ///< smallest size, nanometres

/// Returns an alignment mark centred at the origin: a cross on mask 1, and four squares on mask 2 that frame the cross
/// at a distance of a twentieth of the mark's size. @param size side of the enclosing square in nanometres, at least
/// `least_mark`
LayoutCell alignment_mark(const std::string& name, std::int64_t size);

} // namespace graze
