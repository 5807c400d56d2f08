#include "symbolic/vocabulary.hpp"

#include "graze/base/input_error.hpp"
#include "symbolic/function_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

constexpr FunctionName function_words[] = {
#define GRAZE_ROW(name, recurrence, slope) {#name, Operation::name},
    GRAZE_FUNCTIONS(GRAZE_ROW)
#undef GRAZE_ROW
};

constexpr std::string_view non_analytic[] = {
    "abs",   "fabs",      "sign",  "sgn",      "signum",    "min",     "max",       "if",    "ifelse",
    "iif",   "piecewise", "where", "floor",    "ceil",      "ceiling", "round",     "trunc", "int",
    "frac",  "mod",       "fmod",  "rem",      "remainder", "step",    "heaviside", "theta", "delta",
    "dirac", "clamp",     "sat",   "saturate", "deadzone",  "relu",    "select",    "atan2", "arg",
};

struct Equivalent {
    std::string_view name;
    std::string_view written;
};
constexpr Equivalent equivalents[] = {
    {"ln", "log(x)"},
    {"log10", "log(x)/log(10)"},
    {"log2", "log(x)/log(2)"},
    {"log1p", "log(1 + x)"},
    {"expm1", "exp(x) - 1"},
    {"exp2", "2^x"},
    {"pow", "a^b"},
    {"power", "a^b"},
    {"sqr", "x^2"},
    {"square", "x^2"},
    {"cbrt", "x^(1/3)"},
    {"hypot", "sqrt(a^2 + b^2)"},
    {"sec", "1/cos(x)"},
    {"csc", "1/sin(x)"},
    {"cot", "1/tan(x)"},
    {"sech", "1/cosh(x)"},
    {"csch", "1/sinh(x)"},
    {"coth", "1/tanh(x)"},
    {"erfc", "1 - erf(x)"},
    {"asinh", "log(x + sqrt(x^2 + 1))"},
    {"acosh", "log(x + sqrt(x^2 - 1))"},
    {"atanh", "log((1 + x)/(1 - x))/2"},
    {"arcsin", "asin(x)"},
    {"arccos", "acos(x)"},
    {"arctan", "atan(x)"},
    {"arcsinh", "log(x + sqrt(x^2 + 1))"},
    {"arccosh", "log(x + sqrt(x^2 - 1))"},
    {"arctanh", "log((1 + x)/(1 - x))/2"},
};

} // namespace

std::span<const FunctionName> function_names() {
    return function_words;
}

std::optional<Operation> function_named(std::string_view name) {
    const auto* found = std::ranges::find(function_words, name, &FunctionName::name);
    return found == std::end(function_words) ? std::nullopt : std::optional(found->operation);
}

std::string_view function_name(Operation operation) {
    const auto* found = std::ranges::find(function_words, operation, &FunctionName::operation);
    if (found == std::end(function_words))
        throw InputError("the operation has no function name", "");
    return found->name;
}

std::optional<Refusal> refusal_of(std::string_view name) {
    const std::string quoted = fmt::format("'{}'", name);
    if (std::ranges::find(non_analytic, name) != std::end(non_analytic))
        return Refusal{quoted + " is not analytic",
                       "make its switching point an event, with two modes that have a smooth expression each"};
    const auto* equivalent = std::ranges::find(equivalents, name, &Equivalent::name);
    if (equivalent != std::end(equivalents))
        return Refusal{quoted + " is not a known function", fmt::format("write {}", equivalent->written)};
    if (name == "t" || name == "time")
        return Refusal{"time (" + quoted + ") cannot be used in an expression",
                       "declare a phase: a state with a constant rate, cyclic if the forcing is periodic"};
    if (name == "or")
        return Refusal{"'or' cannot join conditions", "list the mode once more in `next`, with the other condition"};
    if (name == "not")
        return Refusal{"'not' cannot stand in a condition", "turn the comparison round: 'a <= b' for 'not a > b'"};
    return std::nullopt;
}

} // namespace graze
