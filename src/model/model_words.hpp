#pragma once

#include "graze/model/model.hpp"

#include <string>
#include <vector>

namespace graze {

/// The text of an expression, cut off where it is long: definitions of families of models can be as long as a book.
std::string formula(const Expression& expression);
/// "free: stop / impact -> free".
std::string way_of(const Model& model, const Transition& transition);
/// "watches stop, end"; empty where nothing is watched.
std::string watched_by(const Model& model, const Mode& mode);
/// "theta = 0", or a function that is zero and the direction.
std::string section_text(const Model& model, const Section& section);
/// What becomes of the states that a symmetry changes: "x -> -x".
std::vector<std::string> images_of(const Model& model, const Symmetry& symmetry);

} // namespace graze
