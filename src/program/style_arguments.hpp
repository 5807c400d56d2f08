#pragma once

#include "graze/picture/figure.hpp"
#include "program/arguments.hpp"

#include <string>

namespace graze {

/// The number that an option gives. @throws InputError unless it is a finite number
double number_of_option(const std::string& text, const char* option);

/// The style that `--size`, `--font` and `--grey` give. @throws InputError for sizes that cannot be drawn
FigureStyle figure_style(const StyleArguments& arguments);

} // namespace graze
