#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// The way in which the guard of a transition lets the motion go on; null if none of its alternatives holds.
/// @param inputs state after the jump, then parameters
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
