#include "graze/symbolic/expression.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/transform.hpp"
#include "python/binding.hpp"

#include <array>

namespace graze::python {

namespace {

using Pair = std::pair<Expression, Expression>;

/// Both expressions in one graph: the smaller graph is taken into the larger one.
Pair together(const Expression& one, const Expression& other) {
    if (one.graph() == other.graph())
        return {one, other};
    if (one.graph()->size() < other.graph()->size())
        return {other.graph()->adopt(one), other};
    return {one, one.graph()->adopt(other)};
}

template <Operation operation>
Expression applied(const Expression& one, const Expression& other) {
    const auto [left, right] = together(one, other);
    return left.graph()->apply(operation, left, right);
}

template <Operation operation>
void define_operator(py::class_<Expression>& type, const char* name, const char* reversed) {
    type.def(name, &applied<operation>, py::is_operator());
    type.def(
        name, [](const Expression& one, double other) { return applied<operation>(one, one.graph()->number(other)); },
        py::is_operator());
    type.def(
        reversed,
        [](const Expression& one, double other) { return applied<operation>(one.graph()->number(other), one); },
        py::is_operator());
}

template <Operation operation>
void define_function(py::class_<Expression>& type, const char* name, const char* of_numpy) {
    const auto apply = [](const Expression& one) { return one.graph()->apply(operation, one); };
    type.def(name, apply);
    if (of_numpy)
        type.def(of_numpy, apply);
}

} // namespace

void bind_expressions(py::module_& module) {
    auto type = py::class_<Expression>(module, "Expression");
    define_operator<Operation::add>(type, "__add__", "__radd__");
    define_operator<Operation::subtract>(type, "__sub__", "__rsub__");
    define_operator<Operation::multiply>(type, "__mul__", "__rmul__");
    define_operator<Operation::divide>(type, "__truediv__", "__rtruediv__");
    define_operator<Operation::power>(type, "__pow__", "__rpow__");
    define_function<Operation::negate>(type, "__neg__", nullptr);
    type.def("__pos__", [](const Expression& one) { return one; });
    // numpy's functions of the same names call these methods.
    define_function<Operation::sqrt>(type, "sqrt", nullptr);
    define_function<Operation::exp>(type, "exp", nullptr);
    define_function<Operation::log>(type, "log", nullptr);
    define_function<Operation::sin>(type, "sin", nullptr);
    define_function<Operation::cos>(type, "cos", nullptr);
    define_function<Operation::tan>(type, "tan", nullptr);
    define_function<Operation::asin>(type, "asin", "arcsin");
    define_function<Operation::acos>(type, "acos", "arccos");
    define_function<Operation::atan>(type, "atan", "arctan");
    define_function<Operation::sinh>(type, "sinh", nullptr);
    define_function<Operation::cosh>(type, "cosh", nullptr);
    define_function<Operation::tanh>(type, "tanh", nullptr);
    define_function<Operation::erf>(type, "erf", nullptr);
    type.def("__str__", [](const Expression& one) { return to_string(one); });
    type.def("__eq__", [](const Expression& one, const Expression& other) {
        const auto [left, right] = together(one, other);
        return left == right;
    });
    type.def("__hash__", [](const Expression& one) { return py::hash(py::str(to_string(one))); });
    type.def("derivative", [](const Expression& one, const Expression& symbol) {
        const auto [left, right] = together(one, symbol);
        return differentiate(left, right);
    });
    type.def_property_readonly("symbols", [](const Expression& one) {
        std::vector<std::string> names;
        for (const Expression& symbol : symbols_of(std::array{one}))
            names.push_back(symbol.name());
        return names;
    });

    module.def("parsed_expression", [](const std::string& text, const std::vector<std::string>& names) {
        const auto graph = Graph::create();
        Scope scope;
        for (const std::string& name : names)
            scope.emplace(name, graph->symbol(name));
        return parse_expression(*graph, text, scope);
    });
    module.def("symbol", [](const std::string& name) { return Graph::create()->symbol(name); });
    module.def("number", [](double value) { return Graph::create()->number(value); });
}

} // namespace graze::python
