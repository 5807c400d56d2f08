#pragma once

#include <string>
#include <vector>

namespace graze {

/// What the name of a picture ends in, in lower case. @throws InputError unless it is one of `known`
std::string picture_ending(const std::string& path, const std::string& option, const std::vector<std::string>& known);

/// Path of a program that draws. @throws InputError with the remedy when it is missing
std::string require_drawing_program(const std::string& name, const std::string& remedy);

/// What a program has said, on one line.
std::string one_line(const std::string& text);

} // namespace graze
