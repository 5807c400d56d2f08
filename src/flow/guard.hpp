#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {
/// Returns the first alternative of a transition whose conditions hold; null if there is none.
/// @param inputs state after the jump, then parameters
/// @param conditions workspace for values of conditions; @param work of the system's workspace size
/// @param conditions room for values of conditions; @param work of the system's workspace
inline const System::CompiledAlternative* chosen_alternative(const System& system, std::size_t transition,
                                                             std::span<const double> inputs,
                                                             std::vector<double>& conditions, std::span<double> work) {
    for (const System::CompiledAlternative& alternative : system.transition(transition).next) {
        conditions.resize(alternative.strict.size());
        alternative.conditions.evaluate(inputs, conditions, work);
        bool holds = true;
        for (std::size_t i = 0; i < conditions.size(); ++i)
            holds = holds && (alternative.strict[i] ? conditions[i] > 0 : conditions[i] >= 0);
        if (holds)
            return &alternative;
    }
    return nullptr;
}

} // namespace graze
