#pragma once

#include "graze/identify/identification.hpp"
#include "graze/picture/figure.hpp"

#include <vector>

namespace graze {

/// Adds two panels: measured and fitted values, and the residuals.
/// @param panel an empty panel with axis labels
void add_residual_panels(Figure& figure, FigurePanel panel, const std::vector<Identification::Shown>& shown);

} // namespace graze
