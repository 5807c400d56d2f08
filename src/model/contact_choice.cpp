#include "model/contact_choice.hpp"

#include "base/special_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace graze {

bool add_condition(std::vector<Condition>& to, const Expression& function, bool strict) {
    if (function.is_number()) {
        const double value = function.node().value;
        return strict ? value > 0 : value >= 0;
    }
    const Condition condition{function, strict};
    if (std::ranges::find(to, condition) == to.end())
        to.push_back(condition);
    return true;
}

void ContactChoice::add(std::vector<Alternative>& to, const Alternative& given, std::size_t base,
                        ContactsKnowledge known) {
    if (!add_by_sign(to, given, base, known))
        add_by_forces(to, given, base, known);
}

/// With friction the cases that come before may be without a consistent mode: those that follow must exclude them.
Alternative ContactChoice::without(Alternative given, const std::vector<Expression>& not_negative) const {
    if (std::ranges::any_of(model_.contacts, [](const UnilateralContact& one) { return one.friction.has_value(); }))
        for (const Expression& function : not_negative)
            add_condition(given.when, function, false);
    return given;
}

/// Splits by the sign of a velocity that is not known. @return false if all are
bool ContactChoice::add_by_sign(std::vector<Alternative>& to, const Alternative& given, std::size_t base,
                                ContactsKnowledge& known) {
    const ContactMechanics& mechanics = modes_.mechanics(base);
    for (std::size_t i = 0; i < known.size(); ++i) {
        const std::string& name = model_.contacts[i].name;
        const auto with = [&](const Expression& velocity, const std::string& text, const ContactKnowledge& one) {
            Alternative next = given;
            if (!add_condition(next.when, velocity, true))
                return;
            next.when_text += fmt::format("{}{} {}", next.when_text.empty() ? "" : " and ", name, text);
            ContactsKnowledge more = known;
            more[i] = one;
            add(to, next, base, std::move(more));
        };
        if (known[i].normal == ContactKnowledge::Normal::unknown) {
            with(mechanics.normal(i).velocity, "separates", {});
            known[i].normal = ContactKnowledge::Normal::touching;
            add(to, without(given, {-mechanics.normal(i).velocity}), base, std::move(known));
            return true;
        }
        if (known[i].normal == ContactKnowledge::Normal::touching && !known[i].slip && !known[i].at_rest) {
            if (!mechanics.rubs(i)) {
                known[i].slip = ContactState::closed;
                continue;
            }
            if (follow_others(base, known, i))
                continue;
            const Expression& slip = mechanics.slip(i).velocity;
            for (const ContactState state : {ContactState::forward, ContactState::backward})
                with(state == ContactState::forward ? slip : -slip,
                     state == ContactState::forward ? "slips forward" : "slips backward",
                     {ContactKnowledge::Normal::touching, state, false});
            known[i].at_rest = true;
            add(to, without(given, {slip, -slip}), base, std::move(known));
            return true;
        }
    }
    return false;
}

/// Slips that depend on one another have no signs of their own. @return whether that of this contact is known now
bool ContactChoice::follow_others(std::size_t base, ContactsKnowledge& known, std::size_t contact) {
    ContactStates states;
    for (const ContactKnowledge& one : known)
        states.push_back(one.normal != ContactKnowledge::Normal::touching ? ContactState::open
                         : one.at_rest                                    ? ContactState::stick
                                                                          : one.slip.value_or(ContactState::closed));
    const auto follows = modes_.mechanics(base).following_slip(contact, std::move(states));
    if (!follows || !follows->apart.is_number(0))
        return false;
    known[contact].at_rest = follows->state == ContactState::stick;
    if (!known[contact].at_rest)
        known[contact].slip = follows->state;
    return true;
}

/// Of all combinations, those with most contacts closed first, the first one that is consistent is taken. Without
/// friction there always is one (the matrix of inertia is positive definite), so that the last needs no condition.
void ContactChoice::add_by_forces(std::vector<Alternative>& to, const Alternative& given, std::size_t base,
                                  const ContactsKnowledge& known) {
    std::vector<std::vector<ContactState>> possible;
    bool smooth = true;
    for (const ContactKnowledge& one : known) {
        std::vector<ContactState> states;
        if (one.normal == ContactKnowledge::Normal::touching && one.slip)
            states = {*one.slip};
        else if (one.normal == ContactKnowledge::Normal::touching)
            states = {ContactState::stick, ContactState::forward, ContactState::backward};
        states.push_back(ContactState::open);
        smooth = smooth && (states.size() == 1 || states.front() == ContactState::closed);
        possible.push_back(std::move(states));
    }
    std::vector<ContactStates> options = combinations(possible);
    std::ranges::stable_sort(options, {}, [](const ContactStates& states) {
        return std::pair(std::ranges::count(states, ContactState::open), std::ranges::count_if(states, is_slip));
    });
    const std::size_t before = to.size();
    for (const ContactStates& states : options)
        if (modes_.moves(base, states) && states != left_out_)
            add_consistent(to, given, base, known, states);
    if (smooth && to.size() > before) {
        to.back().when = given.when;
        to.back().when_text = given.when_text;
    } else if (tell_paradox_ && modes_.moves(base, options.front())) {
        to.push_back({given.when, given.when_text, modes_.variant(base, options.front()).mode});
    }
}

/// Contacts that hold together exactly at their limit, as where a push is greatest, must not be left without a mode by
/// round-off: a slip has other terms. The arc that begins there sees to which side the limit is left.
Expression ContactChoice::with_roundoff(const ContactLimit& limit) {
    constexpr double roundoff = 64 * epsilon;
    return limit.squares.is_number(0) ? limit.function : limit.function + roundoff * sqrt(limit.squares);
}

void ContactChoice::add_consistent(std::vector<Alternative>& to, const Alternative& given, std::size_t base,
                                   const ContactsKnowledge& known, const ContactStates& states) {
    const ContactVariant& there = modes_.variant(base, states);
    Alternative next{given.when, given.when_text, there.mode};
    bool possible = true;
    const auto require = [&](const Expression& function, bool strict = false) {
        possible = possible && add_condition(next.when, function, strict);
    };
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (known[i].normal == ContactKnowledge::Normal::open)
            continue;
        std::string_view word = "stays closed";
        if (states[i] == ContactState::open) {
            require(there.normal_acceleration[i]);
            word = "opens";
        }
        for (const ContactLimit& limit : there.force.limits)
            if (limit.beyond.front().first == i)
                require(with_roundoff(limit));
        if (states[i] == ContactState::stick) {
            word = "sticks";
        } else if (is_slip(states[i])) {
            const bool forward = states[i] == ContactState::forward;
            if (known[i].at_rest)
                require(forward ? there.slip_acceleration[i] : -there.slip_acceleration[i]);
            word = forward ? "slips forward" : "slips backward";
        }
        next.when_text += fmt::format("{}{} {}", next.when_text.empty() ? "" : " and ", model_.contacts[i].name, word);
    }
    for (const auto* further : {&there.force.regular, &there.force.joint})
        for (const Expression& one : *further)
            require(one, true);
    for (const Expression& one : there.force.apart)
        require(-one);
    if (possible)
        to.push_back(std::move(next));
}

} // namespace graze
