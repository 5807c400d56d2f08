#pragma once

#include "graze/model/model.hpp"

#include <string>
#include <vector>

namespace graze {

/// Returns the text of an expression, shortened if long: definitions of model families can fill pages.
std::string formula(const Expression& expression);
/// Returns for example "free: stop / impact -> free".
std::string transition_text(const Model& model, const Transition& transition);
/// Returns for example "watches stop, end"; empty when the mode watches no events.
std::string watched_by(const Model& model, const Mode& mode);
/// Returns for example "stop = 0 between left and right, Filippov".
std::string slide_text(const Model& model, const Slide& slide);
/// Returns the rates of a mode that a slide has made, such as "x' = 0"; those of other modes are in the model's file.
std::vector<std::string> sliding_rates(const Model& model, const Slide& slide);
/// Returns for example "against v: coefficient 0.3, at rest 0.4, normal force N".
std::string friction_text(const Friction& friction);
/// Returns for example "gap y - r, restitution e, friction mu against u".
std::string contact_text(const UnilateralContact& contact);
/// Returns what the contacts of a model have in common, such as "newton, impulses on u, v", and remarks on them.
std::vector<std::string> contact_remarks(const Model& model);
/// Returns for example "theta = 0", or the function that is zero and the direction of crossing.
std::string section_text(const Model& model, const Section& section);
/// Returns the images of the states that a symmetry changes, such as "x -> -x".
std::vector<std::string> images_of(const Model& model, const Symmetry& symmetry);

} // namespace graze
