#pragma once

#include "graze/model/model.hpp"

#include <string>

namespace graze {

/// Draws the modes of a model and the transitions between them; the file's ending says how. Graphviz draws svg, png
/// and pdf; dot is its own language, for which nothing is needed.
/// @throws InputError for other endings, when Graphviz is missing, and when the file cannot be written
void draw_graph(const Model& model, const std::string& path);

} // namespace graze
