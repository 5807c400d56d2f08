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
/// Says why an expression cannot be conserved by any motion: it is the same at all states, or it is never a number
/// around the initial one. Empty otherwise. `why_not_conserved` says this too.
std::string why_no_first_integral(const Model& model, std::size_t conserved);
/// A state of a motion.
struct StateInMode {
    std::size_t mode = 0;
    std::vector<double> state{};
};
/// Says in which mode a given motion changes a conserved quantity, or why it is none; empty if it does not. Where
/// motions never come, the expression may be any.
std::string why_not_conserved_along(const Model& model, std::size_t conserved, std::span<const StateInMode> motion);
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
