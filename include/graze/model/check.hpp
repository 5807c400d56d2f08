#pragma once

#include "graze/model/model.hpp"

#include <string>
#include <vector>

namespace graze {

/// Things that are allowed but probably not meant: an event that nobody watches, a mode that nothing leads to,
/// a watched section without a transition, an unused parameter, definition or jump, conditions that may all fail or
/// never matter, a start beyond a barrier or where rates are not finite, a symmetry that does not hold, ...
/// @param model a valid one
/// @throws InputError when the model is not valid
std::vector<std::string> model_warnings(const Model& model);

/// The same with the part of the model that each is about, such as "events.stop"; empty where it is no single one.
struct ModelWarning {
    std::string part, text;
};
std::vector<ModelWarning> located_warnings(const Model& model);

/// The connectivity graph (modes as nodes, transitions as arrows) in the language of Graphviz.
/// @throws InputError when the model is not valid
std::string connectivity_graph(const Model& model);

} // namespace graze
