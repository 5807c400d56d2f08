#pragma once

#include "graze/model/model.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Returns the expression of a conserved quantity in a mode of this name; null when there is none.
const Expression* conserved_in(const ConservedQuantity& conserved, std::string_view mode);

/// Says where a motion changes a conserved quantity at the model's present parameters: in a mode, at a transition, or
/// where a cyclic state begins anew. Empty if it does not, at a number of states around the initial one.
std::string why_not_conserved(const Model& model, std::size_t conserved);
/// Returns the model at other values of its independent parameters.
Model with_parameters(Model model, std::span<const double> parameters);
/// True when one of the model's quantities is conserved at these values.
bool conserves_something(const Model& model, std::span<const double> parameters);

/// Returns the states on whose values nothing depends: no rate, event, guard, section, conserved quantity and jump,
/// except that a jump may shift the state itself. A motion may begin at any value of them, and is the same.
std::vector<std::size_t> ignorable_states(const Model& model);

/// Lets orbits of a model with conserved quantities drift along its ignorable coordinates, unless a state is cyclic,
/// and along sets of states that may be translated together.
void let_ignorable_states_drift(Model& model);

} // namespace graze
