#pragma once

#include "graze/layout/layout.hpp"
#include "graze/layout/process_steps.hpp"
#include "graze/model/model.hpp"
#include "graze/picture/figure.hpp"
#include "graze/picture/wafer_map.hpp"
#include "program/output_file.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

/// The ending of a picture's file name, in lower case. @param option for messages
/// @throws InputError unless it is one of `known`
std::string picture_ending(const std::string& path, const std::string& option, const std::vector<std::string>& known);

/// Path of an external drawing program. @throws InputError with the remedy when it is missing
std::string require_drawing_program(const std::string& name, const std::string& remedy);

/// Checks that a picture is complete: a drawing program may run out of disk space without reporting it.
/// @param file the picture; @param ending as picture_ending returns it; @param path for the message
/// @throws InputError unless the picture has its end
void require_whole_picture(const std::string& file, const std::string& ending, const std::string& path);
/// Does the same and, in SVG, replaces characters that XML does not allow but drawing programs write.
void require_well_formed_picture(const FileReplacement& file, const std::string& ending, const std::string& path);

/// Draws into the temporary file of `file`. @param script commands for gnuplot that write that file
/// @param ending as picture_ending returns it; @param path and @param remedy for messages
/// @throws InputError when gnuplot is missing or fails
void draw_by_gnuplot(const std::string& script, const FileReplacement& file, const std::string& ending,
                     const std::string& path, const std::string& remedy);

/// The text on one line: each run of blanks and line feeds becomes one blank.
std::string one_line(const std::string& text);

/// Draws with gnuplot. A path that ends in .tex gives a text for LaTeX, and a PDF of the lines beside it.
/// @param data_path file that keeps the commands; may be empty
/// @throws InputError when gnuplot is missing or fails, or a file cannot be written
void draw_figure(const Figure& figure, const std::string& path, const std::string& data_path);
/// Draw pictures of other kinds, as svg, png or pdf. @throws InputError as draw_figure
/// @param mask 1 or 2: this mask alone; none: the device or wafer, and both masks
void draw_layout(const Layout& layout, const std::string& path, std::optional<int> mask = std::nullopt);
void draw_wafer_map(const WaferYield& yield, const WaferPlan& plan, const WaferMapLabels& labels,
                    const std::string& path);
void draw_fabrication(const std::vector<ProcessStep>& steps, const std::string& path);

/// Draws the modes of a model and the transitions between them, in the format of the file's ending. Graphviz draws svg,
/// png, pdf and eps; dot is the language of Graphviz and needs no program.
/// @throws InputError for other endings, when Graphviz is missing, and when the file cannot be written
void draw_graph(const Model& model, const std::string& path);

} // namespace graze
