#pragma once

#include "graze/model/model.hpp"

#include <span>
#include <vector>

namespace graze {

/// Evaluates expressions at the initial state, many times for one model.
class StartValues {
public:
    StartValues() = default;
    /// @param model with an initial state that can be computed, or there are no values
    explicit StartValues(const Model& model);

    /// Returns the values of expanded expressions; not a number where there are none.
    std::vector<double> of(std::span<const Expression> expressions) const;

private:
    std::vector<Expression> symbols_;
    std::vector<double> inputs_;
};

} // namespace graze
