#pragma once

#include "program/figure.hpp"

#include <string>

namespace graze {

/// Part of its height and width that a roomy panel leaves free on both sides.
constexpr double roomy_margin = 0.06;

/// Commands of gnuplot that write a panel's labels beside their points: away from other labels, symbols and lines as
/// far as there is room. A label that would lie on another one is left out.
std::string label_commands(const FigurePanel& panel);

} // namespace graze
