#pragma once

#include "graze/model/model.hpp"

#include <string>

namespace graze {

/// Draws the modes of a model and the transitions between them, in the format of the file's ending. Graphviz draws svg,
/// png, pdf and eps; dot is the language of Graphviz and needs no program.
/// @throws InputError for other endings, when Graphviz is missing, and when the file cannot be written
void draw_graph(const Model& model, const std::string& path);

} // namespace graze
