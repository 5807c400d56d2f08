#pragma once

#include "program/output_file.hpp"

#include <string>
#include <vector>

namespace graze {

/// What the name of a picture ends in, in lower case. @throws InputError unless it is one of `known`
std::string picture_ending(const std::string& path, const std::string& option, const std::vector<std::string>& known);

/// Path of a program that draws. @throws InputError with the remedy when it is missing
std::string require_drawing_program(const std::string& name, const std::string& remedy);

/// A program that draws may run out of room and say nothing.
/// @param file what it has drawn; @param ending as picture_ending gives it; @param path for the message
/// @throws InputError unless the picture has its beginning and its end
void require_whole_picture(const std::string& file, const std::string& ending, const std::string& path);
/// The same; in SVG it replaces what XML does not allow and programs write all the same.
void require_well_formed_picture(const FileReplacement& file, const std::string& ending, const std::string& path);

/// Draws into a file that is still to get its name. @param script commands for gnuplot that draw there
/// @param ending as picture_ending gives it; @param path for messages, @param remedy too
/// @throws InputError when gnuplot is missing or fails
void draw_by_gnuplot(const std::string& script, const FileReplacement& file, const std::string& ending,
                     const std::string& path, const std::string& remedy);

/// What a program has said, on one line.
std::string one_line(const std::string& text);

} // namespace graze
