#pragma once

#include "graze/layout/layout.hpp"
#include "graze/layout/process_steps.hpp"
#include "graze/picture/figure.hpp"
#include "graze/picture/wafer_map.hpp"
#include "program/output_file.hpp"

#include <optional>
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

/// Draws with gnuplot. What ends in .tex is text for LaTeX, with the lines in a file beside it that ends in .pdf.
/// @param data_path where to keep the commands as well; may be empty
/// @throws InputError when gnuplot is missing or fails, or a file cannot be written
void draw_figure(const Figure& figure, const std::string& path, const std::string& data_path);
/// The same of other pictures, as svg, png or pdf. @throws InputError likewise
/// @param mask 1 or 2: this one alone; none: the device or wafer, and both masks
void draw_layout(const Layout& layout, const std::string& path, std::optional<int> mask = std::nullopt);
void draw_wafer_map(const WaferYield& yield, const WaferPlan& plan, const WaferMapLabels& labels,
                    const std::string& path);
void draw_fabrication(const std::vector<ProcessStep>& steps, const std::string& path);

} // namespace graze
