#pragma once

#include "graze/identify/identification.hpp"
#include "graze/picture/figure.hpp"

namespace graze {

/// A panel of measured and fitted values, and a panel of the residuals below.
Figure residual_figure(const Identification& found);

} // namespace graze
