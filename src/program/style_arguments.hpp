#pragma once

#include "graze/picture/figure.hpp"
#include "program/arguments.hpp"

#include <string>

namespace graze {

/// @throws InputError for what is not a finite number
double number_of_option(const std::string& text, const char* option);

/// What `--size`, `--font` and `--grey` say. @throws InputError for sizes that cannot be drawn
FigureStyle figure_style(const StyleArguments& arguments);

} // namespace graze
