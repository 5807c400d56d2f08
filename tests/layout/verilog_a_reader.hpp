#pragma once

// An evaluator of the subset of Verilog-A that a module with one analog block uses, independent of its writer.

#include <cctype>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace graze::testing {

class VerilogModule {
public:
    explicit VerilogModule(const std::string& text) {
        split(text);
        expect_words({"`include", "\"disciplines.vams\"", "module"});
        name = next();
        while (peek() != "parameter")
            next();
        while (peek() == "parameter")
            read_parameter();
        while (peek() != "analog")
            next();
        expect_words({"analog", "begin"});
        block_ = at_;
    }

    /// Contributions to flows, by "node" or "node,node", at given potentials; `ddt` counts as zero, and its argument is
    /// stored under the node that it contributes to.
    std::map<std::string, double> flows(const std::map<std::string, double>& potentials) {
        potentials_ = potentials;
        values_ = parameters;
        flows_.clear();
        at_ = block_;
        while (peek() != "end")
            statement(true);
        expect_words({"end", "endmodule"});
        return flows_;
    }

    std::string name;
    std::map<std::string, double> parameters, charges;

private:
    void split(const std::string& text) {
        for (std::size_t i = 0; i < text.size();) {
            const auto is_word = [&](char c) {
                return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.';
            };
            std::size_t end = i + 1;
            if (std::isspace(static_cast<unsigned char>(text[i]))) {
                i = end;
                continue;
            }
            if (text.compare(i, 2, "//") == 0) {
                i = text.find('\n', i);
                continue;
            }
            if (std::isdigit(static_cast<unsigned char>(text[i]))) {
                std::size_t used = 0;
                std::stod(text.substr(i, 40), &used);
                end = i + used;
            } else if (is_word(text[i]) || text[i] == '$' || text[i] == '`') {
                while (is_word(text[end]))
                    ++end;
            } else if (text[i] == '"') {
                end = text.find('"', end) + 1;
            } else if (text.compare(i, 2, "<+") == 0 || text.compare(i, 2, "<=") == 0 ||
                       text.compare(i, 2, ">=") == 0) {
                end = i + 2;
            }
            words_.push_back(text.substr(i, end - i));
            i = end;
        }
    }

    const std::string& peek() const { return words_.at(at_); }
    std::string next() { return words_.at(at_++); }
    bool take(const std::string& word) {
        const bool there = peek() == word;
        at_ += there ? 1 : 0;
        return there;
    }
    double in_parentheses() {
        expect_words({"("});
        const double inner = value();
        expect_words({")"});
        return inner;
    }
    void expect_words(const std::vector<std::string>& words) {
        for (const std::string& word : words)
            if (next() != word)
                throw std::runtime_error("no '" + word + "' before '" + peek() + "'");
    }

    void read_parameter() {
        expect_words({"parameter", "real"});
        const std::string which = next();
        expect_words({"="});
        values_ = parameters;
        parameters[which] = value();
        expect_words({"from"});
        while (!take(";"))
            next();
    }

    void statement(bool done) {
        if (take("if")) {
            const bool holds = in_parentheses() != 0;
            statement(done && holds);
            if (take("else"))
                statement(done && !holds);
            return;
        }
        const std::string word = next();
        if (word == "$bound_step") {
            in_parentheses();
        } else if (word == "I") {
            expect_words({"("});
            std::string node = next();
            while (take(","))
                node += "," + next();
            expect_words({")", "<+"});
            contributed_ = node;
            const double flow = value();
            if (done)
                flows_[node] += flow;
        } else {
            expect_words({"="});
            const double one = value();
            if (done)
                values_[word] = one;
        }
        expect_words({";"});
    }

    double value() {
        const double condition = comparison();
        if (!take("?"))
            return condition;
        const double yes = value();
        expect_words({":"});
        const double no = value();
        return condition != 0 ? yes : no;
    }
    double comparison() {
        const double left = sum();
        if (take("<"))
            return left < sum() ? 1 : 0;
        if (take(">"))
            return left > sum() ? 1 : 0;
        return left;
    }
    double sum() {
        double result = product();
        while (peek() == "+" || peek() == "-")
            result += next() == "+" ? product() : -product();
        return result;
    }
    double product() {
        double result = factor();
        while (peek() == "*" || peek() == "/") {
            const bool times = next() == "*";
            const double by = factor();
            result = times ? result * by : result / by;
        }
        return result;
    }
    double factor() {
        if (take("-"))
            return -factor();
        if (peek() == "(")
            return in_parentheses();
        const std::string word = next();
        if (std::isdigit(static_cast<unsigned char>(word[0])))
            return std::stod(word);
        if (!take("(")) {
            if (!values_.contains(word))
                throw std::runtime_error("nothing is called '" + word + "'");
            return values_.at(word);
        }
        if (word == "V") {
            double result = potentials_.at(next());
            if (take(","))
                result -= potentials_.at(next());
            expect_words({")"});
            return result;
        }
        const double inner = value();
        expect_words({")"});
        if (word == "ddt") {
            charges[contributed_] = inner;
            return 0;
        }
        if (word == "ln")
            return std::log(inner);
        if (word == "sqrt")
            return std::sqrt(inner);
        throw std::runtime_error("no function '" + word + "'");
    }

    std::vector<std::string> words_;
    std::size_t at_ = 0, block_ = 0;
    std::string contributed_;
    std::map<std::string, double> potentials_, values_, flows_;
};

} // namespace graze::testing
