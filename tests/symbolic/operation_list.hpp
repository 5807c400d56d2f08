#pragma once

#include "graze/symbolic/expression.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace graze::testing {

/// A value and a first-order bound on its error from rounding each operation once (by a few units in the last place).
struct Bounded {
    double value = 0;
    double bound = 0;
};

inline double error_function(double a) {
    return std::erf(a);
}
inline long double error_function(long double a) {
    return std::erf(a);
}
/// For a complex step, whose square is negligible.
inline std::complex<double> error_function(std::complex<double> a) {
    return {std::erf(a.real()), a.imag() * 2 / std::sqrt(std::numbers::pi) * std::exp(-a.real() * a.real())};
}

/// An unsimplified expression: a list of operations, evaluated by code that shares nothing with the library. The last
/// operation is the result.
struct OperationList {
    struct Item {
        Operation operation;
        std::size_t left = 0, right = 0; ///< positions; for a symbol, `left` is its index
        double value = 0;
    };
    std::vector<Item> items;

    /// Returns the operations on which a node of a graph depends; the first nodes of the graph are `symbols`.
    static OperationList of(const Expression& expression, std::span<const Expression> symbols) {
        OperationList list;
        for (NodeIndex index = 0; index <= expression.index(); ++index) {
            const Node& node = expression.graph()->node(index);
            Item item{node.operation, node.left, node.right, node.value};
            if (node.operation == Operation::symbol) {
                for (std::size_t symbol = 0; symbol < symbols.size(); ++symbol)
                    if (symbols[symbol].index() == index)
                        item.left = symbol;
            }
            list.items.push_back(item);
        }
        return list;
    }

    template <typename Value>
    static Value apply(Operation operation, const Value& a, const Value& b) {
        using std::sqrt, std::exp, std::log, std::sin, std::cos, std::tan, std::asin, std::acos, std::atan, std::sinh,
            std::cosh, std::tanh, std::pow;
        switch (operation) {
        case Operation::add:
            return a + b;
        case Operation::subtract:
            return a - b;
        case Operation::multiply:
            return a * b;
        case Operation::divide:
            return a / b;
        case Operation::power:
            return pow(a, b);
        case Operation::negate:
            return -a;
        case Operation::sqrt:
            return sqrt(a);
        case Operation::exp:
            return exp(a);
        case Operation::log:
            return log(a);
        case Operation::sin:
            return sin(a);
        case Operation::cos:
            return cos(a);
        case Operation::tan:
            return tan(a);
        case Operation::asin:
            return asin(a);
        case Operation::acos:
            return acos(a);
        case Operation::atan:
            return atan(a);
        case Operation::sinh:
            return sinh(a);
        case Operation::cosh:
            return cosh(a);
        case Operation::tanh:
            return tanh(a);
        case Operation::erf:
            return error_function(a);
        default:
            return a;
        }
    }

    /// Returns the largest slope of one operation with respect to each operand.
    static std::pair<double, double> slopes(Operation operation, double a, double b, double value) {
        switch (operation) {
        case Operation::add:
        case Operation::subtract:
            return {1, 1};
        case Operation::multiply:
            return {std::abs(b), std::abs(a)};
        case Operation::divide:
            return {std::abs(1 / b), std::abs(value / b)};
        case Operation::power:
            return {std::abs(b * std::pow(a, b - 1)),
                    a > 0 ? std::abs(value * std::log(a)) : std::numeric_limits<double>::infinity()};
        case Operation::sqrt:
            return {0.5 / value, 0};
        case Operation::exp:
            return {value, 0};
        case Operation::log:
            return {std::abs(1 / a), 0};
        case Operation::tan:
            return {1 + value * value, 0};
        case Operation::asin:
        case Operation::acos:
            return {1 / std::sqrt((1 - a) * (1 + a)), 0};
        case Operation::sinh:
            return {std::cosh(a), 0};
        case Operation::cosh:
            return {std::abs(std::sinh(a)), 0};
        case Operation::erf:
            return {2 / std::sqrt(std::numbers::pi), 0};
        default: // sin, cos, atan, tanh, negate
            return {1, 0};
        }
    }

    /// Returns value and round-off of the last operation; not finite if an earlier operation is not.
    Bounded evaluate(std::span<const double> symbols) const {
        std::vector<Bounded> results;
        for (const Item& item : items) {
            Bounded result;
            if (item.operation == Operation::number) {
                result.value = item.value;
            } else if (item.operation == Operation::symbol) {
                result.value = item.left < symbols.size() ? symbols[item.left] : 0;
            } else {
                const Bounded& a = results[item.left];
                const Bounded& b = arity(item.operation) == 2 ? results[item.right] : a;
                result.value = apply(item.operation, a.value, b.value);
                const auto [da, db] = slopes(item.operation, a.value, b.value, result.value);
                result.bound = std::numeric_limits<double>::epsilon() * std::abs(result.value);
                if (!std::isfinite(a.value) || !std::isfinite(b.value))
                    result.value = std::numeric_limits<double>::quiet_NaN();
                if (a.bound != 0)
                    result.bound += da * a.bound;
                // First-order bounds are meaningful only far from singularities.
                const bool linear = item.operation == Operation::add || item.operation == Operation::subtract ||
                                    item.operation == Operation::multiply || item.operation == Operation::negate;
                const bool bounded_domain = item.operation == Operation::asin || item.operation == Operation::acos;
                for (const Bounded& operand : {a, b}) {
                    const double from_zero = std::abs(operand.value);
                    const double from_end = bounded_domain ? std::abs(1 - from_zero) : 1;
                    if (!linear && operand.bound > 1e-3 * std::min({1.0, from_zero, from_end}))
                        result.bound = std::numeric_limits<double>::infinity();
                }
                if (arity(item.operation) == 2 && b.bound != 0)
                    result.bound += db * b.bound;
                if (item.operation == Operation::multiply) // the first-order terms vanish where both factors cancel
                    result.bound += a.bound * b.bound;
            }
            results.push_back(result);
        }
        return results.back();
    }

    /// Returns the derivative with respect to one symbol by a complex step, which does not suffer from cancellation.
    double derivative(std::span<const double> symbols, std::size_t symbol) const {
        constexpr double step = 1e-100;
        std::vector<std::complex<double>> results;
        for (const Item& item : items) {
            if (item.operation == Operation::number) {
                results.emplace_back(item.value, 0);
            } else if (item.operation == Operation::symbol) {
                results.emplace_back(symbols[item.left], item.left == symbol ? step : 0);
            } else {
                const auto& a = results[item.left];
                const auto& b = results[arity(item.operation) == 2 ? item.right : item.left];
                results.push_back(apply(item.operation, a, b));
            }
        }
        return results.back().imag() / step;
    }

    /// Builds the same expression by the operators of a graph.
    Expression build(Graph& graph, std::span<const Expression> symbols) const {
        std::vector<Expression> results;
        for (const Item& item : items) {
            if (item.operation == Operation::number)
                results.push_back(graph.number(item.value));
            else if (item.operation == Operation::symbol)
                results.push_back(symbols[item.left]);
            else if (arity(item.operation) == 1)
                results.push_back(graph.apply(item.operation, results[item.left]));
            else
                results.push_back(graph.apply(item.operation, results[item.left], results[item.right]));
        }
        return results.back();
    }

    /// Returns text with parentheses around every operation.
    std::string text(std::span<const Expression> symbols) const {
        std::vector<std::string> results;
        for (const Item& item : items) {
            const auto infix = [&](const char* sign) {
                return "(" + results[item.left] + sign + results[item.right] + ")";
            };
            static const char* const names[] = {"sqrt", "exp",  "log",  "sin",  "cos",  "tan", "asin",
                                                "acos", "atan", "sinh", "cosh", "tanh", "erf"};
            char number[40];
            switch (item.operation) {
            case Operation::number:
                std::snprintf(number, sizeof number, "(%.17g)", item.value);
                results.emplace_back(number);
                break;
            case Operation::symbol:
                results.push_back(symbols[item.left].name());
                break;
            case Operation::add:
                results.push_back(infix("+"));
                break;
            case Operation::subtract:
                results.push_back(infix("-"));
                break;
            case Operation::multiply:
                results.push_back(infix("*"));
                break;
            case Operation::divide:
                results.push_back(infix("/"));
                break;
            case Operation::power:
                results.push_back(infix("^"));
                break;
            case Operation::negate:
                results.push_back("(-" + results[item.left] + ")");
                break;
            default:
                results.push_back(names[static_cast<int>(item.operation) - static_cast<int>(Operation::sqrt)] +
                                  ("(" + results[item.left] + ")"));
            }
        }
        return results.back();
    }
};

/// Random trees: half of the leaves are symbols, the others numbers that trigger simplifications.
class RandomOperations {
public:
    /// @param functions number of functions that may occur (all 13, or none)
    RandomOperations(unsigned seed, std::size_t symbols, bool functions)
        : engine_(seed), symbols_(symbols), functions_(functions) {}

    OperationList next(std::size_t operations) {
        static constexpr double numbers[] = {0, 1, -1, 2, -2, 3, 0.5, -0.1, 0.3, 10, 1e16, -1e16, 1e-3};
        OperationList list;
        std::vector<std::size_t> roots; // of subtrees not yet used
        for (std::size_t leaf = 0; leaf < operations + 1; ++leaf) {
            roots.push_back(list.items.size());
            if (engine_() % 2)
                list.items.push_back({Operation::symbol, engine_() % symbols_, 0, 0});
            else
                list.items.push_back({Operation::number, 0, 0, numbers[engine_() % std::size(numbers)]});
        }
        while (roots.size() > 1 || engine_() % 4 == 0) {
            std::swap(roots[engine_() % roots.size()], roots.back());
            const std::size_t left = roots.back();
            roots.pop_back();
            OperationList::Item item{unary(), left, 0, 0};
            if (!roots.empty() && engine_() % 4 != 0) {
                std::swap(roots[engine_() % roots.size()], roots.back());
                item = {binary(), left, engine_() % 12 == 0 ? left : roots.back(), 0};
                if (item.right != left)
                    roots.pop_back();
            }
            roots.push_back(list.items.size());
            list.items.push_back(item);
        }
        return list;
    }

    double uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }

private:
    Operation binary() {
        static constexpr Operation operations[] = {Operation::add,      Operation::add,      Operation::subtract,
                                                   Operation::subtract, Operation::multiply, Operation::multiply,
                                                   Operation::divide,   Operation::power};
        return operations[engine_() % std::size(operations)];
    }
    Operation unary() {
        const auto first = static_cast<unsigned>(Operation::negate);
        return static_cast<Operation>(first + (functions_ && engine_() % 3 ? 1 + engine_() % 13 : 0));
    }

    std::mt19937 engine_;
    std::size_t symbols_;
    bool functions_;
};

} // namespace graze::testing
