#pragma once

#include "graze/model/model.hpp"
#include "graze/results/name_advice.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// Splits lists such as "a, b" "c"; blanks around items are dropped, empty items too.
std::vector<std::string> split_list(const std::vector<std::string>& arguments);

/// Value of a number or expression in the model's parameters, at their present values.
/// @param option where it was given, for messages
/// @throws InputError when it is no expression or not finite
double value_of(const Model& model, std::string_view text, const std::string& option);
/// The same, and positive. @throws InputError
double positive_value_of(const Model& model, std::string_view text, const std::string& option);

/// Carries out `--set NAME=EXPRESSION ...`, one after the other; `@FILE` stands for all that a file of parameters
/// sets, of which what comes later takes the place. @throws InputError, also for a file of another model
void set_parameters(Model& model, const std::vector<std::string>& assignments);
/// The value of a text that is given for a name. @throws InputError with the place
using ValueReader = std::function<double(const std::string& name, const std::string& text, const Place& place)>;
/// Names and values of `--set NAME=NUMBER ...` for models that are not known yet: expressions without names.
/// @param read none: an expression without units
/// @throws InputError
std::vector<std::pair<std::string, double>> parameter_values(const std::vector<std::string>& assignments,
                                                             const ValueReader& read = {});
/// Does what may refuse one of these names or values, and tells where: the line of the file that has it, or `--set`.
/// @throws InputError
void with_places_of(const std::vector<std::string>& assignments, const std::function<void()>& work);
/// @param models names of those that are used. @throws InputError if `@FILE` among the assignments was found for
/// another
void require_models_of_files(const std::vector<std::string>& assignments, const std::vector<std::string>& models);
/// Carries out `--from STATE=EXPRESSION ...`, with `@FILE` likewise. @throws InputError
void set_initial_state(Model& model, const std::vector<std::string>& assignments);
/// What `--disturbance STATE=EXPRESSION ...` adds to each state of the model; empty without any. @throws InputError
std::vector<double> disturbance_of(const Model& model, const std::vector<std::string>& assignments);

} // namespace graze
