#include "model/friction_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace graze {

/// Adds an alternative that leads to a variant.
void FrictionChoice::add(std::vector<Alternative>& to, const Alternative& base, std::size_t mode,
                         const FrictionStates& states, const std::vector<Condition>& conditions,
                         const std::string& text) const {
    Alternative one{base.when, base.when_text, modes_.variant(mode, states).mode};
    one.when.insert(one.when.end(), conditions.begin(), conditions.end());
    if (!text.empty())
        one.when_text += (one.when_text.empty() ? "" : " and ") + text;
    to.push_back(std::move(one));
}

void FrictionChoice::add_from_rest(std::vector<Alternative>& to, const Alternative& base, std::size_t mode,
                                   FrictionStates states, const std::vector<std::size_t>& at_zero,
                                   std::optional<FrictionState> otherwise) const {
    if (at_zero.empty())
        return add(to, base, mode, states, {}, "");
    if (at_zero.size() > 1)
        return add_combinations(to, base, mode, states, at_zero);
    const std::size_t law = at_zero.front();
    states[law] = FrictionState::stick;
    const Expression force = modes_.variant(mode, states).force.at(law);
    add(to, base, mode, states, {{modes_.laws()[law].limit - force, false}, {modes_.laws()[law].limit + force, false}},
        modes_.laws()[law].name + " holds");
    states[law] = otherwise.value_or(FrictionState::forward);
    if (!otherwise) {
        add(to, base, mode, states, {{force, true}}, modes_.laws()[law].name + " gives way forward");
        states[law] = FrictionState::backward;
    }
    add(to, base, mode, states, {}, "");
}

/// Of all combinations, those with most frictions at rest first, the first one that is consistent is taken.
void FrictionChoice::add_combinations(std::vector<Alternative>& to, const Alternative& base, std::size_t mode,
                                      const FrictionStates& given, const std::vector<std::size_t>& at_zero) const {
    std::vector<FrictionStates> options{given};
    for (const std::size_t law : at_zero) {
        std::vector<FrictionStates> longer;
        for (const FrictionStates& one : options)
            for (const FrictionState state : {FrictionState::stick, FrictionState::forward, FrictionState::backward}) {
                longer.push_back(one);
                longer.back()[law] = state;
            }
        options = std::move(longer);
    }
    const auto slipping = [&](const FrictionStates& one) {
        return std::ranges::count_if(at_zero, [&](std::size_t law) { return one.at(law) != FrictionState::stick; });
    };
    std::ranges::stable_sort(options, {}, slipping);
    for (const FrictionStates& states : options) {
        const FrictionVariant& there = modes_.variant(mode, states);
        std::vector<Condition> conditions;
        std::string text;
        for (const std::size_t law : at_zero) {
            const FrictionState state = states.at(law);
            text += fmt::format("{}{} {}", text.empty() ? "" : " and ", modes_.laws()[law].name,
                                state == FrictionState::stick
                                    ? "holds"
                                    : fmt::format("gives way {}", friction_words[std::size_t(state)]));
            if (state == FrictionState::stick) {
                conditions.push_back({modes_.laws()[law].limit - there.force.at(law), false});
                conditions.push_back({modes_.laws()[law].limit + there.force.at(law), false});
            } else {
                const Expression& rate = there.acceleration.at(law);
                conditions.push_back({state == FrictionState::forward ? rate : -rate, false});
            }
        }
        add(to, base, mode, states, conditions, text);
    }
}

void FrictionChoice::add_by_sign(std::vector<Alternative>& to, const Alternative& base, std::size_t mode,
                                 const FrictionStates& states, std::vector<std::size_t> unknown,
                                 const std::vector<std::size_t>& at_zero) const {
    if (unknown.empty())
        return add_from_rest(to, base, mode, states, at_zero);
    const std::size_t law = unknown.back();
    unknown.pop_back();
    const auto with = [&](const Expression& function, const char* sign) {
        Alternative one = base;
        one.when.push_back({function, true});
        one.when_text += fmt::format("{}{} {} 0", one.when_text.empty() ? "" : " and ",
                                     "velocity of " + modes_.laws()[law].name, sign);
        return one;
    };
    const Expression& velocity = model_.frictions[law].velocity;
    FrictionStates moving = states;
    moving[law] = FrictionState::forward;
    add_by_sign(to, with(velocity, ">"), mode, moving, unknown, at_zero);
    moving[law] = FrictionState::backward;
    add_by_sign(to, with(-velocity, "<"), mode, moving, unknown, at_zero);
    std::vector<std::size_t> zero = at_zero;
    zero.insert(std::ranges::upper_bound(zero, law), law);
    add_by_sign(to, base, mode, states, unknown, zero);
}

} // namespace graze
