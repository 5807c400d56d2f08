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
    if (order > 1)
        (sequence == Sequence::by_order ? add_by_order : add_by_instruction)(finder, order, segments);
    find_operands(segments);
    find_chains(segments, table);
}

void KernelProgram::add_by_order(const StepFinder& finder, int order, std::vector<Segment>& segments) {
    segments.push_back({finder.before_all(), order, true});
    for (int k = 2; k <= order; ++k)
        segments.push_back({finder.steps(k), k, k == 2});
    segments.push_back({finder.after_all(), order, true});
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
        most += 2 * segment.steps.size() + 3;
    kernels_.reserve(most); // chains point to them
    std::size_t length = 0; // of the current chain
    for (const Segment& segment : segments) {
        const KernelOperands* operands = operands_.data() + segment.operands;
        if (!segment.begins && length > 0 && length + segment.steps.size() < longest_chain) {
            kernels_.push_back({.kernel = table.next_order});
            kernels_.push_back({.operands = operands});
        } else {
            length = longest_chain;
        }
        for (const KernelStep& step : segment.steps) {
            if (step.kernel && length == longest_chain) {
                kernels_.push_back({.kernel = end_of_chain});
                chains_.push_back({kernels_.data() + kernels_.size(), operands, segment.order});
                length = 0;
            }
            if (step.kernel) {
                kernels_.push_back({.kernel = step.kernel});
                ++length;
            }
            ++operands;
        }
        if (segment.order <= 1)
            beginning_ = chains_.size();
    }
    kernels_.push_back({.kernel = end_of_chain});
}

} // namespace graze
