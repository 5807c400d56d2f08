#pragma once

#include "graze/flow/system.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
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

/// Returns the transition that an event makes: of those whose conditions hold before the jump and whose further events
/// happen too, the first of the most events. None if none is left.
/// @param first transition of the mode and event; @param together events that happen at the same time, in any order
/// @param inputs state before the jump, then parameters; @param conditions, work as above
inline std::optional<std::size_t> chosen_transition(const System& system, std::size_t first,
                                                    std::span<const std::size_t> together,
                                                    std::span<const double> inputs, std::vector<double>& conditions,
                                                    std::span<double> work) {
    std::optional<std::size_t> best;
    for (std::optional<std::size_t> next = first; next; next = system.transition(*next).following) {
        const System::CompiledTransition& one = system.transition(*next);
        if (best && one.also.size() <= system.transition(*best).also.size())
            continue;
        if (std::ranges::any_of(
                one.also, [&](std::size_t event) { return std::ranges::find(together, event) == together.end(); }))
            continue;
        conditions.resize(one.strict.size());
        one.when.evaluate(inputs, conditions, work);
        bool holds = true;
        for (std::size_t i = 0; i < conditions.size(); ++i)
            holds = holds && (one.strict[i] ? conditions[i] > 0 : conditions[i] >= 0);
        if (holds)
            best = next;
    }
    return best;
}

} // namespace graze
