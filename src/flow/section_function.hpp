#pragma once

#include "graze/model/model.hpp"
#include "graze/symbolic/transform.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// Returns the function whose zero is a section, in states and independent parameters; for a phase section, the state
/// less its value. With a symmetry, the function of the image of the state. Appends to the model's graph.
inline Expression section_function(Model& model, const Section& section, std::optional<std::size_t> symmetry) {
    const std::vector<Expression> states = model.state_symbols();
    const Expression function =
        model.expand(section.state ? states[*section.state] - model.expand(section.value) : section.function);
    if (!symmetry)
        return function;
    const std::vector<Expression> map = model.expand(model.symmetries[*symmetry].map);
    std::vector<Replacement> replacements;
    for (std::size_t i = 0; i < states.size(); ++i)
        replacements.emplace_back(states[i], map[i]);
    return substitute(function, replacements);
}

} // namespace graze
