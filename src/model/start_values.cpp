#include "model/start_values.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/function.hpp"

#include <algorithm>
#include <limits>

namespace graze {

StartValues::StartValues(const Model& model) : symbols_(model.inputs()) {
    try {
        inputs_ = model.initial_state();
        const std::vector<double> parameters = model.parameter_values();
        inputs_.insert(inputs_.end(), parameters.begin(), parameters.end());
    } catch (const InputError&) {
        inputs_.clear(); // `validate` tells what is wrong
    }
}

std::vector<double> StartValues::of(std::span<const Expression> expressions) const {
    std::vector<double> values(expressions.size(), std::numeric_limits<double>::quiet_NaN());
    if (std::ranges::all_of(expressions, [](const Expression& one) { return one.is_number(); })) {
        std::ranges::transform(expressions, values.begin(), [](const Expression& one) { return one.node().value; });
        return values;
    }
    try {
        return inputs_.empty() ? values : Function(symbols_, expressions)(inputs_);
    } catch (const InputError&) {
        return values; // `validate` tells what is wrong
    }
}

} // namespace graze
