#include "graze/sweep/attractor.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

namespace graze {

std::string_view name_of(Label label) {
    switch (label) {
    case Label::periodic:
        return "periodic";
    case Label::quasi_periodic:
        return "quasi-periodic";
    case Label::chaotic:
        return "chaotic";
    case Label::transient:
        return "transient";
    case Label::equilibrium:
        return "equilibrium";
    case Label::unbounded:
        return "unbounded";
    case Label::unsettled:
        return "unsettled";
    case Label::escaped:
        return "escaped";
    case Label::singular:
        return "singular";
    case Label::chattering:
        return "chattering";
    case Label::ended:
        return "ended";
    case Label::failed:
        return "failed";
    }
    return "unsettled";
}

void validate_bounds(const Model& model, std::span<const StateBounds> bounds) {
    for (const StateBounds& bound : bounds) {
        require_index(bound.state, model.states.size(), "state");
        if (!(bound.least < bound.greatest))
            throw InputError("bounds of a state are not in order", "give the least value, then the greatest");
    }
}

} // namespace graze
