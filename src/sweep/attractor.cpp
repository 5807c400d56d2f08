#include "graze/sweep/attractor.hpp"

#include "base/enumerator_name.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

namespace graze {

std::string_view name_of(Label label) {
    constexpr std::string_view names[] = {"periodic",    "quasi-periodic", "chaotic",   "transient",
                                          "equilibrium", "unbounded",      "unsettled", "escaped",
                                          "singular",    "chattering",     "ended",     "failed"};
    return enumerator_name(names, label, "unsettled");
}

void validate_bounds(const Model& model, std::span<const StateBounds> bounds) {
    for (const StateBounds& bound : bounds) {
        require_index(bound.state, model.states.size(), "state");
        if (!(bound.least < bound.greatest))
            throw InputError("bounds of a state are not in order", "give the least value, then the greatest");
    }
}

} // namespace graze
