#pragma once

#include "graze/identify/identification.hpp"
#include "graze/picture/figure.hpp"

#include <vector>

namespace graze {

/// Two panels more: what was measured and what was fitted, and what is left.
/// @param panel with its axes
void add_residual_panels(Figure& figure, FigurePanel panel, const std::vector<Identification::Shown>& shown);

} // namespace graze
