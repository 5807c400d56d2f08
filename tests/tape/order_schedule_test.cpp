#include "tape/order_schedule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <utility>

namespace {

using namespace graze;

void no_kernel(const KernelOperands*, const KernelLink*, Order) {}

/// States x_i with rates that are chains of products of earlier series.
struct Program {
    std::vector<std::array<double, 1>> series = std::vector<std::array<double, 1>>(64);
    std::vector<KernelStep> steps;
    std::vector<bool> is_state;

    void add(std::size_t result, std::size_t left, std::size_t right, bool state) {
        steps.push_back({no_kernel, {series[result].data(), series[left].data(), series[right].data(), {}, {}, {}}});
        is_state.push_back(state);
    }
    std::size_t index(const double* at) const {
        return static_cast<std::size_t>(
            std::ranges::find_if(series, [at](const auto& one) { return one.data() == at; }) - series.begin());
    }
};

/// Computes all orders in the scheduled sequence, and fails where an operand is not yet known.
void expect_operands_known(const Program& program, const std::vector<ScheduledUnit>& units) {
    constexpr int order = 12;
    std::set<std::pair<std::size_t, int>> known;
    std::set<std::size_t> computed;
    for (const KernelStep& step : program.steps)
        computed.insert(program.index(step.operands.result));
    int most_lag = 0;
    for (const ScheduledUnit& unit : units)
        most_lag = std::max(most_lag, unit.lag);
    std::size_t count = 0;
    for (int round = 2; round <= order + most_lag; ++round)
        for (const ScheduledUnit& unit : units) {
            const int k = round - unit.lag;
            if (k < 2 || k > order)
                continue;
            for (std::size_t i = unit.first; i < unit.end; ++i) {
                const KernelOperands& operands = program.steps[i].operands;
                for (const double* operand : {operands.left, operands.right}) {
                    const std::size_t source = program.index(operand);
                    const int needed = program.is_state[i] ? k - 1 : k;
                    if (needed >= 2 && computed.contains(source) && source != program.index(operands.result)) {
                        EXPECT_TRUE(known.contains({source, needed})) << "order " << k << " of step " << i;
                    }
                }
                EXPECT_TRUE(known.insert({program.index(operands.result), k}).second);
                ++count;
            }
        }
    EXPECT_EQ(count, program.steps.size() * (order - 1));
}

TEST(OrderSchedule, KnowsOperandsBeforeTheirUse) {
    std::mt19937 random(7);
    for (int trial = 0; trial < 200; ++trial) {
        Program program;
        const std::size_t states = 1 + random() % 4, products = 1 + random() % 12, all = states + products;
        for (std::size_t i = 0; i < states; ++i)
            program.add(i, states + random() % products, random() % all, true);
        for (std::size_t i = states; i < all; ++i)
            program.add(i, random() % i, random() % i, false);
        const std::vector<ScheduledUnit> units = schedule_of(program.steps, program.is_state);
        ASSERT_EQ(units.size(), program.steps.size());
        expect_operands_known(program, units);
    }
}

// x' = a, a' = c, with b(a) and c(b, x): one order of the cycle a, b, c waits for nothing else, so that what depends on
// x alone is computed beside it.
TEST(OrderSchedule, LetsChainsOfSeveralOrdersRunSideBySide) {
    Program program;
    enum { x, a, b, c, d, e, f };
    program.add(x, a, a, true);
    program.add(a, c, c, true);
    program.add(b, a, a, false);
    program.add(d, x, x, false);
    program.add(e, d, d, false);
    program.add(f, e, e, false);
    program.add(c, b, f, false);
    const std::vector<ScheduledUnit> units = schedule_of(program.steps, program.is_state);
    expect_operands_known(program, units);
    EXPECT_TRUE(std::ranges::any_of(units, [](const ScheduledUnit& unit) { return unit.lag > 0; }));
}

TEST(OrderSchedule, KeepsStepsWithoutKernelBehindTheirs) {
    Program program;
    program.add(0, 1, 1, true);
    program.add(1, 0, 0, false);
    program.add(2, 1, 1, false);
    program.steps[2].kernel = nullptr;
    const std::vector<ScheduledUnit> units = schedule_of(program.steps, program.is_state);
    ASSERT_EQ(units.size(), 2U);
    for (const ScheduledUnit& unit : units)
        EXPECT_EQ(unit.end - unit.first, unit.first == 0 ? 1U : 2U);
}

TEST(OrderSchedule, LeavesLongProgramsAsTheyAre) {
    Program program;
    program.add(0, 59, 59, true);
    for (std::size_t i = 1; i < 60; ++i)
        program.add(i, i - 1, i - 1, false);
    EXPECT_TRUE(schedule_of(program.steps, program.is_state).empty());
}

} // namespace
