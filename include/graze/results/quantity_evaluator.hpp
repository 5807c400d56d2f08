#pragma once

#include "graze/model/named_value.hpp"
#include "graze/symbolic/function.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Evaluates quantities at states, for the model's present parameters.
class QuantityEvaluator {
public:
    QuantityEvaluator(const Model& model, const std::vector<NamedValue>& quantities);
    /// Valid until the next call.
    std::span<const double> operator()(std::span<const double> state);

private:
    Function function_;
    std::size_t states_;
    std::vector<double> inputs_, values_, work_;
};

} // namespace graze
