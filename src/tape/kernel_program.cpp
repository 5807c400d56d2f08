#include "tape/kernel_program.hpp"

#include <algorithm>
#include <utility>

namespace graze {

namespace {

/// Bounds the depth of the stack where kernels call each other instead of jumping, as without optimisation.
constexpr std::size_t longest_chain = 64;

bool same_operands(const KernelStep& one, const KernelStep& other) {
    const KernelOperands& a = one.operands;
    const KernelOperands& b = other.operands;
    return a.result == b.result && a.left == b.left && a.right == b.right && a.third == b.third && a.terms == b.terms;
}

} // namespace

void end_of_chain(const KernelOperands*, const KernelLink*, Order) {}

KernelProgram::KernelProgram(const StepFinder& finder, const KernelTable& table, int order, Sequence sequence) {
    std::vector<Segment> segments;
    for (int k = 0; k <= std::min(order, 1); ++k)
        segments.push_back({finder.steps(k), k, k == 0});
    if (order > 1 && sequence == Sequence::by_order)
        add_by_order(finder, order, segments);
    else if (order > 1)
        add_by_instruction(finder, order, segments);
    find_operands(segments);
    find_chains(segments, table);
}

void KernelProgram::add_by_order(const StepFinder& finder, int order, std::vector<Segment>& segments) {
    segments.push_back({finder.before_all(), order, true});
    const std::vector<KernelStep> steps = finder.steps(2, false); // each state is scheduled by itself
    std::vector<bool> is_state;
    for (const KernelStep& step : steps)
        is_state.push_back(finder.is_state(step));
    const std::vector<ScheduledUnit> units = schedule_of(steps, is_state);
    if (units.empty())
        for (int k = 2; k <= order; ++k)
            segments.push_back({finder.steps(k), k, k == 2});
    else
        add_rounds(finder, order, steps, units, segments);
    segments.push_back({finder.after_all(), order, true});
}

/// Adds rounds in which each unit is computed once, at an order that is behind by its lag.
/// @param all the steps of order 2, to which the units refer
void KernelProgram::add_rounds(const StepFinder& finder, int order, const std::vector<KernelStep>& all,
                               const std::vector<ScheduledUnit>& units, std::vector<Segment>& segments) {
    std::vector<std::vector<KernelStep>> steps; // of each order from 2 on
    for (int k = 2; k <= order; ++k)
        steps.push_back(finder.steps(k, false));
    // Polynomials have no steps of higher orders.
    const auto find = [&](int k, std::size_t index) -> const KernelStep* {
        const std::vector<KernelStep>& of_order = steps[static_cast<std::size_t>(k - 2)];
        if (of_order.size() == all.size())
            return &of_order[index];
        const auto found = std::ranges::find(of_order, all[index].operands.result,
                                             [](const KernelStep& step) { return step.operands.result; });
        return found != of_order.end() ? &*found : nullptr;
    };
    const int most_lag = std::ranges::max(units, {}, &ScheduledUnit::lag).lag;
    for (int round = 2; round <= order + most_lag; ++round) {
        Segment segment{{}, round, round == 2};
        segment.steps.reserve(all.size());
        segment.orders.reserve(all.size());
        for (const ScheduledUnit& unit : units) {
            const int k = round - unit.lag;
            if (k < 2 || k > order)
                continue;
            for (std::size_t i = unit.first; i < unit.end; ++i)
                if (const KernelStep* step = find(k, i)) {
                    segment.steps.push_back(*step);
                    segment.orders.push_back(k);
                }
        }
        segments.push_back(std::move(segment));
    }
}

void KernelProgram::add_by_instruction(const StepFinder& finder, int order, std::vector<Segment>& segments) {
    for (StepFinder::Run& run : finder.runs()) {
        int k = run.whole ? order : 2;
        bool begins = true;
        for (std::vector<KernelStep>& steps : run.steps)
            segments.push_back({std::move(steps), k++, std::exchange(begins, false)});
    }
}

void KernelProgram::find_operands(std::vector<Segment>& segments) {
    const Segment* last = nullptr;
    for (Segment& segment : segments) {
        if (last && std::ranges::equal(segment.steps, last->steps, same_operands)) {
            segment.operands = last->operands;
        } else {
            segment.operands = operands_.size();
            for (const KernelStep& step : segment.steps)
                operands_.push_back(step.operands);
        }
        last = &segment;
    }
}

void KernelProgram::find_chains(const std::vector<Segment>& segments, const KernelTable& table) {
    std::size_t most = 0;
    for (const Segment& segment : segments)
        most += 4 * segment.steps.size() + 3;
    kernels_.reserve(most); // chains point to them
    std::size_t length = 0; // of the current chain
    Order order = 0;        // that the next kernel receives
    for (const Segment& segment : segments) {
        const KernelOperands* operands = operands_.data() + segment.operands;
        if (!segment.begins && length > 0 && length + segment.steps.size() < longest_chain) {
            kernels_.push_back({.kernel = table.next_order});
            kernels_.push_back({.operands = operands});
            ++order;
        } else {
            length = longest_chain;
        }
        for (std::size_t i = 0; i < segment.steps.size(); ++i, ++operands) {
            const KernelStep& step = segment.steps[i];
            if (step.kernel == nullptr)
                continue;
            const Order needed = segment.orders.empty() ? segment.order : segment.orders[i];
            if (length == longest_chain) {
                kernels_.push_back({.kernel = end_of_chain});
                chains_.push_back({kernels_.data() + kernels_.size(), operands, needed});
                order = needed;
                length = 0;
            }
            if (step.reads_order && order != needed) {
                kernels_.push_back({.kernel = table.shift_order});
                kernels_.push_back({.shift = needed - order});
                order = needed;
            }
            kernels_.push_back({.kernel = step.kernel});
            ++length;
        }
        if (segment.order <= 1)
            beginning_ = chains_.size();
    }
    kernels_.push_back({.kernel = end_of_chain});
}

} // namespace graze
