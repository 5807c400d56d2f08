#include "graze/symbolic/parser.hpp"

#include "graze/symbolic/function.hpp"
#include "graze/symbolic/transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::parser_test {

class ParserTest : public ::testing::Test {
protected:
    std::shared_ptr<Graph> graph = Graph::create();
    Expression x = graph->symbol("x"), y = graph->symbol("y");
    Scope scope{{"x", x}, {"y", y}, {"amplitude", graph->symbol("amplitude")}, {"V0", graph->symbol("V0")}};

    Expression parse(std::string_view text) { return parse_expression(*graph, text, scope); }
    double constant(std::string_view text) { return constant_value(parse(text)); }

    void expect_error(std::string_view text, int line, int column, const std::string& problem,
                      const std::string& remedy, bool conditions = false) {
        try {
            if (conditions)
                parse_conditions(*graph, text, scope, {"model.toml", 7, 11});
            else
                parse_expression(*graph, text, scope, {"model.toml", 7, 11});
            ADD_FAILURE() << "accepted: " << text;
        } catch (const InputError& error) {
            EXPECT_EQ(error.place().file, "model.toml");
            EXPECT_EQ(error.place().line, line) << text << ": " << error.what();
            EXPECT_EQ(error.place().column, column) << text << ": " << error.what();
            EXPECT_NE(error.problem().find(problem), std::string::npos) << text << ": " << error.what();
            EXPECT_NE(error.remedy().find(remedy), std::string::npos) << text << ": " << error.what();
        }
    }
    /// For a text that begins in line 7, column 11; `offset` counts characters from the text's beginning.
    void expect_error_at(std::string_view text, int offset, const std::string& problem, const std::string& remedy) {
        expect_error(text, 7, 11 + offset, problem, remedy);
    }
    void expect_condition_error(std::string_view text, int offset, const std::string& problem,
                                const std::string& remedy) {
        expect_error(text, 7, 11 + offset, problem, remedy, true);
    }
};

TEST_F(ParserTest, PrecedenceAndAssociativityHold) {
    constexpr std::pair<const char*, double> cases[] = {
        {"1 + 2*3", 7},  {"(1 + 2)*3", 9}, {"8 - 4 - 2", 2}, {"8/4/2", 1},        {"8/4*2", 4},
        {"2^3^2", 512},  {"-2^2", -4},     {"(-2)^2", 4},    {"2^-2", 0.25},      {"2^-2*3", 0.75},
        {"2^-1^2", 0.5}, {"2*-3 + 1", -5}, {"6/-3*2", -4},   {"6/-3^2*3", -2},    {"1 - -2*3", 7},
        {"--3", 3},      {"2---3", -1},    {"+3 + +4", 7},   {"-(1 + 2) + 4", 1}, {"2*(3 + 4)^2", 98}};
    for (const auto& [text, value] : cases)
        EXPECT_EQ(constant(text), value) << text;
    EXPECT_EQ(parse("-x*y"), -(x * y));
    EXPECT_EQ(parse("x^-y"), pow(x, -y));
    EXPECT_EQ(parse("x - y + 1"), x - y + 1);
}

TEST_F(ParserTest, NumbersNamesAndFunctionsAreRead) {
    constexpr std::pair<const char*, double> cases[] = {{"1.5e-3", 1.5e-3},
                                                        {".5", 0.5},
                                                        {"5.", 5},
                                                        {"1E+2", 100},
                                                        {"pi", std::numbers::pi},
                                                        {" \t(\r\n 1\n+ 1 ) ", 2},
                                                        {"sqrt(16) + log(exp(1))", 5}};
    for (const auto& [text, value] : cases)
        EXPECT_EQ(constant(text), value) << text;
    EXPECT_EQ(parse("sin(x)*cos(y)"), sin(x) * cos(y));
    EXPECT_EQ(parse("tan(asin(acos(atan(sinh(cosh(tanh(x)))))))"), tan(asin(acos(atan(sinh(cosh(tanh(x))))))));
    EXPECT_EQ(parse("erf(x/2)"), erf(x / 2));
    EXPECT_EQ(to_string(parse("1 - erf(x/2)*y")), "1 - y*erf(x/2)");
    EXPECT_EQ(parse("V0*amplitude"), scope.at("V0") * scope.at("amplitude"));
    EXPECT_EQ(parse("sin (x)"), sin(x));
    // A name has the meaning given by the scope, for instance a definition.
    scope.insert_or_assign("gap", x - y);
    EXPECT_EQ(parse("2*gap"), 2 * (x - y));
}

TEST_F(ParserTest, UnknownNamesAreRefusedWithTheNearest) {
    expect_error_at("2*ampltude + x", 2, "unknown name 'ampltude'", "did you mean 'amplitude'?");
    expect_error_at("v0", 0, "unknown name 'v0'", "did you mean 'V0'?");
    expect_error_at("x + V", 4, "unknown name 'V'", "did you mean 'V0'?");
    expect_error_at("x + omega", 4, "unknown name 'omega'", "known are V0, amplitude, x, y");
    expect_error_at("sine(x)", 0, "unknown function 'sine'", "did you mean 'sin'?");
    expect_error_at("bessel(x)", 0, "unknown function 'bessel'", "known are sqrt, exp");
    expect_error_at("1 + x(2)", 4, "'x' is not a function", "write x*(...)");
    expect_error_at("pi(2)", 0, "'pi' is not a function", "pi*(...)");
    expect_error_at("sin x", 0, "the function 'sin' has no argument", "sin(...)");
    expect_error_at("x*exp", 2, "the function 'exp' has no argument", "exp(...)");
    scope.clear();
    expect_error_at("a", 0, "unknown name 'a'", "");
}

TEST_F(ParserTest, NonAnalyticAndForeignNamesAreRefused) {
    for (const char* name :
         {"abs", "sign", "sgn", "min", "max", "if", "floor", "ceil", "round", "mod", "step", "heaviside", "atan2"}) {
        expect_error_at(std::string("1 + ") + name + "(x, y)", 4, "is not analytic", "event");
        expect_error_at(std::string("1 + ") + name, 4, "is not analytic", "two modes");
    }
    expect_error_at("cos(2*pi*t)", 9, "time ('t')", "state with a constant rate");
    expect_error_at("time*x", 0, "time ('time')", "phase");
    expect_error_at("ln(x)", 0, "'ln' is not a known function", "write log(x)");
    expect_error_at("pow(x, 2)", 0, "'pow' is not a known function", "write a^b");
    expect_error_at("x or y", 2, "'or' cannot join", "the mode once more");
}

TEST_F(ParserTest, UnbalancedParenthesesAreRefused) {
    expect_error_at("(x + y", 0, "this '(' is never closed", "add the missing ')'");
    expect_error_at("x*(x + (y)", 2, "this '(' is never closed", "");
    expect_error_at("((x)", 0, "this '(' is never closed", "");
    expect_error_at("((x", 1, "this '(' is never closed", "");
    expect_error_at("1 + sin (x", 8, "this '(' is never closed", "");
    expect_error_at("2*(", 2, "this '(' is never closed", "");
    expect_error_at("x + y)", 5, "this ')' closes no parenthesis", "remove it");
    expect_error_at("(x))*(y)", 3, "this ')' closes no parenthesis", "");
    expect_error_at(")", 0, "this ')' closes no parenthesis", "");
    expect_error_at("x + )", 4, "this ')' closes no parenthesis", "");
    expect_error_at("x*()", 2, "nothing between", "");
    expect_error_at("[x]", 0, "unexpected character '['", "write (");
}

TEST_F(ParserTest, WrongNumbersOfArgumentsAreRefused) {
    expect_error_at("1 + sin()", 4, "'sin' takes one argument, not none", "");
    expect_error_at("1 + sin(x, y)", 4, "'sin' takes one argument, not several", "");
    expect_error_at("sin((x), y)", 0, "'sin' takes one argument, not several", "");
    expect_error_at("sin((x, y))", 6, "unexpected ','", "point");
    expect_error_at("1,5*x", 1, "unexpected ','", "point");
}

TEST_F(ParserTest, MalformedNumbersAreRefused) {
    expect_error_at("x + 1.2.3", 4, "malformed number '1.2.3'", "");
    expect_error_at("1e", 0, "malformed number '1e'", "1e-3");
    expect_error_at("1e+", 0, "malformed number '1e+'", "");
    expect_error_at(".", 0, "malformed number '.'", "");
    expect_error_at("2x", 0, "malformed number '2x'", "write 2*x");
    expect_error_at("0x1F", 0, "malformed number '0x1F'", "write numbers as");
    expect_error_at("1_000", 0, "malformed number '1_000'", "");
    expect_error_at("x + 1e999", 4, "outside the range", "scale");
    expect_error_at("1e-999", 0, "outside the range", "scale");
}

TEST_F(ParserTest, MissingAndSuperfluousPartsAreRefused) {
    expect_error_at("", 0, "the expression is empty", "");
    expect_error(" \n ", 7, 11, "the expression is empty", "");
    expect_error_at("x +", 2, "nothing to the right of '+'", "");
    expect_error_at("x*/y", 1, "nothing to the right of '*'", "");
    expect_error_at("-", 0, "nothing to the right of '-'", "");
    expect_error_at("*x", 0, "nothing to the left of '*'", "");
    expect_error_at("(*x)", 1, "nothing to the left of '*'", "");
    expect_error_at("(x + )", 3, "nothing to the right of '+'", "");
    expect_error_at("x y", 2, "an operator is missing before 'y'", "write *");
    expect_error_at("2 (x)", 2, "an operator is missing before '('", "");
    expect_error_at("(x)(y)", 3, "an operator is missing before '('", "");
    expect_error_at("x 3", 2, "an operator is missing before '3'", "");
    expect_error_at("x > y", 2, "'>' cannot stand in an expression", "conditions");
    expect_error_at("x and y", 2, "'and' cannot stand in an expression", "");
    expect_error_at("(x > y)", 3, "'>' stands inside parentheses", "");
}

/// A unit after a number is not a factor: the remedy must not suggest a product, which would be refused too.
TEST_F(ParserTest, UnitsAfterNumbersAreRefused) {
    expect_error_at("0.5um", 0, "malformed number '0.5um'", "write 0.5 alone, in the unit that is meant there");
    expect_error_at("169e9 Pa", 6, "an operator is missing before 'Pa'", "write 169e9 alone");
    expect_error_at("2foo", 0, "malformed number '2foo'", "write 2*foo for a product");
    expect_error_at("2 foo", 2, "an operator is missing before 'foo'", "write 2*foo for a product");
}

TEST_F(ParserTest, OtherSpellingsAreRefusedWithAPlainForm) {
    expect_error_at("x**2", 1, "'**' is not an operator", "a^b");
    expect_error_at("x = 2", 2, "unexpected '='", "right-hand side");
    expect_error_at("x == 2", 2, "'==' cannot be tested", "inequality");
    expect_error_at("x != 2", 2, "'!=' cannot be tested", "inequality");
    expect_error_at("x % 2", 2, "'%' is not analytic", "cyclic");
    expect_error_at("x && y", 2, "unexpected '&&'", "write 'and'");
    expect_error_at("x || y", 2, "'||' cannot join", "the mode once more");
    expect_error_at("!x", 0, "'!'", "turn the comparison round");
    expect_error_at("x # comment", 2, "unexpected character '#'", "");
    expect_error_at("x; y", 1, "unexpected character ';'", "");
}

TEST_F(ParserTest, OddBytesGiveCleanErrors) {
    expect_error_at("x \u2212 y", 2, "unexpected character '\u2212'", "write -");
    expect_error_at("2\u00b7x", 1, "unexpected character '\u00b7'", "write *");
    expect_error_at("\u03c0", 0, "unexpected character '\u03c0'", "write pi");
    expect_error_at("x +\u00a0y", 3, "unexpected character", "ordinary space");
    expect_error_at("x + \U0001F600", 4, "unexpected character", "");
    expect_error_at("x\xff", 1, "unexpected byte 0xff", "");
    expect_error_at("x\xe2\x88", 1, "unexpected byte 0xe2", "");
    expect_error_at("\x80", 0, "unexpected byte 0x80", "");
    expect_error_at(std::string_view("x\0y", 3), 1, "unexpected byte 0x00", "");
    expect_error_at("x\x1b", 1, "unexpected byte 0x1b", "");
    expect_error_at(std::string(1000, 'q'), 0, "'qqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqq...'", "");
}

TEST_F(ParserTest, PlacesCountLinesAndCharacters) {
    expect_error("x +\n  foo", 8, 3, "unknown name 'foo'", "");
    expect_error("x +\r\n\n\ty*qux", 9, 4, "unknown name 'qux'", "");
    expect_error("(x +\n  y", 7, 11, "never closed", "");
    try {
        parse_expression(*graph, "x +\nfoo", scope);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.place().text(), "2:1") << "without a place, lines and columns of the text itself";
    }
}

TEST_F(ParserTest, ConditionsAreRead) {
    EXPECT_EQ(parse_conditions(*graph, "x > y and x*y <= 2 and -1 < x and x >= 0", scope),
              (std::vector<Condition>{{x - y, true}, {2 - x * y, false}, {x + 1, true}, {x, false}}));
}

TEST_F(ParserTest, MalformedConditionsAreRefused) {
    expect_condition_error("", 0, "empty", "");
    expect_condition_error("x", 1, "a condition needs a comparison", "x > 0");
    expect_condition_error("x and y > 0", 2, "a condition needs a comparison", "");
    expect_condition_error("x > 0 and", 6, "nothing to the right of 'and'", "");
    expect_condition_error("and x > 0", 0, "nothing to the left of 'and'", "");
    expect_condition_error("x > 0 and and y > 0", 10, "nothing to the left of 'and'", "");
    expect_condition_error("x >", 2, "nothing to the right of '>'", "");
    expect_condition_error("> 0", 0, "nothing to the left of '>'", "");
    expect_condition_error("0 < x < 1", 6, "comparisons cannot be chained", "a < b and b < c");
    expect_condition_error("(x > 0) and y > 0", 3, "'>' stands inside parentheses", "");
    expect_condition_error("x == 0", 2, "'==' cannot be tested", "event");
    expect_condition_error("x != 0", 2, "'!=' cannot be tested", "event");
    expect_condition_error("x > 0 or y > 0", 6, "'or' cannot join", "the mode once more");
    expect_condition_error("not x > 0", 0, "'not' cannot stand", "turn the comparison round");
    expect_condition_error("x > 0 && y > 0", 6, "unexpected '&&'", "write 'and'");
    expect_condition_error("x > 0)", 5, "closes no parenthesis", "");
}

TEST_F(ParserTest, AScopeOfAnotherGraphThrows) {
    const Scope foreign{{"x", Graph::create()->symbol("x")}};
    EXPECT_THROW(parse_expression(*graph, "x", foreign), InputError);
}

TEST_F(ParserTest, DeepNestingNeedsNoStack) {
    for (const std::size_t depth : {10000u, 1000000u}) {
        EXPECT_EQ(parse(std::string(depth, '(') + "x" + std::string(depth, ')')), x);
        EXPECT_EQ(parse(std::string(depth, '-') + "x"), x);
        expect_error_at(std::string(depth, '('), static_cast<int>(depth) - 1, "never closed", "");
    }
    constexpr std::size_t depth = 10000;
    std::string nested_calls, nested_sums, towers;
    for (std::size_t level = 0; level < depth; ++level) {
        nested_calls += "sin(";
        nested_sums += "x + y*(";
        towers += "x^";
    }
    nested_calls += "x" + std::string(depth, ')');
    nested_sums += "x" + std::string(depth, ')');
    towers += "x";
    for (const std::string& text : {nested_calls, nested_sums, towers}) {
        const auto fresh = Graph::create();
        const Scope names{{"x", fresh->symbol("x")}, {"y", fresh->symbol("y")}};
        const Expression e = parse_expression(*fresh, text, names);
        EXPECT_LE(fresh->size(), 2 * depth + 2) << "at most two nodes for each level";
        EXPECT_EQ(parse_expression(*fresh, to_string(e), names), e);
        const Expression slope = differentiate(e, names.at("x"));
        EXPECT_LE(fresh->size(), 15 * depth);
        const Function function(std::vector{names.at("x"), names.at("y")}, std::vector{slope});
        EXPECT_TRUE(std::isfinite(function(std::vector{0.5, 0.25})[0]));
    }
}

TEST_F(ParserTest, LongExpressionsTakeLinearWork) {
    std::string text = "x";
    for (int term = 1; term <= 50000; ++term)
        text += " + " + std::to_string(term) + "*y^" + std::to_string(term + 1);
    const std::size_t before = graph->size();
    const Expression e = parse(text);
    EXPECT_LE(graph->size() - before, 4 * 50000u);
    EXPECT_EQ(parse(to_string(e)), e);
}

TEST(Names, OnlyIdentifiersThatAreNotReservedAreValid) {
    for (const char* name : {"x", "V0", "_a", "e", "gap_left", "sin2", "step"})
        EXPECT_TRUE(is_valid_name(name)) << name;
    for (const char* name :
         {"", "2x", "a b", "a-b", "x'", "\u03c0", "sin", "tanh", "pi", "t", "time", "and", "or", "not"})
        EXPECT_FALSE(is_valid_name(name)) << name;
    EXPECT_TRUE(is_reserved_name("sqrt"));
    EXPECT_TRUE(is_reserved_name("and"));
    EXPECT_FALSE(is_reserved_name("2x"));
}

} // namespace graze::parser_test
