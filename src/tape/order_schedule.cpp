#include "tape/order_schedule.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace graze {

namespace {

/// Longer programs have enough independent steps in each order: a chain of five oscillators gained nothing.
constexpr std::size_t most_units = 16;

/// Processor cycles from operands in memory to the result in memory. Only their ratios matter.
constexpr int latency_of_state = 14, latency_of_combination = 11, latency_of_product = 20;

/// A unit that reads the result of another one.
struct Dependence {
    std::size_t source, reader;
    int latency;
    bool of_order_before; ///< reads the coefficient of the order before
};

std::vector<ScheduledUnit> units_of(std::span<const KernelStep> steps) {
    std::vector<ScheduledUnit> units;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (steps[i].kernel != nullptr || units.empty())
            units.push_back({i, i, 0});
        units.back().end = i + 1;
    }
    return units;
}

std::vector<Dependence> dependences_of(std::span<const KernelStep> steps, const std::vector<bool>& is_state,
                                       const std::vector<ScheduledUnit>& units) {
    std::vector<std::pair<const double*, std::size_t>> unit_of; // by the series that it computes
    for (std::size_t u = 0; u < units.size(); ++u)
        for (std::size_t i = units[u].first; i < units[u].end; ++i)
            unit_of.emplace_back(steps[i].operands.result, u);
    std::ranges::sort(unit_of);
    const auto latency_of = [&](const ScheduledUnit& unit) {
        const bool is_sum = unit.end == unit.first + 1 && steps[unit.first].operands.terms != nullptr;
        return is_state[unit.first] ? latency_of_state : is_sum ? latency_of_combination : latency_of_product;
    };
    std::vector<Dependence> dependences;
    for (std::size_t u = 0; u < units.size(); ++u)
        for (std::size_t i = units[u].first; i < units[u].end; ++i) {
            const auto add = [&](const double* series) {
                const auto found =
                    std::ranges::lower_bound(unit_of, series, {}, [](const auto& one) { return one.first; });
                // In the given sequence, the result of a later step is known only up to the order before.
                if (found != unit_of.end() && found->first == series && found->second != u)
                    dependences.push_back(
                        {found->second, u, latency_of(units[found->second]), is_state[i] || found->second > u});
            };
            const KernelOperands& operands = steps[i].operands;
            for (const double* series : {operands.left, operands.right, static_cast<const double*>(operands.third)})
                add(series);
            for (const TermOperands* term = operands.terms; term != operands.terms_end; ++term)
                add(term->series);
        }
    return dependences;
}

/// Returns the earliest times at which units can begin if a new order begins after each interval; nothing if it is too
/// short.
std::optional<std::vector<int>> earliest_times(const std::vector<Dependence>& dependences, std::size_t units,
                                               int interval, int longest) {
    std::vector<int> times(units, 0);
    for (bool changed = true; changed;) {
        changed = false;
        for (const Dependence& d : dependences) {
            const int time = times[d.source] + d.latency - (d.of_order_before ? interval : 0);
            if (time <= times[d.reader])
                continue;
            if (time > longest) // a cycle takes longer than the interval
                return std::nullopt;
            times[d.reader] = time;
            changed = true;
        }
    }
    return times;
}

} // namespace

std::vector<ScheduledUnit> schedule_of(std::span<const KernelStep> steps, const std::vector<bool>& is_state) {
    std::vector<ScheduledUnit> units = units_of(steps);
    if (units.size() < 2 || units.size() > most_units)
        return {};
    const std::vector<Dependence> dependences = dependences_of(steps, is_state, units);
    const int longest = static_cast<int>(units.size()) * latency_of_product; // one after another
    int too_short = 0, interval = longest;
    std::vector<int> times(units.size(), 0);
    while (interval > too_short + 1) {
        const int middle = (too_short + interval) / 2;
        if (auto found = earliest_times(dependences, units.size(), middle, longest)) {
            interval = middle;
            times = std::move(*found);
        } else {
            too_short = middle;
        }
    }
    std::vector<std::size_t> sequence(units.size());
    std::iota(sequence.begin(), sequence.end(), std::size_t{0});
    std::ranges::stable_sort(sequence, {}, [&](std::size_t u) { return times[u] % interval; });
    std::vector<ScheduledUnit> scheduled;
    for (const std::size_t u : sequence)
        scheduled.push_back({units[u].first, units[u].end, times[u] / interval});
    return scheduled;
}

} // namespace graze
