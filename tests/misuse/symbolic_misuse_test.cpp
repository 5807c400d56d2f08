// Wrong uses of expressions, their functions and their texts.

#include "misuse/wrong_use.hpp"

#include "graze/base/file_name.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/text_file.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/transform.hpp"

namespace graze::symbolic_misuse_test {

using namespace graze::testing;

using Unary = Expression (*)(const Expression&);
using Binary = Expression (*)(const Expression&, const Expression&);

std::vector<std::pair<std::string, Unary>> unary_functions() {
    return {{"negate", [](const Expression& a) { return -a; }},
            {"sqrt", sqrt},
            {"exp", exp},
            {"log", log},
            {"sin", sin},
            {"cos", cos},
            {"tan", tan},
            {"asin", asin},
            {"acos", acos},
            {"atan", atan},
            {"sinh", sinh},
            {"cosh", cosh},
            {"tanh", tanh},
            {"erf", erf}};
}
std::vector<std::pair<std::string, Binary>> binary_functions() {
    return {{"add", [](const Expression& a, const Expression& b) { return a + b; }},
            {"subtract", [](const Expression& a, const Expression& b) { return a - b; }},
            {"multiply", [](const Expression& a, const Expression& b) { return a * b; }},
            {"divide", [](const Expression& a, const Expression& b) { return a / b; }},
            {"pow", [](const Expression& a, const Expression& b) { return pow(a, b); }}};
}

/// Two separate expression graphs.
struct Graphs {
    std::shared_ptr<Graph> graph = Graph::create(), other = Graph::create();
    Expression x = graph->symbol("x"), y = graph->symbol("y"), foreign = other->symbol("x"), none;
};

void operators(WrongUses& wrong) {
    for (const auto& [name, function] : unary_functions()) {
        wrong(name + "_of_nothing", [function = function] { keep(function({})); });
        wrong(name + "_of_a_node_that_its_graph_does_not_have",
              [function = function] { keep(function(Expression(Graph::create(), 7))); });
    }
    for (const auto& [name, function] : binary_functions()) {
        wrong(name + "_nothing_left", [function = function] { keep(function({}, Graphs().x)); });
        wrong(name + "_nothing_right", [function = function] { keep(function(Graphs().x, {})); });
        wrong(name + "_nothing_at_all", [function = function] { keep(function({}, {})); });
        wrong(name + "_two_graphs", [function = function](Graphs& g) { keep(function(g.x, g.foreign)); });
        wrong(name + "_no_such_node",
              [function = function](Graphs& g) { keep(function(g.x, Expression(g.graph, 99))); });
    }
    wrong("x_plus", not_finite(), [](double value) { keep(Graphs().x + value); });
    wrong("x_minus", not_finite(), [](double value) { keep(Graphs().x - value); });
    wrong("x_times", not_finite(), [](double value) { keep(Graphs().x * value); });
    wrong("x_divided_by", not_finite(), [](double value) { keep(Graphs().x / value); });
    wrong("plus_x", not_finite(), [](double value) { keep(value + Graphs().x); });
    wrong("minus_x", not_finite(), [](double value) { keep(value - Graphs().x); });
    wrong("times_x", not_finite(), [](double value) { keep(value * Graphs().x); });
    wrong("over_x", not_finite(), [](double value) { keep(value / Graphs().x); });
    wrong("pow", not_finite(), [](double value) { keep(pow(Graphs().x, value)); });
    wrong("number", not_finite(), [](double value) { keep(Graph::create()->number(value)); });
    wrong("nothing_plus_number", [] { keep(Expression() + 1.0); });
    wrong("number_over_nothing", [] { keep(1.0 / Expression()); });
    wrong("nothing_to_a_power", [] { keep(pow(Expression(), 2.0)); });
    wrong("node_of_nothing", [] { keep(Expression().node().value); });
    wrong("operation_of_nothing", [] { keep(Expression().operation()); });
    wrong("is_number_of_nothing", [] { keep(Expression().is_number()); });
    wrong("is_symbol_of_nothing", [] { keep(Expression().is_symbol()); });
    wrong("name_of_nothing", [] { keep(std::string(Expression().name())); });
    wrong("name_of_a_number", [](Graphs& g) { keep(std::string(g.graph->number(2).name())); });
    wrong("name_of_a_sum", [](Graphs& g) { keep(std::string((g.x + g.y * 3.0).name())); });
    wrong("operation_of_a_moved_expression", [](Graphs& g) {
        const Expression moved = std::move(g.x);
        keep(g.x.operation());
    });
}

void graphs(WrongUses& wrong) {
    for (const auto& [kind, index] : wrong_indices(2)) {
        const auto node = static_cast<NodeIndex>(index);
        wrong("graph_node_" + kind, [node] { keep(Graphs().graph->node(node).value); });
        wrong("graph_is_undefined_" + kind, [node] { keep(Graphs().graph->is_undefined(node)); });
        wrong("graph_symbol_name_" + kind, [node] {
            keep(std::string(Graphs().graph->symbol_name({.operation = Operation::symbol, .left = node})));
        });
        wrong("adopt_no_such_node_" + kind, [node](Graphs& g) { keep(g.graph->adopt(Expression(g.other, node))); });
    }
    wrong("adopt_nothing", [] { keep(Graph::create()->adopt({})); });
    for (const auto operation :
         {Operation::number, Operation::symbol, Operation::add, Operation::power, static_cast<Operation>(200)})
        wrong("apply_one_operand_" + std::to_string(static_cast<int>(operation)),
              [operation](Graphs& g) { keep(g.graph->apply(operation, g.x)); });
    for (const auto operation :
         {Operation::number, Operation::symbol, Operation::sin, Operation::negate, static_cast<Operation>(200)})
        wrong("apply_two_operands_" + std::to_string(static_cast<int>(operation)),
              [operation](Graphs& g) { keep(g.graph->apply(operation, g.x, g.y)); });
    wrong("apply_to_nothing", [] { keep(Graph::create()->apply(Operation::sin, Expression())); });
    wrong("arity_of_no_operation", [] { keep(arity(static_cast<Operation>(200))); });
    struct Frozen : Graphs {
        Frozen() { graph->freeze(); }
    };
    wrong("frozen_graph_number", [](Frozen& g) { keep(g.graph->number(42)); });
    wrong("frozen_graph_symbol", [](Frozen& g) { keep(g.graph->symbol("new")); });
    wrong("frozen_graph_sum", [](Frozen& g) { keep(g.x + g.y); });
    wrong("frozen_graph_adopt", [](Frozen& g) { keep(g.graph->adopt(sin(g.foreign))); });
    wrong("frozen_graph_parse", [](Frozen& g) { keep(parse_expression(*g.graph, "x + 17", {{"x", g.x}})); });
    wrong("frozen_graph_differentiate", [](Frozen& g) { keep(differentiate(g.x, g.y)); });
}

void functions(WrongUses& wrong) {
    using Numbers = std::vector<double>;
    /// Two inputs, three outputs; methods are told how many numbers are given.
    struct Prepared : Graphs {
        Function function = Function(std::vector{x, y}, std::vector{x + y, x* y, sin(x)});
        std::size_t work = function.workspace();
        void evaluate(std::size_t inputs, std::size_t results, std::size_t space) const {
            Numbers result(results), scratch(space);
            function.evaluate(Numbers(inputs, 0.5), result, scratch);
        }
        void bounds(std::size_t inputs, std::size_t errors, std::size_t results, std::size_t space) const {
            Numbers result(results), scratch(space);
            function.error_bounds(Numbers(inputs, 0.5), Numbers(errors, 0.5), result, scratch);
        }
    };
    using List = std::vector<Expression>;
    wrong("function_input_nothing", [](Graphs& g) { keep(Function(List{g.none}, List{g.x})); });
    wrong("function_output_nothing", [](Graphs& g) { keep(Function(List{g.x}, List{g.none})); });
    wrong("function_all_nothing", [](Graphs& g) { keep(Function(List{g.none}, List{g.none})); });
    wrong("function_only_output_nothing", [](Graphs& g) { keep(Function(List{}, List{g.none})); });
    wrong("function_input_no_symbol", [](Graphs& g) { keep(Function(List{g.x + g.y}, List{g.x})); });
    wrong("function_input_twice", [](Graphs& g) { keep(Function(List{g.x, g.x}, List{g.x})); });
    wrong("function_input_missing", [](Graphs& g) { keep(Function(List{g.x}, List{g.y})); });
    wrong("function_output_of_another_graph", [](Graphs& g) { keep(Function(List{g.x}, List{g.foreign})); });
    wrong("function_outputs_of_two_graphs", [](Graphs& g) { keep(Function(List{g.x}, List{g.x, g.foreign})); });
    wrong("function_no_such_node", [](Graphs& g) { keep(Function(List{g.x}, List{Expression(g.graph, 99)})); });
    wrong("call_inputs", wrong_lengths(2), [](Prepared& p, std::size_t n) { keep(p.function(Numbers(n, 0.5))); });
    wrong("evaluate_inputs", wrong_lengths(2), [](Prepared& p, std::size_t n) { p.evaluate(n, 3, p.work); });
    wrong("error_bounds_inputs", wrong_lengths(2), [](Prepared& p, std::size_t n) { p.bounds(n, 2, 3, 2 * p.work); });
    wrong("error_bounds_errors", wrong_lengths(2), [](Prepared& p, std::size_t n) { p.bounds(2, n, 3, 2 * p.work); });
    wrong("evaluate_results", wrong_lengths(3), [](Prepared& p, std::size_t n) { p.evaluate(2, n, p.work); });
    wrong("error_bounds_bounds", wrong_lengths(3), [](Prepared& p, std::size_t n) { p.bounds(2, 2, n, 2 * p.work); });
    wrong("evaluate_work_too_short", [](Prepared& p) { p.evaluate(2, 3, p.work - 1); });
    wrong("evaluate_work_empty", [](Prepared& p) { p.evaluate(2, 3, 0); });
    wrong("error_bounds_work_too_short", [](Prepared& p) { p.bounds(2, 2, 3, 2 * p.work - 1); });
    wrong("default_function_called_with_a_number", [] { keep(Function()(std::vector<double>{1.0})); });
    wrong("constant_value_of_nothing", [] { keep(constant_value({})); });
    wrong("constant_value_of_a_symbol", [] { keep(constant_value(Graphs().x)); });
    wrong("constant_value_of_no_node", [] { keep(constant_value(Expression(Graph::create(), 3))); });
}

void transforms(WrongUses& wrong) {
    wrong("differentiate_nothing", [](Graphs& g) { keep(differentiate(g.none, g.x)); });
    wrong("differentiate_by_nothing", [](Graphs& g) { keep(differentiate(g.x, g.none)); });
    wrong("differentiate_by_no_symbol", [](Graphs& g) { keep(differentiate(g.x, g.x * g.y)); });
    wrong("differentiate_by_a_number", [](Graphs& g) { keep(differentiate(g.x, g.graph->number(2))); });
    wrong("differentiate_by_a_symbol_of_another_graph", [](Graphs& g) { keep(differentiate(g.x, g.foreign)); });
    wrong("differentiate_list_with_nothing", [](Graphs& g) { keep(differentiate(std::vector{g.x, g.none}, g.x)); });
    wrong("differentiate_list_of_two_graphs", [](Graphs& g) { keep(differentiate(std::vector{g.x, g.foreign}, g.x)); });
    wrong("differentiate_empty_list_by_nothing",
          [](Graphs& g) { keep(differentiate(std::vector<Expression>{}, g.none)); });
    wrong("jacobian_by_nothing", [](Graphs& g) { keep(jacobian(std::vector{g.x}, std::vector{g.none})); });
    wrong("jacobian_by_no_symbol", [](Graphs& g) { keep(jacobian(std::vector{g.x}, std::vector{g.x * g.y})); });
    wrong("jacobian_by_a_symbol_of_another_graph",
          [](Graphs& g) { keep(jacobian(std::vector{g.x}, std::vector{g.foreign})); });
    wrong("jacobian_of_nothing", [](Graphs& g) { keep(jacobian(std::vector{g.none}, std::vector{g.x})); });
    const auto along = [&](const std::string& name, const std::function<Component(Graphs&)>& component) {
        wrong("differentiate_along_" + name,
              [component](Graphs& g) { keep(differentiate_along(std::vector{g.x}, std::vector{component(g)})); });
    };
    along("nothing", [](Graphs& g) { return Component(g.none, g.x); });
    along("no_component", [](Graphs& g) { return Component(g.x, g.none); });
    along("no_symbol", [](Graphs& g) { return Component(g.x * g.y, g.x); });
    along("another_graph", [](Graphs& g) { return Component(g.foreign, g.foreign); });
    along("component_of_another_graph", [](Graphs& g) { return Component(g.x, g.foreign); });
    wrong("differentiate_no_such_node", [](Graphs& g) { keep(differentiate(Expression(g.graph, 99), g.x)); });
    using Replacements = std::vector<Replacement>;
    wrong("substitute_in_nothing", [](Graphs& g) { keep(substitute(g.none, Replacements{{g.x, g.y}})); });
    wrong("substitute_for_nothing", [](Graphs& g) { keep(substitute(g.x, Replacements{{g.none, g.y}})); });
    wrong("substitute_by_nothing", [](Graphs& g) { keep(substitute(g.x, Replacements{{g.x, g.none}})); });
    wrong("substitute_for_no_symbol", [](Graphs& g) { keep(substitute(g.x, Replacements{{g.x + g.y, g.y}})); });
    wrong("substitute_by_another_graph", [](Graphs& g) { keep(substitute(g.x, Replacements{{g.x, g.foreign}})); });
    wrong("substitute_for_another_graph", [](Graphs& g) { keep(substitute(g.x, Replacements{{g.foreign, g.y}})); });
    wrong("substitute_twice_the_same", [](Graphs& g) {
        keep(substitute(g.x, Replacements{{g.x, g.y}, {g.x, 2.0 * g.y}}));
    });
    wrong("substitute_list_of_two_graphs", [](Graphs& g) {
        keep(substitute(std::vector{g.x, g.foreign}, Replacements{{g.x, g.y}}));
    });
    wrong("symbols_of_nothing", [](Graphs& g) { keep(symbols_of(std::vector{g.none})); });
    wrong("symbols_of_nothing_second", [](Graphs& g) { keep(symbols_of(std::vector{g.x, g.none})); });
    wrong("symbols_of_two_graphs", [](Graphs& g) { keep(symbols_of(std::vector{g.x, g.foreign})); });
    wrong("to_string_of_nothing", [](Graphs& g) { keep(to_string(g.none)); });
    wrong("to_string_of_no_such_node", [](Graphs& g) { keep(to_string(Expression(g.graph, 99))); });
}

void texts(WrongUses& wrong) {
    for (const std::string text :
         {"",          "  ",    "x +", "+",     "*x",     "(x",        "x)",  "()",  "sin", "sin()",
          "sin(x, x)", "1..2",  "1e",  "z",     "abs(x)", "max(x, 1)", "x^",  "x 2", "2x",  "#",
          "x = 1",     "1e999", "x,",  "pi(2)", "t",      "x > 0",     "and", "\xff"}) {
        wrong("parse_" + text, [text](Graphs& g) { keep(parse_expression(*g.graph, text, {{"x", g.x}})); });
    }
    for (const std::string text : {"", "x", "x >", "> x", "x > 0 or x < 0", "x == 0", "x > 0 and", "and x > 0", "x > z",
                                   "0 < x < 1", "x >< 1", "x > 0, x < 1", "not x > 0"})
        wrong("parse_conditions_" + text, [text](Graphs& g) { keep(parse_conditions(*g.graph, text, {{"x", g.x}})); });
    wrong("parse_with_nothing_in_scope", [] { keep(parse_expression(*Graph::create(), "x", {{"x", Expression()}})); });
    wrong("parse_sum_with_nothing_in_scope", [] {
        keep(parse_expression(*Graph::create(), "1 + x", {{"x", Expression()}}));
    });
    wrong("parse_with_another_graph_in_scope", [](Graphs& g) {
        keep(parse_expression(*g.graph, "1 + x", {{"x", g.foreign}}));
    });
    wrong("parse_name_alone_with_another_graph_in_scope", [](Graphs& g) {
        keep(parse_expression(*g.graph, "x", {{"x", g.foreign}}));
    });
    wrong("conditions_with_nothing_in_scope", [] {
        keep(parse_conditions(*Graph::create(), "x > 0", {{"x", Expression()}}));
    });
    for (const std::string& name : {std::string(), std::string(".x"), std::string("-x"), std::string("../x"),
                                    std::string("a b"), std::string(200, 'a'), std::string("a\0b", 3)})
        wrong("require_file_name_" + name.substr(0, 9), [name] { require_file_name(name, "name", {}); });
    wrong("require_plain_line_two_lines", [] { require_plain_line("a\nb", "title", {}); });
    wrong("require_plain_line_no_utf8", [] { require_plain_line("\xff", "title", {}); });
    wrong("require_plain_line_too_long", [] { require_plain_line(std::string(20000, 'a'), "title", {}); });
    wrong("shortened_to_nothing", [] { keep(shortened(std::string(500, 'a'), 0)); });
    wrong("shortened_to_too_little", [] { keep(shortened(std::string(500, 'a'), 10)); });
    wrong("read_no_file", [] { keep(read_text_file("/no/such/file", "file", 1000)); });
    wrong("read_empty_path", [] { keep(read_text_file("", "file", 1000)); });
    wrong("read_folder", [] { keep(read_text_file("/tmp", "file", 1000)); });
    wrong("read_device", [] { keep(read_text_file("/dev/zero", "file", 1000)); });
    wrong("read_too_long", [] { keep(read_text_file("/etc/passwd", "file", 1)); });
}

TEST(WrongSymbolicUse, IsRefused) {
    expect_refusals({operators, graphs, functions, transforms, texts});
}

} // namespace graze::symbolic_misuse_test
