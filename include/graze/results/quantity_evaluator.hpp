#pragma once

#include "graze/model/named_value.hpp"
#include "graze/symbolic/function.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Evaluates quantities at states, with the parameter values that the model has at construction.
class QuantityEvaluator {
public:
    QuantityEvaluator(const Model& model, const std::vector<NamedValue>& quantities);
    /// Values of the quantities at a state; valid until the next call.
    std::span<const double> operator()(std::span<const double> state);

private:
    Function function_;
    std::size_t states_;
    std::vector<double> inputs_, values_, work_;
};

} // namespace graze
