#pragma once

#include "graze/picture/figure.hpp"

#include <nlohmann/json.hpp>

namespace graze {

/// A figure with all its data, as the page draws it. Coordinates that are not finite, which interrupt lines, are null.
/// A series and a label name the run and the numbers of the stored points that they show, if they show any.
nlohmann::json figure_json(const Figure& figure);

} // namespace graze
