#include "graze/symbolic/transform.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/piece_table.hpp"

#include "symbolic/subgraph.hpp"
#include "symbolic/vocabulary.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string_view>

namespace graze {

namespace {

/// How tightly the parts of a text bind in the grammar of parse_expression, where -a*b is -(a*b).
enum class Binding { sum, minus, product, power, atom };

/// Texts longer than this are refused: sharing can make an expression exponentially longer than its graph.
constexpr double longest_text = 1 << 30;

class Printer {
public:
    explicit Printer(const Expression& expression) : graph_(*expression.graph()) {
        pending_.push_back({expression.index(), Binding::sum, {}});
    }

    std::string text() {
        while (!pending_.empty()) {
            const Pending next = pending_.back();
            pending_.pop_back();
            if (next.text.empty())
                print(next.index, next.least);
            else
                text_ += next.text;
        }
        return std::move(text_);
    }

private:
    /// A piece of text, or if that is empty a node, put in parentheses if it binds less tightly than `least`.
    struct Pending {
        NodeIndex index;
        Binding least;
        std::string_view text;
    };

    /// -3*x is read as -(3*x), which is the same node as (-3)*x unless the node is undefined.
    bool starts_with_minus(NodeIndex index) const {
        const Node& left = graph_.node(graph_.node(index).left);
        return left.operation == Operation::number && left.value < 0 && !graph_.is_undefined(index);
    }

    Binding binding(NodeIndex index) const {
        const Node& node = graph_.node(index);
        switch (node.operation) {
        case Operation::number:
            return node.value < 0 ? Binding::minus : Binding::atom;
        case Operation::add:
        case Operation::subtract:
            return Binding::sum;
        case Operation::negate:
            return Binding::minus;
        case Operation::multiply:
        case Operation::divide:
            return starts_with_minus(index) ? Binding::minus : Binding::product;
        case Operation::power:
            return Binding::power;
        default:
            return Binding::atom;
        }
    }

    void push(std::string_view text) { pending_.push_back({0, Binding::sum, text}); }
    void push(NodeIndex index, Binding least) { pending_.push_back({index, least, {}}); }

    void push_binary(const Node& node, Binding left, std::string_view text, Binding right) {
        push(node.right, right);
        push(text);
        push(node.left, left);
    }

    void push_call(const Node& node, std::string_view name, std::string_view primes) {
        push(")");
        push(node.left, Binding::sum);
        push("(");
        if (!primes.empty())
            push(primes);
        push(name);
    }

    void print(NodeIndex index, Binding least) {
        if (binding(index) < least) {
            text_ += '(';
            push(")");
        }
        const Node& node = graph_.node(index); // pieces are pushed in reverse order
        switch (node.operation) {
        case Operation::number:
            fmt::format_to(std::back_inserter(text_), "{}", node.value);
            break;
        case Operation::symbol:
            text_ += graph_.symbol_name(node);
            break;
        case Operation::add:
            return push_binary(node, Binding::sum, " + ", Binding::product);
        case Operation::subtract:
            return push_binary(node, Binding::sum, " - ", Binding::product);
        case Operation::multiply:
        case Operation::divide:
            return push_binary(node, starts_with_minus(index) ? Binding::minus : Binding::product,
                               node.operation == Operation::multiply ? "*" : "/", Binding::power);
        case Operation::power: {
            const Node& exponent = graph_.node(node.right);
            return push_binary(node, Binding::atom, "^",
                               exponent.operation == Operation::number ? Binding::minus : Binding::power);
        }
        case Operation::negate:
            push(node.left, Binding::product);
            push("-");
            break;
        case Operation::lookup: {
            const auto [table, derivative] = Graph::lookup_of(node);
            push_call(node, graph_.tables()[table]->name(),
                      std::string_view("'''").substr(0, static_cast<std::size_t>(derivative)));
            break;
        }
        default:
            push_call(node, function_name(node.operation), "");
        }
    }

    const Graph& graph_;
    std::vector<Pending> pending_;
    std::string text_;
};

/// Returns an upper estimate of the number of characters.
double text_length(const Expression& expression) {
    const Subgraph part = subgraph_of(std::span(&expression, 1));
    std::vector<double> lengths(part.items.size());
    for (std::size_t position = 0; position < lengths.size(); ++position) {
        const Subgraph::Item& item = part.items[position];
        const Node& node = part.node(item);
        if (node.operation == Operation::symbol)
            lengths[position] = static_cast<double>(part.graph->symbol_name(node).size());
        else if (node.operation == Operation::number)
            lengths[position] = 24;
        else
            lengths[position] =
                (node.operation == Operation::lookup
                     ? static_cast<double>(part.graph->tables()[Graph::lookup_of(node).table]->name().size() + 5)
                     : 6) +
                lengths[item.left] + (arity(node.operation) == 2 ? lengths[item.right] : 0);
    }
    return lengths.back();
}

} // namespace

std::string to_string(const Expression& expression) {
    if (text_length(expression) > longest_text)
        throw InputError("the text of an expression would be too long: it repeats shared parts", "");
    return Printer(expression).text();
}

} // namespace graze
