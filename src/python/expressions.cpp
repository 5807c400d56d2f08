#include "graze/base/input_error.hpp"
#include "graze/symbolic/expression.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/piece_table.hpp"
#include "graze/symbolic/transform.hpp"
#include "python/binding.hpp"
#include "symbolic/subgraph.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace graze::python {

namespace {

/// Makes an expression again in another graph, operation by operation, so that it has that graph's order of operands.
Expression made_in(Graph& graph, const Expression& given) {
    if (given.graph().get() == &graph)
        return given;
    const Subgraph part = subgraph_of(std::span(&given, 1));
    std::vector<Expression> made;
    made.reserve(part.items.size());
    for (const Subgraph::Item& item : part.items) {
        const Node& node = part.node(item);
        if (node.operation == Operation::number)
            made.push_back(graph.number(node.value));
        else if (node.operation == Operation::symbol)
            made.push_back(graph.symbol(part.graph->symbol_name(node)));
        else if (arity(node.operation) == 1)
            made.push_back(graph.apply_as(*part.graph, node, made[item.left]));
        else
            made.push_back(graph.apply(node.operation, made[item.left], made[item.right]));
    }
    return made[part.roots.front()];
}

/// Whether an operation on the expression may be added to its own graph: the graph ends with it, so that it does not
/// grow with what is forgotten.
bool can_grow(const Expression& given) {
    return given.index() + 1 == given.graph()->size() && arity(given.operation()) > 0;
}

Expression applied(Operation operation, const Expression& one) {
    const std::shared_ptr<Graph> graph = can_grow(one) ? one.graph() : Graph::create();
    return graph->apply(operation, made_in(*graph, one));
}

/// Operands keep the order in which they are written, and long sums are not copied again and again.
Expression applied(Operation operation, const Expression& one, const Expression& other) {
    constexpr std::size_t large = 1000;
    const std::size_t size = other.graph()->size();
    if (size > large && size > 2 * one.graph()->size() && can_grow(other)) {
        const std::shared_ptr<Graph>& graph = other.graph();
        return graph->apply(operation, made_in(*graph, one), other);
    }
    const std::shared_ptr<Graph> graph = can_grow(one) ? one.graph() : Graph::create();
    const Expression left = made_in(*graph, one);
    return graph->apply(operation, left, made_in(*graph, other));
}

Expression number(double value) {
    return Graph::create()->number(value);
}

Expression symbol(const std::string& name) {
    if (is_reserved_name(name))
        throw InputError("'" + name + "' is a reserved name", "choose another name");
    if (!is_valid_name(name))
        throw InputError("'" + name + "' cannot be a name",
                         "names consist of letters, digits and underscores and do not start with a digit");
    return Graph::create()->symbol(name);
}

/// A table as Python holds it.
struct HeldTable {
    std::shared_ptr<const PieceTable> table;
};

constexpr std::array<const char*, 2> interpolations{"linear", "cubic"};
constexpr std::array<const char*, 3> beyond_ends{"hold", "linear", "error"};

template <class Words>
std::size_t place_of(const Words& words, const std::string& word, const char* what) {
    const auto place = std::ranges::find(words, word);
    if (place == words.end()) {
        std::string all;
        for (const char* one : words)
            all += std::string(all.empty() ? "" : one == words.back() ? " or " : ", ") + "'" + one + "'";
        throw InputError(std::string(what) + " '" + word + "' is not known", "give " + all);
    }
    return static_cast<std::size_t>(place - words.begin());
}

HeldTable held_table(const std::string& name, const std::vector<std::pair<double, double>>& points,
                     const std::string& interpolation, bool periodic, const std::string& outside,
                     const std::string& text) {
    symbol(name); // throws for what is no name
    std::vector<PieceTable::Point> made;
    made.reserve(points.size());
    for (const auto& [x, y] : points)
        made.push_back({x, y});
    const PieceTable::Options options{
        .interpolation =
            static_cast<PieceTable::Interpolation>(place_of(interpolations, interpolation, "the interpolation")),
        .periodic = periodic,
        .outside = static_cast<PieceTable::Outside>(place_of(beyond_ends, outside, "outside,"))};
    return {std::make_shared<const PieceTable>(name, std::move(made), options, text)};
}

py::tuple parts_of(const HeldTable& self) {
    py::list points;
    for (const PieceTable::Point& one : self.table->points())
        points.append(py::make_tuple(one.x, one.y));
    const PieceTable::Options& options = self.table->options();
    return py::make_tuple(self.table->name(), points, interpolations[static_cast<std::size_t>(options.interpolation)],
                          options.periodic, beyond_ends[static_cast<std::size_t>(options.outside)], self.table->text());
}

Expression looked_up(const HeldTable& self, const Expression& at) {
    // In a graph of its own: another expression of the given graph may look up another table of this name.
    const std::shared_ptr<Graph> graph = Graph::create();
    const Expression own = made_in(*graph, at);
    return graph->look_up(graph->add_table(self.table), 0, own);
}

std::vector<HeldTable> tables_of(const Expression& given) {
    const Subgraph part = subgraph_of(std::span(&given, 1));
    std::vector<HeldTable> tables;
    std::vector<bool> used(part.graph->tables().size());
    for (const Subgraph::Item& item : part.items)
        if (const Node& node = part.node(item); node.operation == Operation::lookup)
            used[Graph::lookup_of(node).table] = true;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i])
            tables.push_back({part.graph->tables()[i]});
    return tables;
}

Expression parsed(const std::string& text, const std::vector<std::string>& names,
                  const std::vector<HeldTable>& tables) {
    const auto graph = Graph::create();
    for (const HeldTable& one : tables)
        graph->add_table(one.table);
    Scope scope;
    for (const std::string& name : names)
        scope.emplace(name, graph->symbol(name));
    return parse_expression(*graph, text, scope);
}

void define_operator(py::class_<Expression>& type, Operation operation, const char* name, const char* reversed) {
    type.def(
        name, [operation](const Expression& one, const Expression& other) { return applied(operation, one, other); },
        py::is_operator());
    type.def(
        name, [operation](const Expression& one, double other) { return applied(operation, one, number(other)); },
        py::is_operator());
    type.def(
        reversed, [operation](const Expression& one, double other) { return applied(operation, number(other), one); },
        py::is_operator());
}

/// @param names of the method, and of those that numpy calls
void define_function(py::class_<Expression>& type, Operation operation, std::initializer_list<const char*> names) {
    for (const char* name : names)
        type.def(name, [operation](const Expression& one) { return applied(operation, one); });
}

/// Equal are expressions that one graph makes the same, whatever the order in which they were made.
bool are_equal(const Expression& one, const Expression& other) {
    const auto graph = Graph::create();
    const Expression left = made_in(*graph, one);
    return left == made_in(*graph, other);
}

/// The same for equal expressions: the order of the operands of sums and products does not matter.
std::size_t hash_of(const Expression& given) {
    const auto graph = Graph::create();
    const Expression own = made_in(*graph, given);
    const Subgraph part = subgraph_of(std::span(&own, 1));
    const auto mixed = [](std::size_t one, std::size_t other) {
        return (one ^ (other + 0x9e3779b97f4a7c15U + (one << 6U) + (one >> 2U))) * 0xff51afd7ed558ccdU;
    };
    std::vector<std::size_t> hashes;
    for (const Subgraph::Item& item : part.items) {
        const Node& node = part.node(item);
        const auto operation = static_cast<std::size_t>(node.operation);
        if (node.operation == Operation::number) {
            hashes.push_back(static_cast<std::size_t>(py::hash(py::float_(node.value))));
            continue;
        }
        if (node.operation == Operation::symbol) {
            hashes.push_back(mixed(operation, std::hash<std::string>()(part.graph->symbol_name(node))));
            continue;
        }
        const std::size_t left = hashes[item.left], right = arity(node.operation) == 2 ? hashes[item.right] : 0;
        const bool symmetric = node.operation == Operation::add || node.operation == Operation::multiply;
        hashes.push_back(symmetric ? mixed(operation, mixed(left, 1) + mixed(right, 1))
                                   : mixed(mixed(operation, left), right));
    }
    return hashes[part.roots.front()];
}

std::vector<std::string> names_in(const Expression& given) {
    std::vector<std::string> names;
    for (const Expression& one : symbols_of(std::array{given}))
        names.push_back(one.name());
    return names;
}

Expression derivative_of(const Expression& given, const Expression& by) {
    if (!by.is_symbol())
        throw InputError("'" + to_string(by) + "' is no symbol", "differentiate with respect to a state or parameter");
    const auto graph = Graph::create();
    const Expression own = made_in(*graph, given);
    return differentiate(own, graph->symbol(by.name()));
}

Expression with_replaced(const Expression& given, const std::vector<std::pair<std::string, Expression>>& values) {
    const auto graph = Graph::create();
    const Expression own = made_in(*graph, given);
    std::vector<Replacement> replacements;
    for (const auto& [name, value] : values)
        replacements.emplace_back(graph->symbol(name), made_in(*graph, value));
    return substitute(own, replacements);
}

} // namespace

void bind_expressions(py::module_& module) {
    auto type = py::class_<Expression>(module, "Expression");
    type.def(py::init(&symbol), py::arg("name"));
    define_operator(type, Operation::add, "__add__", "__radd__");
    define_operator(type, Operation::subtract, "__sub__", "__rsub__");
    define_operator(type, Operation::multiply, "__mul__", "__rmul__");
    define_operator(type, Operation::divide, "__truediv__", "__rtruediv__");
    define_operator(type, Operation::power, "__pow__", "__rpow__");
    define_function(type, Operation::negate, {"__neg__"});
    type.def("__pos__", [](const Expression& one) { return one; });
    // numpy's functions of the same names call these methods.
    define_function(type, Operation::sqrt, {"sqrt"});
    define_function(type, Operation::exp, {"exp"});
    define_function(type, Operation::log, {"log"});
    define_function(type, Operation::sin, {"sin"});
    define_function(type, Operation::cos, {"cos"});
    define_function(type, Operation::tan, {"tan"});
    define_function(type, Operation::asin, {"asin", "arcsin"});
    define_function(type, Operation::acos, {"acos", "arccos"});
    define_function(type, Operation::atan, {"atan", "arctan"});
    define_function(type, Operation::sinh, {"sinh"});
    define_function(type, Operation::cosh, {"cosh"});
    define_function(type, Operation::tanh, {"tanh"});
    define_function(type, Operation::erf, {"erf"});
    type.def("__str__", [](const Expression& one) { return to_string(one); });
    type.def("__eq__", &are_equal, py::is_operator());
    type.def(
        "__eq__", [](const Expression& one, double other) { return one.is_number(other); }, py::is_operator());
    type.def("__hash__", [](const Expression& one) { return static_cast<py::ssize_t>(hash_of(one)); });
    type.def("_derivative", &derivative_of, py::arg("by"));
    type.def("_substituted", &with_replaced, py::arg("values"));
    type.def_property_readonly("symbols", &names_in);
    type.def_property_readonly("_number", [](const Expression& one) {
        return one.is_number() ? py::object(py::float_(one.node().value)) : py::none();
    });
    type.def_property_readonly("_is_symbol", [](const Expression& one) { return one.is_symbol(); });

    py::class_<HeldTable>(module, "PieceTable")
        .def(py::init(&held_table), py::arg("name"), py::arg("points"), py::arg("interpolation"), py::arg("periodic"),
             py::arg("outside"), py::arg("text"))
        .def("look_up", &looked_up, py::arg("at"))
        .def(
            "value", [](const HeldTable& self, double x) { return self.table->value(x, 0); }, py::arg("x"))
        .def_property_readonly("parts", &parts_of);
    type.def_property_readonly("_tables", &tables_of);

    module.def("parsed_expression", &parsed, py::arg("text"), py::arg("names"),
               py::arg("tables") = std::vector<HeldTable>());
    module.def("symbol", &symbol, py::arg("name"));
    module.def("number", &number, py::arg("value"));
}

} // namespace graze::python
