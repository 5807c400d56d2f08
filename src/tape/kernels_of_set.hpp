#pragma once

// Collects the kernels of one instruction set in tables. To be included only by its translation unit.

#include "tape/column_kernels.hpp"
#include "tape/guard_kernels.hpp"
#include "tape/kernels.hpp"
#include "tape/known_series_kernels.hpp"
#include "tape/recurrence.hpp"
#include "tape/step_kernels.hpp"
#include "tape/sum_kernels.hpp"
#include "tape/tangent_kernels.hpp"

namespace graze::GRAZE_INSTRUCTION_SET {

/// Calls the next kernel.
GRAZE_INLINE void go_on(const KernelOperands* operands, const KernelLink* next, Order order) {
    ++next;
    asm("" : "+r"(next)); // otherwise compilers keep two pointers for no benefit
    return next[-1].kernel(operands, next, order);
}

template <auto step>
void chained(const KernelOperands* operands, const KernelLink* next, Order order) {
    step(*operands, order);
    return go_on(operands + 1, next, order);
}
template <auto steps>
void chained_two(const KernelOperands* operands, const KernelLink* next, Order order) {
    steps(operands, order);
    return go_on(operands + 2, next, order);
}
inline void next_order(const KernelOperands*, const KernelLink* next, Order order) {
    return go_on(next->operands, next + 1, order + 1);
}

inline void shift_order(const KernelOperands* operands, const KernelLink* next, Order order) {
    return go_on(operands, next + 1, order + next->shift);
}

template <class Family, int... k>
constexpr void fill(Kernel (&row)[highest_order + 1], Indices<k...>) {
    ((row[k] = &chained<&Family::template run<k>>), ...);
}
template <class Family>
constexpr void fill(KernelTable& table, SeriesOperation operation) {
    fill<Family>(table.series[static_cast<int>(operation)], std::make_integer_sequence<int, highest_order + 1>{});
}

template <class Family, int... k>
constexpr void fill_above_zero(Kernel (&row)[highest_order + 1], Indices<k...>) {
    ((row[k + 1] = &chained<&Family::template run<k + 1>>), ...);
}
template <class V, Operation function, Recurrence recurrence>
constexpr void fill_function(KernelTable& table, SeriesOperation operation) {
    constexpr bool minus = recurrence == Recurrence::minus_product || recurrence == Recurrence::minus_quotient;
    using Family =
        std::conditional_t<is_product(recurrence), FunctionByProduct<V, minus>, FunctionByQuotient<V, minus>>;
    if constexpr (recurrence != Recurrence::own) {
        Kernel(&row)[highest_order + 1] = table.series[static_cast<int>(operation)];
        row[0] = &chained<&function_value<V, function>>;
        fill_above_zero<Family>(row, std::make_integer_sequence<int, highest_order>{});
    }
}

template <class V, Operation... operation>
constexpr void fill_constants(KernelTable& table) {
    ((table.constant[static_cast<int>(operation)] = &chained<&constant<V, operation>>), ...);
}

template <class V, class At, int... count>
constexpr void fill_combinations(CombinationKernels& kernels, Indices<count...>) {
    using Alone = Combination<V, At>;
    using OfState = StateCombination<V, At>;
    ((kernels.combination[count] = &chained<&Alone::template run<count>>), ...);
    ((kernels.combination_value[count] = &chained<&Alone::template run_value<count>>), ...);
    ((kernels.whole_combination[count] = &chained<&Alone::template run_whole<count>>), ...);
    ((kernels.state_combination[count] = &chained<&OfState::template run<count>>), ...);
    ((kernels.state_combination_value[count] = &chained<&OfState::template run_value<count>>), ...);
}

template <class Family, int... k>
constexpr void fill_twos(Kernel (&row)[highest_order + 1], Indices<k...>) {
    ((row[k + 1] = &chained_two<&Family::template run<k + 1>>), ...);
}
template <class Family>
constexpr void fill_with_multiple(KernelTable& table, SeriesOperation operation) {
    fill_twos<WithMultiple<double, Family>>(table.with_multiple[static_cast<int>(operation)],
                                            std::make_integer_sequence<int, highest_order>{});
}
/// Only for a single lane: with several lanes each step has enough work of its own to hide latency.
constexpr void fill_twos(KernelTable& table) {
#if defined(__FMA__)
    table.whole_product = &chained<&whole_product<>>;
    table.whole_reciprocal = &chained<&whole_reciprocal<>>;
#endif
    table.two_states = &chained_two<&two_states<double>>;
    fill_with_multiple<Multiply<double>>(table, SeriesOperation::multiply);
    fill_with_multiple<Divide<double>>(table, SeriesOperation::divide);
    fill_with_multiple<Square<double>>(table, SeriesOperation::square);
    fill_with_multiple<Reciprocal<double>>(table, SeriesOperation::reciprocal);
    fill_twos<DivideCombination<double>>(table.divide_combination, std::make_integer_sequence<int, highest_order>{});
}

template <class V, class Family, int... k>
constexpr void fill_closing(Kernel (&row)[highest_order + 1], Indices<k...>) {
    ((row[k] = starts_pair<V, k> ? &chained<&Family::template run<k, starts_pair<V, k>>> : row[k]), ...);
}
template <class V, class Family>
constexpr void fill_pairs(KernelTable& table, SeriesOperation operation) {
    fill<Family>(table, operation);
    fill_closing<V, Family>(table.closing[static_cast<int>(operation)],
                            std::make_integer_sequence<int, highest_order + 1>{});
}

template <class V>
constexpr KernelTable make_table() {
    KernelTable table{};
    table.width = Numbers<V>::width;
    fill_pairs<V, Multiply<V>>(table, SeriesOperation::multiply);
    fill_pairs<V, Divide<V>>(table, SeriesOperation::divide);
    fill_pairs<V, Square<V>>(table, SeriesOperation::square);
    fill_pairs<V, Reciprocal<V>>(table, SeriesOperation::reciprocal);
    fill<SquareRoot<V>>(table, SeriesOperation::sqrt);
    fill<Power<V>>(table, SeriesOperation::power_constant);
    fill<Derivative<V>>(table, SeriesOperation::derivative);
#define GRAZE_ROW(name, recurrence, slope)                                                                             \
    fill_function<V, Operation::name, Recurrence::recurrence>(table, SeriesOperation::name);
    GRAZE_FUNCTIONS(GRAZE_ROW)
#undef GRAZE_ROW
    constexpr auto counts = std::make_integer_sequence<int, combination_kernels>{};
    fill_combinations<V, OneOrder<V>>(table.combinations, counts);
    table.state = &chained<&state<V>>;
    table.multiply_linear = &chained<&multiply_linear<V>>;
    table.function_of_linear = &chained<&function_of_linear<V, false>>;
    table.minus_function_of_linear = &chained<&function_of_linear<V, true>>;
    table.sine_and_cosine = &chained<&sine_and_cosine<V>>;
    table.whole_sine_and_cosine = &chained<&whole_pair<V, true>>;
    table.whole_hyperbolic_pair = &chained<&whole_pair<V, false>>;
    table.whole_exponential = &chained<&whole_exponential<V>>;
    table.next_order = &next_order;
    table.shift_order = &shift_order;
    if constexpr (std::is_same_v<V, double>)
        fill_twos(table);
    table.literal = &literal<V>;
    table.sum = &sum<V>;
    table.sums_and_slopes = &sums_and_slopes<V>;
    table.disagreement = &disagreement<V>;
    table.bound = &bound<V>;
    table.steps = &steps<V>;
    table.guard = &guard<V>;
    if constexpr (std::is_same_v<V, Ensemble>) {
        table.columns = &columns<V>;
        table.column_tails = &column_tails<V>;
        table.column_misfit = &column_misfit<V>;
    }
#define GRAZE_ROW(name, recurrence, slope) , Operation::name
    fill_constants<V, Operation::add, Operation::subtract, Operation::multiply, Operation::divide, Operation::power,
                   Operation::negate GRAZE_FUNCTIONS(GRAZE_ROW)>(table);
#undef GRAZE_ROW
    return table;
}

inline constexpr KernelTable single_table = make_table<double>();
inline constexpr KernelTable ensemble_table = make_table<Ensemble>();

const KernelTable& kernels(LaneKind kind) {
    return kind == LaneKind::ensemble ? ensemble_table : single_table;
}

inline constexpr TangentKernels one_tangent = make_tangent_kernels<double>();
inline constexpr TangentKernels few_tangents = make_tangent_kernels<Packs<1>>();
inline constexpr TangentKernels many_tangents = make_tangent_kernels<Packs<2>>();

const TangentKernels& tangent_kernels(std::size_t directions) {
    return directions <= 1 ? one_tangent : directions <= lanes ? few_tangents : many_tangents;
}

} // namespace graze::GRAZE_INSTRUCTION_SET
