// For any bytes, parsing gives either an expression that prints and parses back to itself, or one InputError.

#include "graze/base/input_error.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/transform.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace {

void require(bool holds, const char* what) {
    if (holds)
        return;
    std::fprintf(stderr, "violated: %s\n", what);
    std::abort();
}

void check_error(const graze::InputError& error, std::string_view text) {
    require(error.place().line >= 1 && error.place().column >= 1, "an error has a place");
    require(static_cast<std::size_t>(error.place().line) <= text.size() + 1, "the line of an error is in the text");
    require(static_cast<std::size_t>(error.place().column) <= text.size() + 1, "the column of an error is in the text");
    require(!error.problem().empty(), "an error says what is wrong");
    require(std::string_view(error.what()).find('\n') == std::string_view::npos, "an error is one line");
}

void check_expression(graze::Graph& graph, const graze::Expression& expression, const graze::Scope& scope) {
    std::string text;
    try {
        text = graze::to_string(expression);
    } catch (const graze::InputError&) {
        return; // shared subexpressions make the text too long
    }
    require(graze::parse_expression(graph, text, scope) == expression, "printed text parses back");
    const std::array inputs{scope.at("x"), scope.at("y")};
    const std::array outputs{expression, graze::differentiate(expression, inputs[0])};
    graze::Function(inputs, outputs)(std::array{0.7, -1.3});
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto graph = graze::Graph::create();
    const graze::Scope scope{{"x", graph->symbol("x")}, {"y", graph->symbol("y")}};
    try {
        check_expression(*graph, graze::parse_expression(*graph, text, scope), scope);
    } catch (const graze::InputError& error) {
        check_error(error, text);
    }
    try {
        for (const graze::Condition& condition : graze::parse_conditions(*graph, text, scope))
            check_expression(*graph, condition.function, scope);
    } catch (const graze::InputError& error) {
        check_error(error, text);
    }
    return 0;
}
