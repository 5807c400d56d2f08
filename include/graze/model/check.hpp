#pragma once

#include "graze/model/model.hpp"

#include <string>
#include <vector>

namespace graze {

/// Returns warnings about things that are allowed but probably mistakes: an event that no mode watches, a mode that
/// cannot be reached, a watched section without a transition, an unused parameter, definition or jump, conditions that
/// may all fail or are never tested, an initial state beyond a barrier or where rates are not finite, a symmetry that
/// does not hold, ...
/// @param model a valid model
/// @throws InputError when the model is not valid
std::vector<std::string> model_warnings(const Model& model);

/// A warning and the part of the model that it is about, such as "events.stop"; empty if it is about no single part.
struct ModelWarning {
    std::string part, text;
};
std::vector<ModelWarning> located_warnings(const Model& model);

/// The connectivity graph (modes as nodes, transitions as arrows) in the language of Graphviz.
/// @throws InputError when the model is not valid
std::string connectivity_graph(const Model& model);

} // namespace graze
