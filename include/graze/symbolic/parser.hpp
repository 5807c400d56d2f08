#pragma once

#include "graze/base/input_error.hpp"
#include "graze/symbolic/expression.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// What names mean while an expression is parsed.
using Scope = std::map<std::string, Expression, std::less<>>;

/// Parses infix text: numbers, + - * / ^ (right associative, above unary minus: -x^2 is -(x^2)), parentheses,
/// the functions of `Operation`, `pi`, and the names in `scope`. Never recurses: nesting is bounded by memory.
/// @param place where the text begins: lines and columns of errors are counted from there, in UTF-8 characters (a tab
/// is one); an unknown line or column counts from 1
/// @throws InputError for an unknown name (with the nearest known one), unbalanced parentheses, wrong number of
///         arguments, malformed number, non-analytic function (with the advice to use an event), empty text
Expression parse_expression(Graph& graph, std::string_view text, const Scope& scope, const Place& place = {});

/// One comparison such as `x > 0`: it holds where `function` > 0 (strict) or >= 0.
struct Condition {
    Expression function;
    bool strict = true;
    bool operator==(const Condition&) const = default;
};

/// Parses conditions joined by `and`: each `a > b`, `a >= b`, `a < b` or `a <= b`. Errors as parse_expression.
std::vector<Condition> parse_conditions(Graph& graph, std::string_view text, const Scope& scope,
                                        const Place& place = {});

/// Returns whether a name may be given to a state, parameter, ...: letters, digits and underscores, not starting with
/// a digit, and not reserved: the names of functions, `pi`, `t`, `time`, `and`, `or`, `not`.
bool is_valid_name(std::string_view name);
bool is_reserved_name(std::string_view name);

} // namespace graze
