#pragma once

#include "graze/symbolic/expression.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace graze {

/// The functions that can be written in an expression, all of one argument.
struct FunctionName {
    std::string_view name;
    Operation operation;
};
std::span<const FunctionName> function_names();
std::optional<Operation> function_named(std::string_view name);
/// @throws InputError when the operation is not a function
std::string_view function_name(Operation operation);

/// What is wrong with a name that people write but that the language lacks, and what to write instead.
struct Refusal {
    std::string problem;
    std::string remedy;
};
/// Returns a refusal for non-analytic functions, functions with an equivalent, words of logic, and time.
std::optional<Refusal> refusal_of(std::string_view name);

} // namespace graze
