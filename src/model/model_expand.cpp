#include "model/model_expand.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/model_validate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_set>

namespace graze {

/// Finds all definitions and dependent parameters on which given expressions depend, directly or not, by a walk without
/// recursion that visits each node once. Later calls report only those that are new.
class Abbreviations {
public:
    struct Item {
        Expression symbol, value;
        std::uint32_t level; ///< from 1; `value` depends only on lower levels
    };

    explicit Abbreviations(const Model& model) : graph_(*model.graph) {
        const auto know = [&](const std::string& name, const Expression& value) {
            require_graph(value);
            known_.emplace(model.symbol(name).index(), value);
        };
        for (const Definition& definition : model.definitions)
            know(definition.name, definition.value);
        for (const Parameter& parameter : model.parameters)
            if (parameter.expression)
                know(parameter.name, *parameter.expression);
    }

    /// True when the model has neither definitions nor dependent parameters.
    bool none() const { return known_.empty(); }

    /// Finds the abbreviations that no earlier call has found.
    void find(std::span<const Expression> expressions) {
        items_.clear();
        levels_.resize(graph_.size(), unvisited); // symbols created since the last call have new nodes
        for (const Expression& expression : expressions)
            if (circle_.empty())
                visit(expression);
        std::stable_sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) { return a.level < b.level; });
    }

    /// The abbreviations found, by level; incomplete when there is a circle.
    const std::vector<Item>& items() const { return items_; }
    /// Names in the first circle found, the first repeated at the end.
    const std::vector<std::string>& circle() const { return circle_; }

private:
    struct Visit {
        NodeIndex index;
        int operands_seen = 0;
    };
    static constexpr std::uint32_t unvisited = 0xffffffff;
    static constexpr std::uint32_t open = 0xfffffffe;

    /// Returns the operands of a node; the only operand of an abbreviation is its expression.
    std::span<const NodeIndex> operands(NodeIndex index, std::array<NodeIndex, 2>& space) const {
        const Node& node = graph_.node(index);
        space = {node.left, node.right};
        if (node.operation != Operation::symbol)
            return {space.data(), static_cast<std::size_t>(arity(node.operation))};
        const auto found = known_.find(index);
        if (found == known_.end())
            return {};
        space[0] = found->second.index();
        return {space.data(), 1};
    }

    void require_graph(const Expression& expression) const {
        if (expression.graph().get() != &graph_)
            throw InputError("an expression to expand does not belong to the graph of the model", "");
    }

    void visit(const Expression& expression) {
        require_graph(expression);
        if (levels_[expression.index()] != unvisited)
            return;
        std::vector<Visit> stack{{expression.index()}};
        levels_[expression.index()] = open;
        std::array<NodeIndex, 2> space{};
        while (!stack.empty()) {
            Visit& top = stack.back();
            const std::span<const NodeIndex> below = operands(top.index, space);
            if (top.operands_seen < static_cast<int>(below.size())) {
                const NodeIndex next = below[static_cast<std::size_t>(top.operands_seen++)];
                if (levels_[next] == open)
                    return note_circle(stack, next);
                if (levels_[next] == unvisited) {
                    levels_[next] = open;
                    stack.push_back({next});
                }
                continue;
            }
            std::uint32_t level = 0;
            for (const NodeIndex operand : below)
                level = std::max(level, levels_[operand]);
            if (const auto found = known_.find(top.index); found != known_.end())
                items_.push_back({{found->second.graph(), top.index}, found->second, ++level});
            levels_[top.index] = level;
            stack.pop_back();
        }
    }

    void note_circle(const std::vector<Visit>& stack, NodeIndex again) {
        auto visit = std::find_if(stack.begin(), stack.end(), [&](const Visit& v) { return v.index == again; });
        for (; visit != stack.end(); ++visit)
            if (known_.count(visit->index) != 0)
                circle_.push_back(graph_.symbol_name(graph_.node(visit->index)));
        circle_.push_back(circle_.front());
    }

    const Graph& graph_;
    std::vector<std::uint32_t> levels_; ///< for each node, the highest level on which it depends
    std::unordered_map<NodeIndex, Expression> known_;
    std::vector<Item> items_;
    std::vector<std::string> circle_;
};

std::string circle_text(const std::vector<std::string>& names) {
    constexpr std::size_t most = 8, ends = 3; // longer circles are shortened in messages
    if (names.size() <= most)
        return fmt::format("{}", fmt::join(names, " -> "));
    return fmt::format("{} -> ... ({} more) ... -> {}", fmt::join(names.begin(), names.begin() + ends, " -> "),
                       names.size() - 2 * ends, fmt::join(names.end() - ends, names.end(), " -> "));
}

std::vector<std::string> find_circle(const Model& model) {
    std::vector<Expression> all;
    for (const Definition& definition : model.definitions)
        all.push_back(model.symbol(definition.name));
    for (const Parameter& parameter : model.parameters)
        if (parameter.expression)
            all.push_back(model.symbol(parameter.name));
    Abbreviations abbreviations(model);
    abbreviations.find(all);
    return abbreviations.circle();
}

Expander::Expander(Model& model) : model_(model), abbreviations_(std::make_unique<Abbreviations>(model)) {}

Expander::~Expander() = default;

Expression Expander::expand(const Expression& expression) {
    return expand(std::span<const Expression>(&expression, 1)).front();
}

std::vector<Expression> Expander::replace(std::span<const Expression> wanted) const {
    std::vector<Replacement> replacements;
    for (const Expression& symbol : symbols_of(wanted))
        if (const auto found = values_.find(symbol.index()); found != values_.end())
            replacements.emplace_back(symbol, found->second);
    return substitute(wanted, replacements);
}

std::vector<Expression> Expander::expand(std::span<const Expression> given) {
    std::vector<Expression> expressions;
    for (const Expression& expression : given)
        expressions.push_back(model_.graph->adopt(expression));
    if (abbreviations_->none())
        return expressions;
    abbreviations_->find(expressions);
    if (!abbreviations_->circle().empty())
        throw InputError({model_.name, 0, 0},
                         "definitions refer to one another in a circle: " + circle_text(abbreviations_->circle()),
                         "define one of them without the others");
    // Replace level by level, so that parts shared by definitions are visited once.
    const auto& items = abbreviations_->items();
    for (std::size_t begin = 0; begin < items.size();) {
        std::vector<Expression> level;
        for (std::size_t i = begin; i < items.size() && items[i].level == items[begin].level; ++i)
            level.push_back(items[i].value);
        const std::vector<Expression> replaced = replace(level);
        for (const Expression& value : replaced)
            values_.emplace(items[begin++].symbol.index(), value);
    }
    return replace(expressions);
}

Expression Model::expand(const Expression& expression) {
    return Expander(*this).expand(expression);
}

std::vector<Expression> Model::expand(std::span<const Expression> expressions) {
    return Expander(*this).expand(expressions);
}

Function Model::function_of(std::span<const Expression> expressions) const {
    Model copy = *this; // since expanding appends to the graph
    const std::vector<Expression> inputs = copy.inputs(), outputs = copy.expand(expressions);
    copy.require_known(inputs, outputs);
    return {inputs, outputs};
}

Function Model::function_of_parameters(std::span<const Expression> expressions) const {
    // Often the expressions are thousands of numbers: without anything to expand, copying the model is not needed.
    const std::shared_ptr<Graph> own = Graph::create();
    std::vector<Expression> own_symbols, adopted;
    for (const std::string& parameter : independent_parameters())
        own_symbols.push_back(own->symbol(parameter));
    for (const Expression& expression : expressions)
        adopted.push_back(own->adopt(expression));
    const SymbolIndex inputs(own_symbols);
    const std::vector<Expression> symbols = symbols_of(adopted);
    if (std::all_of(symbols.begin(), symbols.end(), [&](const Expression& one) { return inputs.find(one.index()); }))
        return {inputs, adopted};
    Model copy = *this;
    const std::vector<Expression> outputs = copy.expand(expressions);
    copy.require_known(copy.parameter_symbols(), outputs);
    return {copy.parameter_symbols(), outputs};
}

void Model::require_known(std::span<const Expression> inputs, std::span<const Expression> expressions) const {
    std::unordered_set<NodeIndex> known;
    for (const Expression& input : inputs)
        if (input.graph() == graph)
            known.insert(input.index());
    for (const Expression& symbol : symbols_of(expressions)) {
        if (symbol.graph() == graph && known.contains(symbol.index()))
            continue;
        std::vector<std::string> names;
        for (const Expression& input : inputs)
            names.push_back(input.name());
        throw InputError(fmt::format("an expression contains '{}', which is not one of the model's", symbol.name()),
                         name_remedy(symbol.name(), names));
    }
}

std::vector<double> Model::values_of(std::span<const Expression> expressions) const {
    return function_of_parameters(expressions)(parameter_values());
}

} // namespace graze
