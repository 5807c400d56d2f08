#include "model/contact_impacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace graze {

/// Contacts that are closed, or close at once.
struct ContactImpacts::Meeting {
    const ContactMechanics& mechanics;
    const ContactStates& closed;
    const std::vector<std::size_t>& closing;
    Expression zero{};
    bool alone = false; ///< contacts that are closed take no impulse, so that they are hit next
    const Vanishing* vanishing = nullptr;

    bool is_closing(std::size_t contact) const { return std::ranges::find(closing, contact) != closing.end(); }
    bool takes_part(std::size_t contact) const {
        return (!alone && closed[contact] != ContactState::open) || is_closing(contact);
    }
    /// Velocities before the impact.
    Expression normal(std::size_t contact) const {
        return is_closing(contact) ? mechanics.normal(contact).velocity : zero;
    }
    Expression slip(std::size_t contact) const {
        return closed[contact] == ContactState::stick ? zero : mechanics.slip(contact).velocity;
    }
    /// Removes the conditions that round-off would decide: those that are zero by the law, and so hold.
    void remove_vanishing(std::vector<Condition>& conditions) const {
        std::vector<Expression> functions;
        for (const Condition& one : conditions)
            functions.push_back(one.function);
        const std::vector<bool> vanishes = vanishing->of(functions);
        std::size_t number = 0;
        std::erase_if(conditions, [&](const Condition&) { return vanishes[number++]; });
    }
};

/// Returns what is zero when contacts close at once while others are closed.
std::vector<Expression> ContactImpacts::zeros(std::size_t base, const ContactStates& closed,
                                              const std::vector<std::size_t>& closing) const {
    const ContactMechanics& mechanics = modes_.mechanics(base);
    std::vector<Expression> result;
    for (const std::size_t contact : closing)
        result.push_back(mechanics.gap(contact));
    for (std::size_t i = 0; i < closed.size(); ++i) {
        if (closed[i] == ContactState::open)
            continue;
        result.push_back(mechanics.gap(i));
        result.push_back(mechanics.normal(i).velocity);
        if (closed[i] == ContactState::stick)
            result.push_back(mechanics.slip(i).velocity);
    }
    return result;
}

Expression ContactImpacts::restitution(std::size_t contact) const {
    return modes_.motion().expanded(model_.contacts[contact].restitution);
}

/// Newton's and Moreau's law: impulses at which each contact that takes one separates at -e times the velocity before.
bool ContactImpacts::solve_at_once(const Meeting& meeting, ContactImpact& impact) const {
    const ContactMechanics& mechanics = meeting.mechanics;
    const bool moreau = model_.contact_settings.law == ImpactLaw::moreau;
    std::vector<Expression> normal, tangential;
    for (std::size_t i = 0; i < impact.active.size(); ++i) {
        const Expression e = restitution(i);
        normal.push_back(meeting.takes_part(i) ? -(1.0 + e) * meeting.normal(i) : meeting.zero);
        tangential.push_back(impact.active[i] == ContactState::stick
                                 ? -(moreau ? 1.0 + e : meeting.zero + 1.0) * meeting.slip(i)
                                 : meeting.zero);
    }
    const ContactForces impulses = mechanics.solve(impact.active, normal, tangential);
    impact.changes = impulses.changes;
    bool possible = true;
    const auto require = [&](const Expression& function) {
        possible = possible && add_condition(impact.when, function, false);
    };
    for (std::size_t i = 0; i < impact.active.size(); ++i) {
        if (!meeting.takes_part(i))
            continue;
        if (impact.active[i] == ContactState::open) {
            require(mechanics.normal(i).along(impact.changes) - normal[i]);
            continue;
        }
        for (const ContactLimit& limit : impulses.limits)
            if (limit.beyond.front().first == i)
                require(limit.function);
        if (is_slip(impact.active[i])) {
            const Expression before = moreau ? (1.0 + restitution(i)) * meeting.slip(i) : meeting.slip(i);
            const Expression slip = before + mechanics.slip(i).along(impact.changes);
            require(impact.active[i] == ContactState::forward ? slip : -slip);
        }
    }
    for (const Expression& one : impulses.joint)
        require(one);
    const std::vector<bool> agree = meeting.vanishing->of(impulses.differences);
    for (std::size_t k = 0; k < agree.size(); ++k)
        if (!agree[k])
            require(-impulses.apart[k]);
    meeting.remove_vanishing(impact.when);
    return possible;
}

/// Poisson's law without friction. Compression ends with no contact approaching; expansion gives each contact at least
/// e times its impulse of compression, and more where it would approach again.
/// @param compressed contacts with an impulse of compression; those that are active take more in expansion
bool ContactImpacts::solve_poisson(const Meeting& meeting, const ContactStates& compressed,
                                   ContactImpact& impact) const {
    const ContactMechanics& mechanics = meeting.mechanics;
    std::vector<Expression> wanted;
    for (std::size_t i = 0; i < compressed.size(); ++i)
        wanted.push_back(meeting.takes_part(i) ? -meeting.normal(i) : meeting.zero);
    const ContactForces first = mechanics.solve(compressed, wanted, wanted);
    bool possible = true;
    const auto require = [&](const Expression& function) {
        possible = possible && add_condition(impact.when, function, false);
    };
    impact.changes.assign(first.changes.size(), meeting.zero);
    for (std::size_t i = 0; i < compressed.size(); ++i) {
        if (!meeting.takes_part(i))
            continue;
        if (compressed[i] == ContactState::open) {
            require(mechanics.normal(i).along(first.changes) - wanted[i]);
            continue;
        }
        require(first.normal[i]);
        const Expression impulse = (1.0 + restitution(i)) * first.normal[i];
        for (std::size_t k = 0; k < impact.changes.size(); ++k)
            impact.changes[k] = impact.changes[k] + mechanics.normal(i).response[k] * impulse;
    }
    std::vector<Expression> left;
    for (std::size_t i = 0; i < compressed.size(); ++i)
        left.push_back(meeting.takes_part(i) ? -(meeting.normal(i) + mechanics.normal(i).along(impact.changes))
                                             : meeting.zero);
    const ContactForces more = mechanics.solve(impact.active, left, left);
    const std::vector<bool> takes_none = meeting.vanishing->of(more.normal);
    for (std::size_t i = 0; i < compressed.size(); ++i) {
        if (!meeting.takes_part(i))
            continue;
        if (impact.active[i] == ContactState::open)
            require(mechanics.normal(i).along(more.changes) - left[i]);
        else if (takes_none[i]) // the same as with this contact open
            return false;
        else
            require(more.normal[i]);
    }
    meeting.remove_vanishing(impact.when);
    for (std::size_t k = 0; k < impact.changes.size(); ++k)
        impact.changes[k] = impact.changes[k] + more.changes[k];
    return possible;
}

/// Notes what is known of the contacts after an impact.
void ContactImpacts::note_after(const Meeting& meeting, ContactImpact& impact) const {
    using Normal = ContactKnowledge::Normal;
    const ContactMechanics& mechanics = meeting.mechanics;
    const ImpactLaw law = model_.contact_settings.law;
    std::vector<Expression> velocities; // normal and tangential ones of all contacts, after the impact
    for (std::size_t i = 0; i < impact.active.size(); ++i) {
        velocities.push_back(mechanics.normal(i).velocity + mechanics.normal(i).along(impact.changes));
        velocities.push_back(mechanics.rubs(i) ? mechanics.slip(i).velocity + mechanics.slip(i).along(impact.changes)
                                               : model_.number(1));
    }
    const std::vector<bool> vanishes = meeting.vanishing->of(velocities);
    std::vector<std::size_t> held;
    const auto note_zero = [&](std::size_t direction, const Expression& velocity) {
        held.push_back(direction);
        if (mechanics.directions().independent(held))
            impact.zero.push_back(velocity);
        else // it follows from the others
            held.pop_back();
    };
    for (std::size_t i = 0; i < impact.active.size(); ++i) {
        ContactKnowledge& one = impact.after.emplace_back();
        if (!meeting.takes_part(i)) {
            if (meeting.closed[i] != ContactState::open && vanishes[2 * i]) // otherwise it separates, or is hit next
                one.normal = Normal::touching;
            continue;
        }
        const bool active = impact.active[i] != ContactState::open;
        const bool touches =
            vanishes[2 * i] ||
            (active && (law == ImpactLaw::poisson || !meeting.is_closing(i) || restitution(i).is_number(0)));
        one.normal = touches ? Normal::touching : Normal::unknown;
        if (touches)
            note_zero(2 * i, mechanics.normal(i).velocity);
        if (!mechanics.rubs(i)) {
            one.slip = ContactState::closed;
        } else if (vanishes[2 * i + 1] || (impact.active[i] == ContactState::stick &&
                                           (law != ImpactLaw::moreau || restitution(i).is_number(0) ||
                                            meeting.closed[i] == ContactState::stick))) {
            one.at_rest = true;
            note_zero(2 * i + 1, mechanics.slip(i).velocity);
        } else if (is_slip(impact.active[i]) && law != ImpactLaw::moreau) {
            one.slip = impact.active[i];
        }
    }
}

std::vector<ContactImpact> ContactImpacts::at(std::size_t base, const ContactStates& closed,
                                              const std::vector<std::size_t>& closing) const {
    const ImpactLaw law = model_.contact_settings.law;
    const Vanishing vanishing(model_, inputs_, zeros(base, closed, closing));
    const Meeting meeting{modes_.mechanics(base),     closed,    closing, model_.number(0),
                          law == ImpactLaw::sequence, &vanishing};
    std::vector<std::vector<ContactState>> options;
    std::size_t parts = 0;
    bool smooth = true;
    for (std::size_t i = 0; i < closed.size(); ++i) {
        if (!meeting.takes_part(i)) {
            options.push_back({ContactState::open});
            continue;
        }
        ++parts;
        smooth = smooth && !meeting.mechanics.rubs(i);
        if (meeting.mechanics.rubs(i))
            options.push_back({ContactState::stick, ContactState::forward, ContactState::backward, ContactState::open});
        else
            options.push_back({ContactState::closed, ContactState::open});
    }
    const auto fewest_open = [](std::vector<ContactStates> all) {
        std::ranges::stable_sort(
            all, {}, [](const ContactStates& states) { return std::ranges::count(states, ContactState::open); });
        return all;
    };
    std::vector<ContactStates> expanding = fewest_open(combinations(options));
    if (parts == 1) { // a contact that approaches takes an impulse, and in expansion no more than its share
        options[closing.front()].pop_back();
        expanding = {ContactStates(closed.size(), ContactState::open)};
    }
    const std::vector<ContactStates> all = fewest_open(combinations(options));
    std::vector<ContactImpact> result;
    const auto always = [&] { return !result.empty() && result.back().when.empty(); };
    const auto add = [&](const ContactStates& compressed, const ContactStates& active) {
        ContactImpact impact{.active = active};
        if (always() || !modes_.possible(base, active) || !modes_.possible(base, compressed))
            return;
        if (law == ImpactLaw::poisson ? !solve_poisson(meeting, compressed, impact) : !solve_at_once(meeting, impact))
            return;
        note_after(meeting, impact);
        if (law == ImpactLaw::poisson) {
            impact.again = active;
            for (std::size_t i = 0; i < active.size(); ++i)
                if (compressed[i] != ContactState::open)
                    impact.active[i] = compressed[i];
        }
        result.push_back(std::move(impact));
    };
    for (const ContactStates& compressed : all) {
        if (law != ImpactLaw::poisson)
            add(compressed, compressed);
        else
            for (const ContactStates& active : expanding)
                add(compressed, active);
    }
    if (smooth && !result.empty()) // the inertia is positive definite: one of them always holds
        result.back().when.clear();
    return result;
}

/// Sets positions to those at which gaps that close, and those that are closed, vanish. Does nothing if only one does,
/// or where positions do not follow from them in numbers. @return whether it did
bool ContactImpacts::put_onto_gaps(StateMap& map, const Meeting& meeting) const {
    const std::vector<Expression> states = model_.state_symbols();
    std::vector<bool> positions(states.size(), true);
    for (const std::size_t state : model_.contact_settings.velocities)
        positions[state] = false;
    std::vector<std::size_t> shut;
    for (std::size_t i = 0; i < meeting.closed.size(); ++i)
        if (meeting.closed[i] != ContactState::open)
            shut.push_back(i);
    shut.insert(shut.end(), meeting.closing.begin(), meeting.closing.end());
    if (shut.size() < 2)
        return false;
    SurfaceMotion& motion = modes_.motion();
    motion.leave_surfaces();
    for (const std::size_t contact : shut)
        motion.add_surface(meeting.mechanics.gap(contact), positions);
    for (const std::size_t contact : shut)
        if (!motion.on_surface(meeting.mechanics.gap(contact)).is_number(0))
            return false;
    const std::vector<Expression> images = motion.on_surface(states);
    for (std::size_t i = 0; i < states.size(); ++i)
        if (!(images[i] == states[i]))
            map[i] = images[i];
    return true;
}

StateMap ContactImpacts::rest(std::size_t base, const ContactStates& closed, const ContactStates& after,
                              const std::vector<std::size_t>& closing) const {
    const Meeting meeting{modes_.mechanics(base), closed, closing, model_.number(0)};
    std::vector<Expression> normal, tangential, zero;
    for (std::size_t i = 0; i < after.size(); ++i) {
        normal.push_back(after[i] == ContactState::open ? meeting.zero : -meeting.normal(i));
        const bool sticks = after[i] == ContactState::stick;
        tangential.push_back(sticks ? -meeting.slip(i) : meeting.zero);
        if (after[i] != ContactState::open)
            zero.push_back(meeting.mechanics.normal(i).velocity);
        if (sticks && !meeting.mechanics.follows(after, i))
            zero.push_back(meeting.mechanics.slip(i).velocity);
    }
    StateMap map = modes_.velocity_map(meeting.mechanics.solve(after, normal, tangential).changes, zero);
    if (put_onto_gaps(map, meeting))
        return map;
    for (const std::size_t contact : closing) {
        const StateMap onto = modes_.motion().projection(meeting.mechanics.gap(contact));
        for (const StateMap::Change& change : onto.changes())
            map[change.state] = change.image;
    }
    return map;
}

} // namespace graze
