#pragma once

#include "graze/model/model.hpp"

#include <random>
#include <span>
#include <vector>

namespace graze {

/// Draws states and parameters near their first values, at random: the same numbers each time.
class RandomInputs {
public:
    explicit RandomInputs(const Model& model);
    /// Returns states, then parameters; nothing if the model's first values cannot be computed.
    std::vector<double> drawn();

private:
    std::vector<double> states_, parameters_;
    std::mt19937_64 random_{1};
};

/// Tells which expressions are zero wherever others are, for all states and parameters. Computed in double precision
/// such an expression is round-off of either sign, so that no decision may depend on it. It is tried at random states
/// that Newton's method has moved to zeros of the others; expressions are analytic, so that those that are zero there
/// are zero everywhere.
class Vanishing {
public:
    /// @param model must outlive this; its graph grows
    /// @param inputs of the model, from which samples are made
    /// @param zero expanded expressions that are zero, such as the gaps of closed contacts
    Vanishing(const Model& model, RandomInputs inputs, std::span<const Expression> zero);

    /// Returns for each expanded expression whether it vanishes; false where that cannot be told, as with tables.
    std::vector<bool> of(std::span<const Expression> expressions) const;

private:
    const Model& model_;
    std::vector<std::vector<double>> samples_; ///< states and parameters
};

} // namespace graze
