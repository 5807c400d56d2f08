#include "graze/tape/tape.hpp"

#include "base/message_of.hpp"
#include "tape/problems.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace graze::tape_test {

using testing::Problem;

std::ptrdiff_t count(const Tape& tape, SeriesOperation operation) {
    return std::ranges::count(tape.code, operation, &Instruction::operation);
}

TEST(Tape, GathersSums) {
    Problem p;
    const Expression x = p.state("x", 1), y = p.state("y", 1), a = p.parameter("a", 1);
    p.rates = {y, -(x + 2 * a * y) / 3 - a * (x - 1) + (y - 4)};
    const Tape tape = p.tape();
    ASSERT_EQ(tape.code.size(), 1u);
    EXPECT_EQ(tape.code[0].operation, SeriesOperation::linear_combination);
    EXPECT_EQ(tape.terms.size(), 2u);
    EXPECT_EQ(tape.registers, 3u);
}

TEST(Tape, EvaluatesConstantsOnce) {
    Problem p;
    const Expression x = p.state("x", 1), a = p.parameter("a", 1);
    p.rates = {exp(a) * sin(a) * x};
    const Tape tape = p.tape();
    EXPECT_EQ(tape.constant_code.size(), 3u);
    EXPECT_EQ(tape.code.size(), 1u);
}

TEST(Tape, RemovesUnneededInstructions) {
    Problem p;
    const Expression x = p.state("x", 1);
    p.rates = {p.graph->number(2)};
    p.outputs = {sin(x)};
    const Tape tape = p.tape();
    // The argument is linear in time, so the series of its derivative is not needed.
    EXPECT_EQ(count(tape, SeriesOperation::derivative), 0);
    EXPECT_EQ(tape.code.size(), 2u);
    EXPECT_EQ(tape.degrees[0], 1u);
    EXPECT_EQ(tape.degrees[tape.outputs[0].index], Tape::unbounded);
}

TEST(Tape, SharesHelperSeries) {
    Problem p;
    const Expression x = p.state("x", 1);
    p.rates = {sin(x) + cos(x) + exp(x) + tan(x)};
    p.outputs = {sin(x), pow(tan(x), 2) + 1, log(x) + log(x) * x, atan(x), asin(x), acos(x)};
    const Tape tape = p.tape();
    EXPECT_EQ(count(tape, SeriesOperation::derivative), 1);
    EXPECT_EQ(count(tape, SeriesOperation::sin), 1);
    EXPECT_EQ(count(tape, SeriesOperation::cos), 1);
    EXPECT_EQ(count(tape, SeriesOperation::divide), 3);
}

TEST(Tape, IntegerPowersBecomeProducts) {
    Problem p;
    const Expression x = p.state("x", 0);
    p.rates = {pow(x, 5) + pow(x, -4) + pow(x, 0.5) + pow(2 * x, 2)};
    const Tape tape = p.tape();
    EXPECT_EQ(count(tape, SeriesOperation::power_constant), 0);
    EXPECT_EQ(count(tape, SeriesOperation::square), 4);
    EXPECT_EQ(count(tape, SeriesOperation::multiply), 1);
    EXPECT_EQ(count(tape, SeriesOperation::reciprocal), 1);
    EXPECT_EQ(count(tape, SeriesOperation::sqrt), 1);
}

TEST(Tape, FindsDegrees) {
    Problem p;
    const Expression x = p.state("x", 0), v = p.state("v", 0), frozen = p.state("frozen", 0);
    const Expression phase = p.state("phase", 0), free = p.state("free", 0), a = p.parameter("a", 1);
    p.rates = {v, -a, p.graph->number(0), frozen, free * phase};
    p.outputs = {x * phase - v, x * x * x, exp(frozen) * a};
    const Tape tape = p.tape();
    EXPECT_EQ(std::vector<std::uint32_t>(tape.degrees.begin(), tape.degrees.begin() + 5),
              (std::vector<std::uint32_t>{2, 1, 0, 1, Tape::unbounded}));
    EXPECT_EQ(tape.degrees[tape.outputs[0].index], 3u);
    EXPECT_EQ(tape.degrees[tape.outputs[1].index], Tape::unbounded);
    EXPECT_EQ(tape.degrees[tape.outputs[2].index], 0u);
}

TEST(Tape, FindsLocationsOfRatesAndOutputs) {
    Problem p;
    const Expression x = p.state("x", 0), a = p.parameter("a", 1);
    p.rates = {a};
    p.outputs = {x, a, p.graph->number(3), x - x};
    const Tape tape = p.tape();
    EXPECT_TRUE(tape.rates[0].constant);
    EXPECT_EQ(tape.rates[0].index, 0u);
    EXPECT_FALSE(tape.outputs[0].constant);
    EXPECT_EQ(tape.outputs[0].index, 0u);
    EXPECT_TRUE(tape.outputs[1].constant);
    EXPECT_TRUE(tape.outputs[2].constant);
    EXPECT_TRUE(tape.outputs[3].constant);
}

TEST(Tape, LongSumsAndDeepNestingTakeLinearTime) {
    Problem p;
    const Expression a = p.parameter("a", 0.5);
    Expression sum = p.graph->number(0);
    Expression nested = p.graph->number(1);
    for (int i = 0; i < 2000; ++i) {
        const Expression x = p.state("x" + std::to_string(i), 1e-3 * i);
        p.rates.push_back(p.graph->number(1));
        sum = sum + (i % 3 + 1) * x;
        nested = a * nested + x;
    }
    Expression product = p.states[1];
    for (int i = 0; i < 20000; ++i)
        product = product * p.states[i % 7] + 1;
    p.outputs = {sum, nested, product};
    const Tape tape = p.tape();
    EXPECT_LT(tape.constants, 20000u);
    const auto series = testing::output_series(p, 2, best_instruction_set());
    double expected = 0;
    double horner = 1;
    for (int i = 0; i < 2000; ++i) {
        expected += (i % 3 + 1) * (1e-3 * i);
        horner = 0.5 * horner + 1e-3 * i;
    }
    EXPECT_NEAR(series[0][0], expected, 1e-12 * expected);
    EXPECT_NEAR(series[1][0], horner, 1e-12 * horner);
    EXPECT_NEAR(series[1][1], 2, 1e-12);
    EXPECT_EQ(series[0][2], 0);
}

TEST(Tape, RefusesForeignSymbols) {
    Problem p;
    const Expression x = p.state("x", 0);
    p.rates = {x * p.graph->symbol("stranger")};
    EXPECT_THAT(testing::message_of([&] { p.tape(); }), ::testing::HasSubstr("stranger"));
}

} // namespace graze::tape_test
