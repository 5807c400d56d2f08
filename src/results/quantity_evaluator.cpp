#include "graze/results/quantity_evaluator.hpp"

#include <algorithm>

namespace graze {

QuantityEvaluator::QuantityEvaluator(const Model& model, const std::vector<NamedValue>& quantities)
    : states_(model.states.size()), inputs_(states_), values_(quantities.size()) {
    for (const double value : model.parameter_values())
        inputs_.push_back(value);
    std::vector<Expression> outputs;
    for (const NamedValue& quantity : quantities)
        outputs.push_back(quantity.value);
    function_ = model.function_of(outputs);
    work_.resize(function_.workspace());
}

std::span<const double> QuantityEvaluator::operator()(std::span<const double> state) {
    std::copy_n(state.begin(), states_, inputs_.begin());
    function_.evaluate(inputs_, values_, work_);
    return values_;
}

} // namespace graze
