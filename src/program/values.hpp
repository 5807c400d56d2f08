#pragma once

#include "graze/model/model.hpp"
#include "graze/model/named_value.hpp"
#include "graze/picture/figure.hpp"
#include "graze/results/name_advice.hpp"
#include "program/arguments.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// Splits lists such as "a, b" "c"; blanks around items are dropped, empty items too.
std::vector<std::string> split_list(const std::vector<std::string>& arguments);

/// The value of a text as by value_of, if it is positive. @throws InputError
double positive_value_of(const Model& model, std::string_view text, const std::string& option);

/// Sets parameters by `--set NAME=EXPRESSION ...`, one after the other; `@FILE` sets all values in a file of
/// parameters, which later assignments replace. @throws InputError, also for a file of another model
void set_parameters(Model& model, const std::vector<std::string>& assignments);
/// Evaluates the text that is given for a name. @throws InputError with the place
using ValueReader = std::function<double(const std::string& name, const std::string& text, const Place& place)>;
/// Names and values of `--set NAME=NUMBER ...` for models that are not known yet: expressions contain no names.
/// @param read evaluates the texts; none: as expressions without units
/// @throws InputError
std::vector<std::pair<std::string, double>> parameter_values(const std::vector<std::string>& assignments,
                                                             const ValueReader& read = {});
/// Calls a function that may refuse one of these names or values; its error gets a place: the line of the file of
/// parameters, or `--set`. @throws InputError
void with_places_of(const std::vector<std::string>& assignments, const std::function<void()>& work);
/// @param models names of the models that are used
/// @throws InputError if a file `@FILE` among the assignments belongs to another model
void require_models_of_files(const std::vector<std::string>& assignments, const std::vector<std::string>& models);
/// Sets initial values by `--from STATE=EXPRESSION ...`; `@FILE` as for set_parameters. @throws InputError
void set_initial_state(Model& model, const std::vector<std::string>& assignments);
/// The value that `--disturbance STATE=EXPRESSION ...` adds to each state; empty if none is given. @throws InputError
std::vector<double> disturbance_of(const Model& model, const std::vector<std::string>& assignments);

/// An expression in states and parameters whose values the user asked for.
using RequestedQuantity = NamedValue;

/// Reads each text as requested_quantity does.
std::vector<RequestedQuantity> requested_quantities(const Model& model, const std::vector<std::string>& texts,
                                                    const std::string& option);

/// The number that is the whole text; none unless it is finite.
std::optional<double> finite_number_in(std::string_view text);
/// The number that an option gives. @throws InputError unless it is a finite number
double number_of_option(const std::string& text, const char* option);

/// The style that `--size`, `--font` and `--grey` give. @throws InputError for sizes that cannot be drawn
FigureStyle figure_style(const StyleArguments& arguments);

} // namespace graze
