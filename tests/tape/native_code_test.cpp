// Machine code against the kernels, bit for bit.

#include "tape/native_code.hpp"

#include "same_bits.hpp"
#include "tape/problems.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace graze::native_code_test {

using testing::Problem;
using testing::same_bits;

/// Of a state whose rate is its square.
Tape square_tape() {
    Problem p;
    const Expression x = p.state("x", 1);
    p.rates = {x * x};
    return p.tape();
}

bool is_made(InstructionSet set) {
    return NativeCode::make(square_tape(), 4, kernel_table(LaneKind::single, set), set) != nullptr;
}

std::vector<InstructionSet> sets_with_code() {
    std::vector<InstructionSet> sets;
    for (const InstructionSet set : testing::supported_sets())
        if (is_made(set))
            sets.push_back(set);
    return sets;
}

/// Returns the number of coefficients of states and outputs that differ.
int differences(const Jet& one, const Jet& other) {
    int count = 0;
    for (std::size_t i = 0; i < one.series().size(); ++i)
        for (int k = 0; k <= one.order(); ++k)
            count +=
                same_bits(one.series()[i][static_cast<std::size_t>(k)], other.series()[i][static_cast<std::size_t>(k)])
                    ? 0
                    : 1;
    return count;
}

/// A jet by kernels and one by machine code.
struct Pair {
    Pair(const Tape& tape, int order, InstructionSet set, const std::vector<double>& parameters)
        : by_kernels(make_jet(tape, order, LaneKind::single, set, MachineCode::never)),
          by_code(make_jet(tape, order, LaneKind::single, set, MachineCode::at_once)) {
        by_kernels->set_parameters(parameters);
        by_code->set_parameters(parameters);
    }
    int differences_at(const std::vector<double>& states) {
        by_kernels->compute(states);
        by_code->compute(states);
        return differences(*by_kernels, *by_code);
    }
    std::unique_ptr<Jet> by_kernels, by_code;
};

TEST(NativeCode, IsMadeWhereItIsSupported) {
    EXPECT_FALSE(is_made(InstructionSet::baseline));
    if (sets_with_code().empty())
        GTEST_SKIP() << "built without the assembler, or on a processor without AVX2";
    const Tape tape = square_tape();
    const InstructionSet set = sets_with_code().front();
    EXPECT_EQ(NativeCode::make(tape, 1, kernel_table(LaneKind::single, set), set), nullptr) << "nothing to compute";
    EXPECT_LT(NativeCode::make(tape, 32, kernel_table(LaneKind::single, set), set)->size(), 1U << 16);
}

TEST(NativeCode, EveryOperationAndOrder) {
    const Problem p = testing::everything();
    const Tape tape = p.tape();
    for (const InstructionSet set : sets_with_code())
        for (int order = 1; order <= highest_order; ++order) {
            Pair pair(tape, order, set, p.parameter_values);
            EXPECT_EQ(pair.differences_at(p.state_values), 0) << "order " << order << " " << name_of(set);
            // What is left from one computation must not show in the next.
            std::vector<double> states = p.state_values;
            states[0] += 0.1;
            EXPECT_EQ(pair.differences_at(states), 0) << "order " << order << " " << name_of(set);
        }
}

/// A vector field of random operations. @param calls whether it has operations that the code leaves to kernels
Problem random_problem(std::mt19937& random, bool calls) {
    Problem p;
    std::vector<Expression> known;
    const int states = 1 + static_cast<int>(random() % 5);
    for (int i = 0; i < states; ++i)
        known.push_back(p.state("x" + std::to_string(i), 0.3 + 0.2 * i));
    const Expression parameter = p.parameter("a", 0.7), exponent = p.parameter("n", 1.3);
    const auto any = [&] { return known[random() % known.size()]; };
    const int operations = 3 + static_cast<int>(random() % 30);
    for (int i = 0; i < operations; ++i) {
        const Expression a = any(), b = any();
        switch (random() % (calls ? 15 : 14)) {
        case 0:
            known.push_back(a * b);
            break;
        case 1:
            known.push_back(a / (3 + b * b));
            break;
        case 2:
            known.push_back(pow(a, 2));
            break;
        case 3:
            known.push_back(1 / (2 + a * a));
            break;
        case 4:
            known.push_back(sqrt(2 + a * a));
            break;
        case 5:
            known.push_back(parameter * a - b + 0.5);
            break;
        case 6:
            known.push_back(exp(-a * a));
            break;
        case 7:
            known.push_back(sin(a) + cos(a));
            break;
        case 8:
            known.push_back(tanh(a) * parameter);
            break;
        case 9:
            known.push_back(log(2 + a * a));
            break;
        case 10:
            known.push_back(atan(a) - b);
            break;
        case 11:
            known.push_back(cosh(a / 4) + erf(b));
            break;
        case 12:
            known.push_back(a + 2 * b - 3 * any() + 4 * any() - 5 * any() + 6 * any() - 7 * any() + 8 * any() +
                            any() / 9 - any() / 10);
            break;
        case 13:
            known.push_back(asin(a / (2 + a * a)));
            break;
        default:
            known.push_back(pow(2 + a * a, exponent));
        }
    }
    for (int i = 0; i < states; ++i)
        p.rates.push_back(i == 1 ? p.graph->number(0.5) : known[known.size() - 1 - random() % (known.size() / 2 + 1)]);
    p.outputs = {known.back(), any() * any(), any()};
    return p;
}

TEST(NativeCode, RandomTapes) {
    std::mt19937 random(1);
    for (int count = 0; count < 120; ++count) {
        const Problem p = random_problem(random, count % 4 == 0);
        const Tape tape = p.tape();
        const int order = 2 + static_cast<int>(random() % (highest_order - 1));
        for (const InstructionSet set : sets_with_code())
            EXPECT_EQ(Pair(tape, order, set, p.parameter_values).differences_at(p.state_values), 0)
                << "tape " << count << " order " << order << " " << name_of(set);
    }
}

TEST(NativeCode, SpecialValues) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const std::vector<double> values{0.0,    -0.0,     1.0,       -1.0,
                                     1e-310, -5e-324,  1e-160,    1e155,
                                     1e308,  infinity, -infinity, std::numeric_limits<double>::quiet_NaN()};
    std::mt19937 random(2);
    for (int count = 0; count < 40; ++count) {
        const Problem p = random_problem(random, count % 4 == 0);
        const Tape tape = p.tape();
        for (const InstructionSet set : sets_with_code()) {
            Pair pair(tape, 13, set, p.parameter_values);
            for (int draw = 0; draw < 20; ++draw) {
                std::vector<double> states = p.state_values;
                for (double& state : states)
                    state = values[random() % values.size()];
                EXPECT_EQ(pair.differences_at(states), 0) << "tape " << count << " draw " << draw;
            }
            EXPECT_EQ(pair.differences_at(p.state_values), 0) << "tape " << count << " after special values";
        }
    }
}

TEST(NativeCode, WhatDeferredExpressionsAndStepsRead) {
    Problem p = testing::everything();
    std::vector<DeferredExpression> deferred;
    for (const Expression& output : p.outputs)
        deferred.push_back({output * p.states[1] / (2 + p.states[0]), 0});
    const Tape tape = compile_tape(p.states, p.parameters, p.rates, p.outputs, deferred);
    const std::uint32_t group = 0;
    for (const InstructionSet set : sets_with_code()) {
        Pair pair(tape, 17, set, p.parameter_values);
        EXPECT_EQ(pair.differences_at(p.state_values), 0);
        for (Jet* const jet : {pair.by_kernels.get(), pair.by_code.get()})
            jet->compute_deferred({&group, 1});
        for (std::size_t i = 0; i < deferred.size(); ++i)
            for (int k = 0; k <= 17; ++k)
                EXPECT_TRUE(same_bits(pair.by_kernels->deferred(i)[k], pair.by_code->deferred(i)[k]))
                    << i << " order " << k;
    }
    // Without deferred expressions, most series are not in memory: guards must find theirs.
    std::mt19937 random(3);
    for (int count = 0; count < 40; ++count) {
        const Problem one = random_problem(random, false);
        for (const InstructionSet set : sets_with_code()) {
            Pair pair(one.tape(), 12, set, one.parameter_values);
            EXPECT_EQ(pair.differences_at(one.state_values), 0);
            for (const double reference : {1e-3, 1.0}) {
                double first = 0, second = 0;
                pair.by_kernels->find_steps(-40, {&reference, 1}, {&first, 1});
                pair.by_code->find_steps(-40, {&reference, 1}, {&second, 1});
                EXPECT_TRUE(same_bits(first, second)) << "tape " << count;
            }
        }
    }
}

TEST(NativeCode, IsMadeInLongRunsAndCanBeExcluded) {
    Problem p = testing::everything();
    const Tape tape = p.tape();
    Tape excluded = tape;
    excluded.native_codes = nullptr;
    const InstructionSet set = best_instruction_set();
    const auto by_kernels = make_jet(tape, 12, LaneKind::single, set, MachineCode::never),
               without = make_jet(excluded, 12, LaneKind::single, set, MachineCode::at_once),
               jet = make_jet(tape, 12, LaneKind::single, set);
    for (const auto& one : {by_kernels.get(), without.get(), jet.get()})
        one->set_parameters(p.parameter_values);
    std::vector<double> states = p.state_values;
    int wrong = 0;
    for (int count = 0; count < 6000; ++count) {
        states[0] = 0.3 + 1e-5 * count;
        for (const auto& one : {by_kernels.get(), without.get(), jet.get()})
            one->compute(states);
        wrong += differences(*by_kernels, *jet) + differences(*by_kernels, *without);
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(tape.native_codes->find(12, set) != nullptr, is_made(set));
    EXPECT_EQ(tape.native_codes->find(13, set), nullptr);
    const Tape copy = tape;
    EXPECT_EQ(copy.native_codes->find(12, set), tape.native_codes->find(12, set));
}

TEST(NativeCode, SeveralThreadsShareIt) {
    const Problem p = testing::everything();
    const Tape tape = p.tape();
    const auto by_kernels = make_jet(tape, 9, LaneKind::single, best_instruction_set(), MachineCode::never);
    by_kernels->set_parameters(p.parameter_values);
    by_kernels->compute(p.state_values);
    std::vector<int> wrong(4, 0);
    std::vector<std::thread> threads;
    for (int& count : wrong)
        threads.emplace_back([&] {
            const auto jet = make_jet(tape, 9, LaneKind::single);
            jet->set_parameters(p.parameter_values);
            for (int i = 0; i < 3000; ++i) {
                jet->compute(p.state_values);
                count += differences(*by_kernels, *jet);
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    for (const int count : wrong)
        EXPECT_EQ(count, 0);
}

TEST(NativeCode, IsNotWritableOnceItCanBeExecuted) {
    const std::vector<InstructionSet> sets = sets_with_code();
    if (sets.empty())
        GTEST_SKIP() << "built without the assembler, or on a processor without AVX2";
    const Tape tape = square_tape();
    const auto pages_that_are = [](const std::string& wanted) { // of memory without a file
        int count = 0;
        std::ifstream maps("/proc/self/maps");
        std::string addresses, rights, offset, device, node;
        for (std::string line; std::getline(maps, line);) {
            std::istringstream words(line);
            words >> addresses >> rights >> offset >> device >> node;
            count += rights.starts_with(wanted) && node == "0" ? 1 : 0;
        }
        return count;
    };
    const int executed = pages_that_are("r-x"), both = pages_that_are("rwx");
    const auto code = NativeCode::make(tape, 12, kernel_table(LaneKind::single, sets.front()), sets.front());
    ASSERT_NE(code, nullptr);
    EXPECT_EQ(pages_that_are("r-x"), executed + 1);
    EXPECT_EQ(pages_that_are("rwx"), both);
}

TEST(NativeCode, LongTapesAreLeftToKernels) {
    Problem p;
    constexpr int size = 500;
    for (int i = 0; i < size; ++i)
        p.state("x" + std::to_string(i), 0.001 * i);
    for (std::size_t i = 0; i < size; ++i)
        p.rates.push_back(p.states[i] * p.states[(i + 1) % size]);
    const Tape tape = p.tape();
    for (const InstructionSet set : testing::supported_sets()) {
        EXPECT_EQ(NativeCode::make(tape, 32, kernel_table(LaneKind::single, set), set), nullptr);
        EXPECT_EQ(Pair(tape, 32, set, {}).differences_at(p.state_values), 0);
    }
}

} // namespace graze::native_code_test
