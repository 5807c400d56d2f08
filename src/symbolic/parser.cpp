#include "graze/symbolic/parser.hpp"

#include "graze/base/name_list.hpp"
#include "graze/symbolic/piece_table.hpp"
#include "symbolic/lexer.hpp"
#include "symbolic/vocabulary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numbers>

namespace graze {

namespace {

using Kind = Token::Kind;

/// How tightly operators bind; an open parenthesis has the least precedence.
enum class Precedence { none, sum, minus, product, power };

struct BinaryOperator {
    Operation operation;
    Precedence precedence;
};

std::optional<BinaryOperator> binary_operator(Kind kind) {
    switch (kind) {
    case Kind::plus:
        return BinaryOperator{Operation::add, Precedence::sum};
    case Kind::minus:
        return BinaryOperator{Operation::subtract, Precedence::sum};
    case Kind::times:
        return BinaryOperator{Operation::multiply, Precedence::product};
    case Kind::divide:
        return BinaryOperator{Operation::divide, Precedence::product};
    case Kind::power:
        return BinaryOperator{Operation::power, Precedence::power};
    default:
        return std::nullopt;
    }
}

/// Operator-precedence parser with explicit stacks. It alternates between expecting an operand and expecting an
/// operator.
class Parser {
public:
    Parser(Graph& graph, const Source& source, const Scope& scope)
        : graph_(graph), source_(source), scope_(scope), lexer_(source), token_(lexer_.next()) {}

    /// Parses up to the end, or up to a comparison or `and` outside parentheses, which is then the current token.
    Expression expression();
    const Token& token() const { return token_; }
    Token advance();

private:
    /// An operator or open parenthesis whose right operand has not been read yet.
    struct Pending {
        enum class Kind { binary, negation, parenthesis, call } kind;
        Precedence precedence;
        Operation operation;   ///< of the operator, or of the function that is called
        Token token;           ///< the operator, the parenthesis or the function's name
        std::size_t table = 0; ///< that is looked up

        bool is_open() const { return precedence == Precedence::none; }
    };

    bool take_operand();
    bool take_operator();
    void take_name();
    /// Returns the index of a table of the graph, or the number of tables.
    std::size_t table_named(std::string_view name) const {
        const auto& tables = graph_.tables();
        return static_cast<std::size_t>(
            std::ranges::find_if(tables, [&](const auto& table) { return table->name() == name; }) - tables.begin());
    }
    void take_binary(BinaryOperator binary);
    void close_parenthesis();
    /// Applies pending operators that bind tighter than the next one, or equally tight if left-associative.
    void reduce(Precedence next, bool right_associative);
    bool ends_expression() const { return token_.kind >= Kind::less; }

    [[noreturn]] void refuse_name(const Token& name, bool is_call) const;
    [[noreturn]] void refuse_missing_operand() const;
    [[noreturn]] void refuse_missing_operator() const;
    [[noreturn]] void refuse_comma() const;
    [[noreturn]] void refuse_end() const;
    [[noreturn]] void refuse_unopened() const {
        source_.fail(token_.offset, "this ')' closes no parenthesis", "remove it or add the missing '('");
    }

    Graph& graph_;
    const Source& source_;
    const Scope& scope_;
    Lexer lexer_;
    Token token_;
    std::optional<Token> previous_;
    std::vector<Pending> pending_;
    std::vector<Expression> operands_;
};

Token Parser::advance() {
    previous_ = token_;
    token_ = lexer_.next();
    return *previous_;
}

Expression Parser::expression() {
    bool operand_due = true;
    while (operand_due || !ends_expression())
        operand_due = operand_due ? take_operand() : take_operator();
    reduce(Precedence::none, false);
    if (!pending_.empty())
        refuse_end();
    const Expression result = operands_.back();
    operands_.pop_back();
    return result;
}

/// Returns true when an operand is still expected.
bool Parser::take_operand() {
    switch (token_.kind) {
    case Kind::number:
        operands_.push_back(graph_.number(advance().value));
        return false;
    case Kind::name:
        take_name();
        return !pending_.empty() && pending_.back().kind == Pending::Kind::call && previous_->kind == Kind::open;
    case Kind::plus:
        advance();
        return true;
    case Kind::minus: {
        // In a*-b*c and a^-b*c the minus belongs to b alone: it binds as tightly as the operator before it.
        const Precedence before = pending_.empty() ? Precedence::none : pending_.back().precedence;
        pending_.push_back({Pending::Kind::negation, std::max(before, Precedence::minus), Operation::negate, token_});
        advance();
        return true;
    }
    case Kind::open:
        pending_.push_back({Pending::Kind::parenthesis, Precedence::none, Operation::number, token_});
        advance();
        return true;
    default:
        refuse_missing_operand();
    }
}

void Parser::take_name() {
    const Token name = advance();
    if (token_.kind == Kind::open) {
        const std::optional<Operation> function = function_named(name.text);
        const std::size_t table = function ? 0 : table_named(name.text);
        if (!function && table == graph_.tables().size())
            refuse_name(name, true);
        pending_.push_back({Pending::Kind::call, Precedence::none, function.value_or(Operation::lookup), name, table});
        advance();
        return;
    }
    const auto found = scope_.find(name.text);
    if (found != scope_.end()) {
        if (found->second.graph().get() != &graph_)
            throw InputError("'" + found->first + "' belongs to another graph than the one parsed into", "");
        operands_.push_back(found->second);
    } else if (name.text == "pi") {
        operands_.push_back(graph_.number(std::numbers::pi));
    } else {
        refuse_name(name, false);
    }
}

bool Parser::take_operator() {
    if (const std::optional<BinaryOperator> binary = binary_operator(token_.kind)) {
        take_binary(*binary);
        return true;
    }
    if (token_.kind == Kind::close)
        close_parenthesis();
    else if (token_.kind == Kind::comma)
        refuse_comma();
    else
        refuse_missing_operator();
    return false;
}

void Parser::take_binary(BinaryOperator binary) {
    reduce(binary.precedence, binary.operation == Operation::power);
    pending_.push_back({Pending::Kind::binary, binary.precedence, binary.operation, token_});
    advance();
}

void Parser::close_parenthesis() {
    reduce(Precedence::none, false);
    if (pending_.empty())
        refuse_unopened();
    const Pending opened = pending_.back();
    pending_.pop_back();
    if (opened.kind == Pending::Kind::call)
        operands_.back() = opened.operation == Operation::lookup ? graph_.look_up(opened.table, 0, operands_.back())
                                                                 : graph_.apply(opened.operation, operands_.back());
    advance();
}

void Parser::reduce(Precedence next, bool right_associative) {
    while (!pending_.empty()) {
        const Pending& top = pending_.back();
        if (top.is_open() || top.precedence < next || (top.precedence == next && right_associative))
            return;
        const Expression right = operands_.back();
        if (top.kind == Pending::Kind::binary) {
            operands_.pop_back();
            operands_.back() = graph_.apply(top.operation, operands_.back(), right);
        } else {
            operands_.back() = graph_.apply(top.operation, right);
        }
        pending_.pop_back();
    }
}

void Parser::refuse_name(const Token& name, bool is_call) const {
    const std::string text = quoted(name.text);
    if (is_call && (scope_.contains(name.text) || name.text == "pi"))
        source_.fail(name.offset, text + " is not a function", fmt::format("write {}*(...) for a product", name.text));
    if (!is_call && (function_named(name.text) || table_named(name.text) < graph_.tables().size()))
        source_.fail(name.offset, "the function " + text + " has no argument",
                     fmt::format("write {}(...), with parentheses", name.text));
    if (const std::optional<Refusal> refusal = refusal_of(name.text))
        source_.fail(name.offset, refusal->problem, refusal->remedy);
    std::vector<std::string> candidates;
    if (!is_call)
        for (const auto& [known, meaning] : scope_)
            candidates.push_back(known);
    if (is_call || candidates.empty())
        for (const FunctionName& function : function_names())
            candidates.emplace_back(function.name);
    if (is_call)
        for (const auto& table : graph_.tables())
            candidates.push_back(table->name());
    const std::string nearest = nearest_name(name.text, candidates);
    std::string remedy;
    if (!nearest.empty()) {
        remedy = fmt::format("did you mean '{}'?", nearest);
    } else if (is_call || !scope_.empty()) {
        remedy = fmt::format("known are {}", name_list(candidates, name.text));
    } else {
        remedy = "no names are known here: write a number";
    }
    source_.fail(name.offset, (is_call ? "unknown function " : "unknown name ") + text, remedy);
}

void Parser::refuse_missing_operand() const {
    if (token_.kind == Kind::end && !previous_)
        source_.fail(0, "the expression is empty", "write a number, a name or a formula");
    const bool inside = std::ranges::any_of(pending_, &Pending::is_open);
    if (token_.kind == Kind::close && !inside)
        refuse_unopened();
    const bool after_open = previous_ && previous_->kind == Kind::open;
    if (after_open && token_.kind == Kind::end)
        refuse_end();
    if (after_open && token_.kind == Kind::close) {
        const Token& opened = pending_.back().token;
        if (opened.kind == Kind::name)
            source_.fail(opened.offset, quoted(opened.text) + " takes one argument, not none",
                         "write its argument between the parentheses");
        source_.fail(opened.offset, "there is nothing between these parentheses", "remove them or fill them");
    }
    const bool begins = !previous_ || after_open || previous_->kind == Kind::conjunction;
    const bool left_missing = begins && token_.kind != Kind::end;
    const Token& lonely = left_missing ? token_ : *previous_;
    source_.fail(lonely.offset,
                 fmt::format("there is nothing to the {} of {}", left_missing ? "left" : "right", quoted(lonely.text)),
                 "add what is missing or remove it");
}

void Parser::refuse_missing_operator() const {
    if (token_.kind == Kind::name)
        if (token_.text == "or" || token_.text == "not")
            refuse_name(token_, false);
    const bool behind_number = previous_ && previous_->kind == Kind::number && token_.kind == Kind::name;
    source_.fail(token_.offset, fmt::format("an operator is missing before {}", quoted(token_.text)),
                 behind_number ? remedy_behind_number(previous_->text, token_.text)
                               : "write * for a product, or remove what does not belong here");
}

void Parser::refuse_comma() const {
    const auto opened = std::find_if(pending_.rbegin(), pending_.rend(), std::mem_fn(&Pending::is_open));
    if (opened != pending_.rend() && opened->kind == Pending::Kind::call)
        source_.fail(opened->token.offset, quoted(opened->token.text) + " takes one argument, not several",
                     "remove the others; decimals are written with a point");
    source_.fail(token_.offset, "unexpected ','", "decimals are written with a point");
}

void Parser::refuse_end() const {
    const Pending& opened = pending_.back();
    if (token_.is_comparison() || token_.kind == Kind::conjunction)
        source_.fail(token_.offset, quoted(token_.text) + " stands inside parentheses",
                     "conditions are comparisons joined by 'and', without parentheses around them");
    // A pending call stores the token of the function's name; the parenthesis follows it.
    const std::size_t offset =
        opened.kind == Pending::Kind::call ? source_.text.find('(', opened.token.offset) : opened.token.offset;
    source_.fail(offset, "this '(' is never closed", "add the missing ')'");
}

} // namespace

Expression parse_expression(Graph& graph, std::string_view text, const Scope& scope, const Place& place) {
    const Source source{text, place};
    Parser parser(graph, source, scope);
    const Expression result = parser.expression();
    const Token& rest = parser.token();
    if (rest.kind != Kind::end)
        source.fail(rest.offset, quoted(rest.text) + " cannot stand in an expression",
                    "comparisons belong in the conditions of transitions");
    return result;
}

std::vector<Condition> parse_conditions(Graph& graph, std::string_view text, const Scope& scope, const Place& place) {
    const Source source{text, place};
    Parser parser(graph, source, scope);
    std::vector<Condition> conditions;
    while (true) {
        const Expression left = parser.expression();
        if (!parser.token().is_comparison())
            source.fail(parser.token().offset, "a condition needs a comparison", "write for instance 'x > 0'");
        const Kind comparison = parser.advance().kind;
        const Expression right = parser.expression();
        const bool greater = comparison == Kind::greater || comparison == Kind::greater_equal;
        conditions.push_back(
            {greater ? left - right : right - left, comparison == Kind::greater || comparison == Kind::less});
        if (parser.token().kind == Kind::end)
            return conditions;
        if (parser.token().is_comparison())
            source.fail(parser.token().offset, "comparisons cannot be chained", "write 'a < b and b < c'");
        parser.advance(); // `and`
    }
}

bool is_valid_name(std::string_view name) {
    return !name.empty() && is_name_start(name.front()) && std::ranges::all_of(name, is_name_character) &&
           !is_reserved_name(name);
}

bool is_reserved_name(std::string_view name) {
    constexpr std::string_view words[] = {"pi", "t", "time", "and", "or", "not"};
    return function_named(name).has_value() || std::ranges::find(words, name) != std::end(words);
}

} // namespace graze
