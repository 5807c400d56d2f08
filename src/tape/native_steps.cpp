#include "tape/native_steps.hpp"

#include "tape/recurrence.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace graze {

namespace {

using Kind = NativeStep::Kind;

/// Translates kernels and addresses.
class StepReader {
public:
    StepReader(const KernelTable& table, const double* memory) : table_(table), memory_(memory) {}

    /// Adds a step, together with the one behind it if its kernel computes both.
    void add(const KernelStep* step, int order, std::vector<NativeStep>& steps) const;
    /// Adds one order of a step that computes all orders at once.
    void add_whole(const KernelStep& step, int order, std::vector<NativeStep>& steps) const;

private:
    NativeStep of_kind(Kind kind, const KernelOperands& operands, int order) const;
    std::optional<NativeStep> series_step(const KernelStep& step, int order) const;
    static void set_kind(NativeStep& step, SeriesOperation operation);
    Offset place(const double* at) const { return at == nullptr ? no_offset : at - memory_; }

    const KernelTable& table_;
    const double* memory_;
};

bool is_one_of(Kernel kernel, const Kernel (&kernels)[combination_kernels]) {
    return std::ranges::find(kernels, kernel) != std::end(kernels);
}

NativeStep StepReader::of_kind(Kind kind, const KernelOperands& operands, int order) const {
    NativeStep step{
        kind, order,  false, place(operands.result), place(operands.left), place(operands.right), place(operands.third),
        {},   nullptr};
    for (const TermOperands* term = operands.terms; term != operands.terms_end; ++term)
        step.terms.push_back({place(term->series), place(term->coefficient)});
    return step;
}

void StepReader::set_kind(NativeStep& step, SeriesOperation operation) {
    switch (operation) {
    case SeriesOperation::multiply:
        step.kind = Kind::multiply;
        return;
    case SeriesOperation::divide:
        step.kind = Kind::divide;
        return;
    case SeriesOperation::square:
        step.kind = Kind::square;
        return;
    case SeriesOperation::reciprocal:
        step.kind = Kind::reciprocal;
        return;
    case SeriesOperation::sqrt:
        step.kind = Kind::square_root;
        return;
    case SeriesOperation::derivative:
        step.kind = Kind::derivative;
        return;
    default:
        break;
    }
    const Recurrence recurrence = recurrence_of(operation);
    if (recurrence == Recurrence::own || step.order == 0) // values of functions are left to kernels
        return;
    step.kind = is_product(recurrence) ? Kind::function_by_product : Kind::function_by_quotient;
    step.negative = recurrence == Recurrence::minus_product || recurrence == Recurrence::minus_quotient;
}

/// Returns nothing if the kernel is none of a single operation.
std::optional<NativeStep> StepReader::series_step(const KernelStep& step, int order) const {
    for (int row = 0; row < series_operation_count; ++row) {
        if (step.kernel != table_.series[row][order] && step.kernel != table_.with_multiple[row][order])
            continue;
        NativeStep found = of_kind(Kind::other, step.operands, order);
        set_kind(found, static_cast<SeriesOperation>(row));
        if (found.kind == Kind::other)
            return std::nullopt;
        return found;
    }
    return std::nullopt;
}

void StepReader::add(const KernelStep* step, int order, std::vector<NativeStep>& steps) const {
    const KernelOperands& operands = step->operands;
    const CombinationKernels& combinations = table_.combinations;
    const Kernel kernel = step->kernel;
    if (kernel == table_.divide_combination[order]) {
        steps.push_back(of_kind(Kind::combination, operands, order));
        steps.push_back(of_kind(Kind::divide, step[1].operands, order));
    } else if (kernel == table_.state) {
        steps.push_back(of_kind(Kind::state, operands, order));
    } else if (is_one_of(kernel, order > 1 ? combinations.state_combination : combinations.state_combination_value)) {
        steps.push_back(of_kind(Kind::state_combination, operands, order));
    } else if (is_one_of(kernel, order > 0 ? combinations.combination : combinations.combination_value)) {
        steps.push_back(of_kind(Kind::combination, operands, order));
    } else if (kernel == table_.multiply_linear) {
        steps.push_back(of_kind(Kind::multiply_linear, operands, order));
    } else if (kernel == table_.function_of_linear || kernel == table_.minus_function_of_linear) {
        steps.push_back(of_kind(Kind::function_of_linear, operands, order));
        steps.back().negative = kernel == table_.minus_function_of_linear;
    } else if (std::optional<NativeStep> found = series_step(*step, order)) {
        steps.push_back(std::move(*found));
        const auto joint = [&](const auto& row) { return kernel == row[order]; };
        if (std::ranges::any_of(table_.with_multiple, joint))
            steps.push_back(of_kind(Kind::combination, step[1].operands, order));
    } else {
        steps.push_back(of_kind(Kind::other, operands, order));
        steps.back().kernel = kernel;
    }
}

void StepReader::add_whole(const KernelStep& step, int order, std::vector<NativeStep>& steps) const {
    const bool circular = step.kernel == table_.whole_sine_and_cosine;
    const Kind kind = circular || step.kernel == table_.whole_hyperbolic_pair ? Kind::pair
                      : step.kernel == table_.whole_exponential               ? Kind::exponential
                                                                              : Kind::combination;
    steps.push_back(of_kind(kind, step.operands, order));
    steps.back().negative = circular;
}

} // namespace

std::vector<NativeStep> native_steps(const StepFinder& finder, const KernelTable& table, const double* memory,
                                     int first, int last) {
    const StepReader reader(table, memory);
    std::vector<KernelStep> before, after;
    if (first > 1) {
        before = finder.before_all();
        after = finder.after_all();
    }
    std::vector<NativeStep> steps;
    for (int order = first; order <= last; ++order) {
        for (const KernelStep& step : before)
            reader.add_whole(step, order, steps);
        const std::vector<KernelStep> of_order = finder.steps(order, false);
        for (const KernelStep& step : of_order)
            if (step.kernel != nullptr)
                reader.add(&step, order, steps);
        for (const KernelStep& step : after)
            reader.add_whole(step, order, steps);
    }
    return steps;
}

} // namespace graze
