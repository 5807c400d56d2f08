#pragma once

#include "model/friction_modes.hpp"

#include <optional>
#include <vector>

namespace graze {

/// Says by alternatives which of the modes that replace one with frictions follows.
class FrictionChoice {
public:
    FrictionChoice(const Model& model, const FrictionModes& modes) : model_(model), modes_(modes) {}

    /// Adds alternatives for frictions whose velocity is zero: rest where static friction holds, otherwise slip.
    /// @param base conditions that hold in addition; @param mode the one with frictions; @param states known ones
    /// @param otherwise of a single friction: its state if static friction does not hold, when only one is possible
    void add_from_rest(std::vector<Alternative>& to, const Alternative& base, std::size_t mode, FrictionStates states,
                       const std::vector<std::size_t>& at_zero,
                       std::optional<FrictionState> otherwise = std::nullopt) const;
    /// Adds alternatives for frictions whose velocity may have any sign.
    void add_by_sign(std::vector<Alternative>& to, const Alternative& base, std::size_t mode,
                     const FrictionStates& states, std::vector<std::size_t> unknown,
                     const std::vector<std::size_t>& at_zero) const;

private:
    void add(std::vector<Alternative>& to, const Alternative& base, std::size_t mode, const FrictionStates& states,
             const std::vector<Condition>& conditions, const std::string& text) const;
    void add_combinations(std::vector<Alternative>& to, const Alternative& base, std::size_t mode,
                          const FrictionStates& given, const std::vector<std::size_t>& at_zero) const;

    const Model& model_;
    const FrictionModes& modes_;
};

} // namespace graze
