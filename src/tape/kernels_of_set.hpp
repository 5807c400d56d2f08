#pragma once

// Collects the kernels of one instruction set in tables. To be included only by its translation unit.

#include "tape/guard_kernels.hpp"
#include "tape/kernels.hpp"
#include "tape/recurrence.hpp"
#include "tape/step_kernels.hpp"
#include "tape/sum_kernels.hpp"
#include "tape/tangent_kernels.hpp"

namespace graze::GRAZE_INSTRUCTION_SET {

template <auto step>
void chained(const KernelOperands* operands, const KernelLink* next, int order) {
    step(*operands, order);
    return next->kernel(operands + 1, next + 1, order);
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

template <class Family, int... count>
constexpr void fill_combinations(Kernel (&row)[combination_kernels], Indices<count...>) {
    ((row[count] = &chained<&Family::template run<count>>), ...);
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
    fill_combinations<Combination<V>>(table.combination, std::make_integer_sequence<int, combination_kernels>{});
    table.combination_value = &chained<&Combination<V>::run_value>;
    table.state = &chained<&state<V>>;
    fill_combinations<StateCombination<V>>(table.state_combination,
                                           std::make_integer_sequence<int, combination_kernels>{});
    table.state_combination_value = &chained<&StateCombination<V>::run_value>;
    table.multiply_linear = &chained<&multiply_linear<V>>;
    table.function_of_linear = &chained<&function_of_linear<V, false>>;
    table.minus_function_of_linear = &chained<&function_of_linear<V, true>>;
    table.sine_and_cosine = &chained<&sine_and_cosine<V>>;
    table.literal = &literal<V>;
    table.sum = &sum<V>;
    table.sums_and_slopes = &sums_and_slopes<V>;
    table.disagreement = &disagreement<V>;
    table.bound = &bound<V>;
    table.steps = &steps<V>;
    table.guard = &guard<V>;
    if constexpr (std::is_same_v<V, Tangent>) {
        table.tangent_tails = &tangent_tails<V>;
        table.tangent_misfit = &tangent_misfit<V>;
    }
#define GRAZE_ROW(name, recurrence, slope) , Operation::name
    fill_constants<V, Operation::add, Operation::subtract, Operation::multiply, Operation::divide, Operation::power,
                   Operation::negate GRAZE_FUNCTIONS(GRAZE_ROW)>(table);
#undef GRAZE_ROW
    return table;
}

inline constexpr KernelTable single_table = make_table<double>();
inline constexpr KernelTable ensemble_table = make_table<Ensemble>();
inline constexpr KernelTable tangent_table = make_table<Tangent>();

const KernelTable& kernels(LaneKind kind) {
    switch (kind) {
    case LaneKind::ensemble:
        return ensemble_table;
    case LaneKind::tangent:
        return tangent_table;
    default:
        return single_table;
    }
}

} // namespace graze::GRAZE_INSTRUCTION_SET
