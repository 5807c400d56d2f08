#pragma once

#include "graze/identify/identification.hpp"
#include "graze/picture/figure.hpp"

namespace graze {

/// What was measured and what was fitted, and in a panel below what is left.
Figure residual_figure(const Identification& found);

} // namespace graze
