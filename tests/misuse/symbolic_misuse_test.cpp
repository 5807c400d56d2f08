// Wrong uses of expressions, their functions and their texts.

#include "misuse/wrong_use.hpp"

#include "graze/base/file_name.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/text_file.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/transform.hpp"

namespace graze {
namespace {

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
        wrong(name + "_two_graphs", [function = function] {
            const Graphs g;
            keep(function(g.x, g.foreign));
        });
        wrong(name + "_no_such_node", [function = function] {
            const Graphs g;
            keep(function(g.x, Expression(g.graph, 99)));
        });
    }
    for (const auto& [kind, value] : not_finite()) {
        wrong("x_plus_" + kind, [value = value] { keep(Graphs().x + value); });
        wrong("x_minus_" + kind, [value = value] { keep(Graphs().x - value); });
        wrong("x_times_" + kind, [value = value] { keep(Graphs().x * value); });
        wrong("x_divided_by_" + kind, [value = value] { keep(Graphs().x / value); });
        wrong("plus_x_" + kind, [value = value] { keep(value + Graphs().x); });
        wrong("minus_x_" + kind, [value = value] { keep(value - Graphs().x); });
        wrong("times_x_" + kind, [value = value] { keep(value * Graphs().x); });
        wrong("over_x_" + kind, [value = value] { keep(value / Graphs().x); });
        wrong("pow_" + kind, [value = value] { keep(pow(Graphs().x, value)); });
        wrong("number_" + kind, [value = value] { keep(Graph::create()->number(value)); });
    }
    wrong("nothing_plus_number", [] { keep(Expression() + 1.0); });
    wrong("number_over_nothing", [] { keep(1.0 / Expression()); });
    wrong("nothing_to_a_power", [] { keep(pow(Expression(), 2.0)); });
    wrong("node_of_nothing", [] { keep(Expression().node().value); });
    wrong("operation_of_nothing", [] { keep(Expression().operation()); });
    wrong("is_number_of_nothing", [] { keep(Expression().is_number()); });
    wrong("is_symbol_of_nothing", [] { keep(Expression().is_symbol()); });
    wrong("name_of_nothing", [] { keep(std::string(Expression().name())); });
    wrong("name_of_a_number", [] {
        const Graphs g;
        keep(std::string(g.graph->number(2).name()));
    });
    wrong("name_of_a_sum", [] {
        const Graphs g;
        keep(std::string((g.x + g.y * 3.0).name()));
    });
    wrong("operation_of_a_moved_expression", [] {
        Graphs g;
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
        wrong("adopt_no_such_node_" + kind, [node] {
            const Graphs g;
            keep(g.graph->adopt(Expression(g.other, node)));
        });
    }
    wrong("adopt_nothing", [] { keep(Graph::create()->adopt({})); });
    for (const auto operation :
         {Operation::number, Operation::symbol, Operation::add, Operation::power, static_cast<Operation>(200)})
        wrong("apply_one_operand_" + std::to_string(static_cast<int>(operation)), [operation] {
            const Graphs g;
            keep(g.graph->apply(operation, g.x));
        });
    for (const auto operation :
         {Operation::number, Operation::symbol, Operation::sin, Operation::negate, static_cast<Operation>(200)})
        wrong("apply_two_operands_" + std::to_string(static_cast<int>(operation)), [operation] {
            const Graphs g;
            keep(g.graph->apply(operation, g.x, g.y));
        });
    wrong("apply_to_nothing", [] { keep(Graph::create()->apply(Operation::sin, Expression())); });
    wrong("arity_of_no_operation", [] { keep(arity(static_cast<Operation>(200))); });
    const auto frozen = [&wrong](const std::string& name, const std::function<void(Graphs&)>& use) {
        wrong("frozen_graph_" + name, [use] {
            Graphs g;
            g.graph->freeze();
            use(g);
        });
    };
    frozen("number", [](Graphs& g) { keep(g.graph->number(42)); });
    frozen("symbol", [](Graphs& g) { keep(g.graph->symbol("new")); });
    frozen("sum", [](Graphs& g) { keep(g.x + g.y); });
    frozen("adopt", [](Graphs& g) { keep(g.graph->adopt(sin(g.foreign))); });
    frozen("parse", [](Graphs& g) { keep(parse_expression(*g.graph, "x + 17", {{"x", g.x}})); });
    frozen("differentiate", [](Graphs& g) { keep(differentiate(g.x, g.y)); });
}

void functions(WrongUses& wrong) {
    struct Prepared : Graphs {
        Function function = Function(std::vector{x, y}, std::vector{x + y, x* y, sin(x)});
    };
    const auto make =
        [&wrong](const std::string& name,
                 const std::function<std::pair<std::vector<Expression>, std::vector<Expression>>(Graphs&)>& use) {
            wrong("function_" + name, [use] {
                Graphs g;
                const auto [inputs, outputs] = use(g);
                keep(Function(inputs, outputs));
            });
        };
    using List = std::vector<Expression>;
    make("input_nothing", [](Graphs& g) { return std::pair(List{g.none}, List{g.x}); });
    make("output_nothing", [](Graphs& g) { return std::pair(List{g.x}, List{g.none}); });
    make("all_nothing", [](Graphs& g) { return std::pair(List{g.none}, List{g.none}); });
    make("only_output_nothing", [](Graphs& g) { return std::pair(List{}, List{g.none}); });
    make("input_no_symbol", [](Graphs& g) { return std::pair(List{g.x + g.y}, List{g.x}); });
    make("input_twice", [](Graphs& g) { return std::pair(List{g.x, g.x}, List{g.x}); });
    make("input_missing", [](Graphs& g) { return std::pair(List{g.x}, List{g.y}); });
    make("output_of_another_graph", [](Graphs& g) { return std::pair(List{g.x}, List{g.foreign}); });
    make("outputs_of_two_graphs", [](Graphs& g) { return std::pair(List{g.x}, List{g.x, g.foreign}); });
    make("no_such_node", [](Graphs& g) { return std::pair(List{g.x}, List{Expression(g.graph, 99)}); });
    for (const auto& [kind, length] : wrong_lengths(2)) {
        const std::vector<double> inputs(length, 0.5);
        wrong("call_inputs_" + kind, [inputs] { keep(Prepared().function(inputs)); });
        wrong("evaluate_inputs_" + kind, [inputs] {
            const Prepared p;
            std::vector<double> results(3), work(p.function.workspace());
            p.function.evaluate(inputs, results, work);
        });
        wrong("error_bounds_inputs_" + kind, [inputs] {
            const Prepared p;
            std::vector<double> results(3), work(2 * p.function.workspace());
            p.function.error_bounds(inputs, std::vector<double>(2), results, work);
        });
        wrong("error_bounds_errors_" + kind, [inputs] {
            const Prepared p;
            std::vector<double> results(3), work(2 * p.function.workspace());
            p.function.error_bounds(std::vector<double>(2), inputs, results, work);
        });
    }
    for (const auto& [kind, length] : wrong_lengths(3)) {
        wrong("evaluate_results_" + kind, [length = length] {
            const Prepared p;
            std::vector<double> results(length), work(p.function.workspace());
            p.function.evaluate(std::vector<double>(2), results, work);
        });
        wrong("error_bounds_bounds_" + kind, [length = length] {
            const Prepared p;
            std::vector<double> results(length), work(2 * p.function.workspace());
            p.function.error_bounds(std::vector<double>(2), std::vector<double>(2), results, work);
        });
    }
    wrong("evaluate_work_too_short", [] {
        const Prepared p;
        std::vector<double> results(3), work(p.function.workspace() - 1);
        p.function.evaluate(std::vector<double>(2), results, work);
    });
    wrong("evaluate_work_empty", [] {
        const Prepared p;
        std::vector<double> results(3);
        p.function.evaluate(std::vector<double>(2), results, {});
    });
    wrong("error_bounds_work_too_short", [] {
        const Prepared p;
        std::vector<double> results(3), work(2 * p.function.workspace() - 1);
        p.function.error_bounds(std::vector<double>(2), std::vector<double>(2), results, work);
    });
    wrong("default_function_called_with_a_number", [] { keep(Function()(std::vector<double>{1.0})); });
    wrong("constant_value_of_nothing", [] { keep(constant_value({})); });
    wrong("constant_value_of_a_symbol", [] { keep(constant_value(Graphs().x)); });
    wrong("constant_value_of_no_node", [] { keep(constant_value(Expression(Graph::create(), 3))); });
}

void transforms(WrongUses& wrong) {
    const auto of = [&wrong](const std::string& name, const std::function<void(Graphs&)>& use) {
        wrong(name, [use] {
            Graphs g;
            use(g);
        });
    };
    of("differentiate_nothing", [](Graphs& g) { keep(differentiate(g.none, g.x)); });
    of("differentiate_by_nothing", [](Graphs& g) { keep(differentiate(g.x, g.none)); });
    of("differentiate_by_no_symbol", [](Graphs& g) { keep(differentiate(g.x, g.x * g.y)); });
    of("differentiate_by_a_number", [](Graphs& g) { keep(differentiate(g.x, g.graph->number(2))); });
    of("differentiate_by_a_symbol_of_another_graph", [](Graphs& g) { keep(differentiate(g.x, g.foreign)); });
    of("differentiate_list_with_nothing", [](Graphs& g) { keep(differentiate(std::vector{g.x, g.none}, g.x)); });
    of("differentiate_list_of_two_graphs", [](Graphs& g) { keep(differentiate(std::vector{g.x, g.foreign}, g.x)); });
    of("differentiate_empty_list_by_nothing",
       [](Graphs& g) { keep(differentiate(std::vector<Expression>{}, g.none)); });
    of("jacobian_by_nothing", [](Graphs& g) { keep(jacobian(std::vector{g.x}, std::vector{g.none})); });
    of("jacobian_by_no_symbol", [](Graphs& g) { keep(jacobian(std::vector{g.x}, std::vector{g.x * g.y})); });
    of("jacobian_by_a_symbol_of_another_graph",
       [](Graphs& g) { keep(jacobian(std::vector{g.x}, std::vector{g.foreign})); });
    of("jacobian_of_nothing", [](Graphs& g) { keep(jacobian(std::vector{g.none}, std::vector{g.x})); });
    const auto along = [&](const std::string& name, const std::function<Component(Graphs&)>& component) {
        of("differentiate_along_" + name,
           [component](Graphs& g) { keep(differentiate_along(std::vector{g.x}, std::vector{component(g)})); });
    };
    along("nothing", [](Graphs& g) { return Component(g.none, g.x); });
    along("no_component", [](Graphs& g) { return Component(g.x, g.none); });
    along("no_symbol", [](Graphs& g) { return Component(g.x * g.y, g.x); });
    along("another_graph", [](Graphs& g) { return Component(g.foreign, g.foreign); });
    along("component_of_another_graph", [](Graphs& g) { return Component(g.x, g.foreign); });
    of("differentiate_no_such_node", [](Graphs& g) { keep(differentiate(Expression(g.graph, 99), g.x)); });
    using Replacements = std::vector<Replacement>;
    of("substitute_in_nothing", [](Graphs& g) { keep(substitute(g.none, Replacements{{g.x, g.y}})); });
    of("substitute_for_nothing", [](Graphs& g) { keep(substitute(g.x, Replacements{{g.none, g.y}})); });
    of("substitute_by_nothing", [](Graphs& g) { keep(substitute(g.x, Replacements{{g.x, g.none}})); });
    of("substitute_for_no_symbol", [](Graphs& g) { keep(substitute(g.x, Replacements{{g.x + g.y, g.y}})); });
    of("substitute_by_another_graph", [](Graphs& g) { keep(substitute(g.x, Replacements{{g.x, g.foreign}})); });
    of("substitute_for_another_graph", [](Graphs& g) { keep(substitute(g.x, Replacements{{g.foreign, g.y}})); });
    of("substitute_twice_the_same", [](Graphs& g) {
        keep(substitute(g.x, Replacements{{g.x, g.y}, {g.x, 2.0 * g.y}}));
    });
    of("substitute_list_of_two_graphs", [](Graphs& g) {
        keep(substitute(std::vector{g.x, g.foreign}, Replacements{{g.x, g.y}}));
    });
    of("symbols_of_nothing", [](Graphs& g) { keep(symbols_of(std::vector{g.none})); });
    of("symbols_of_nothing_second", [](Graphs& g) { keep(symbols_of(std::vector{g.x, g.none})); });
    of("symbols_of_two_graphs", [](Graphs& g) { keep(symbols_of(std::vector{g.x, g.foreign})); });
    of("to_string_of_nothing", [](Graphs& g) { keep(to_string(g.none)); });
    of("to_string_of_no_such_node", [](Graphs& g) { keep(to_string(Expression(g.graph, 99))); });
}

void texts(WrongUses& wrong) {
    for (const std::string text :
         {"",          "  ",    "x +", "+",     "*x",     "(x",        "x)",  "()",  "sin", "sin()",
          "sin(x, x)", "1..2",  "1e",  "z",     "abs(x)", "max(x, 1)", "x^",  "x 2", "2x",  "#",
          "x = 1",     "1e999", "x,",  "pi(2)", "t",      "x > 0",     "and", "\xff"}) {
        wrong("parse_" + text, [text] {
            Graphs g;
            keep(parse_expression(*g.graph, text, {{"x", g.x}}));
        });
    }
    for (const std::string text : {"", "x", "x >", "> x", "x > 0 or x < 0", "x == 0", "x > 0 and", "and x > 0", "x > z",
                                   "0 < x < 1", "x >< 1", "x > 0, x < 1", "not x > 0"})
        wrong("parse_conditions_" + text, [text] {
            Graphs g;
            keep(parse_conditions(*g.graph, text, {{"x", g.x}}));
        });
    wrong("parse_with_nothing_in_scope", [] { keep(parse_expression(*Graph::create(), "x", {{"x", Expression()}})); });
    wrong("parse_sum_with_nothing_in_scope", [] {
        keep(parse_expression(*Graph::create(), "1 + x", {{"x", Expression()}}));
    });
    wrong("parse_with_another_graph_in_scope", [] {
        Graphs g;
        keep(parse_expression(*g.graph, "1 + x", {{"x", g.foreign}}));
    });
    wrong("parse_name_alone_with_another_graph_in_scope", [] {
        Graphs g;
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

std::vector<WrongUse> wrong_symbolic_uses() {
    WrongUses wrong;
    operators(wrong);
    graphs(wrong);
    functions(wrong);
    transforms(wrong);
    texts(wrong);
    return wrong.list();
}

TEST(WrongSymbolicUse, IsRefused) {
    each_of(wrong_symbolic_uses(), expect_refusal);
}

} // namespace
} // namespace graze
