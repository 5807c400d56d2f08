// Modes of contacts: each combination of closed contacts, and of rest and slip in them, is the motion on the surfaces
// of their gaps, whose forces follow from linear equations.

#include "model/contact_modes.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

/// The combination of all but the last direction that equals the last one, by elimination; empty if there is none.
/// @param a n rows of n numbers: products of directions
std::vector<double> combination(std::vector<double> a, std::size_t n) {
    const std::size_t m = n - 1;
    for (std::size_t k = 0; k < m; ++k) {
        if (a[k * n + k] == 0)
            return {};
        for (std::size_t i = 0; i < m; ++i) {
            const double factor = a[i * n + k] / a[k * n + k];
            for (std::size_t j = k; i != k && j < n; ++j)
                a[i * n + j] -= factor * a[k * n + j];
        }
    }
    std::vector<double> shares;
    for (std::size_t k = 0; k < m; ++k)
        shares.push_back(a[k * n + m] / a[k * n + k]);
    return shares;
}

} // namespace

std::vector<std::size_t> modes_with_contacts(const Model& model) {
    if (model.contact_settings.modes)
        return *model.contact_settings.modes;
    std::vector<std::size_t> result;
    for (std::size_t mode = 0; mode < model.modes.size(); ++mode)
        if (!model.modes[mode].derived)
            result.push_back(mode);
    return result;
}

std::vector<std::string> names_of_contact_modes(const Model& model, const Places& places, std::size_t base) {
    constexpr std::size_t most = 128;
    std::vector<std::string> names{model.modes[base].name};
    for (const UnilateralContact& contact : model.contacts) {
        std::vector<std::string> longer;
        for (const std::string& one : names) {
            longer.push_back(one);
            if (!contact.friction)
                longer.push_back(one + contact_words(contact.name, ContactState::closed));
            else
                for (const ContactState state : {ContactState::stick, ContactState::forward, ContactState::backward})
                    longer.push_back(one + contact_words(contact.name, state));
        }
        names = std::move(longer);
        if (names.size() > most)
            throw InputError(places.of("contacts." + contact.name),
                             fmt::format("contacts up to '{}' make more than {} modes of '{}'", contact.name, most,
                                         model.modes[base].name),
                             "a mode may have seven contacts without friction, or three with: leave some out, or "
                             "write the modes that matter");
    }
    names.erase(names.begin()); // all are open
    return names;
}

ContactModes::ContactModes(Model& model, const Places& places)
    : model_(model), places_(places), expander_(model), motion_(model, expander_), bases_(modes_with_contacts(model)) {
    motion_.allow_parameters();
    for (const std::size_t base : bases_)
        mechanics_.emplace(base, std::make_unique<ContactMechanics>(model, places, motion_, base));
    add_events();
    require_separate_contacts();
    const ContactStates open(model.contacts.size(), ContactState::open);
    for (const std::size_t base : bases_)
        variant(base, open);
}

void ContactModes::add_events() {
    for (const UnilateralContact& contact : model_.contacts) {
        const std::string path = "contacts." + contact.name;
        gap_events_.push_back(derived_event(model_, places_, path,
                                            {.name = contact.name,
                                             .text = contact.text.empty() ? "the contact closes" : contact.text,
                                             .function = contact.gap}));
        stop_events_.push_back({});
        if (!contact.slip)
            continue;
        stop_events_.back() = {derived_event(model_, places_, path,
                                             {.name = contact.name + "-stops-forward",
                                              .text = "slip forward comes to an end",
                                              .function = *contact.slip}),
                               derived_event(model_, places_, path,
                                             {.name = contact.name + "-stops-backward",
                                              .text = "slip backward comes to an end",
                                              .function = -*contact.slip})};
    }
}

std::string ContactModes::contact_names(const std::vector<std::size_t>& contacts) const {
    std::vector<std::string> names;
    for (const std::size_t contact : contacts)
        names.push_back(fmt::format("'{}'", model_.contacts[contact].name));
    return fmt::format("{}", fmt::join(names, ", "));
}

/// If one gap's velocity follows from others while all are zero, the forces are not determined. Gaps of which one is
/// never zero together with the others, such as two stops on both sides, are no such case.
void ContactModes::require_separate_contacts() {
    const std::size_t n = model_.contacts.size();
    const ContactMechanics& one = mechanics(bases_.front());
    std::vector<std::size_t> bad; // sets of contacts, as bits
    for (std::size_t set = 1; set < std::size_t{1} << n; ++set) {
        if (std::ranges::any_of(bad, [&](std::size_t other) { return (set & other) == other; }))
            continue;
        ContactStates states(n, ContactState::open);
        std::vector<std::size_t> members;
        for (std::size_t i = 0; i < n; ++i)
            if ((set >> i & 1U) != 0) {
                states[i] = ContactState::closed;
                members.push_back(i);
            }
        if (one.independent(states))
            continue;
        bad.push_back(set);
        const std::string path = "contacts." + model_.contacts[members.back()].name;
        std::vector<Expression> entries;
        for (const std::size_t i : members)
            for (const std::size_t j : members)
                entries.push_back(one.normal(i).along(one.normal(j).response));
        std::vector<Expression> gaps;
        for (const std::size_t i : members)
            gaps.push_back(one.gap(i));
        const std::vector<double> shares = combination(values_at_start(model_, entries), members.size()),
                                  values = values_at_start(model_, gaps);
        if (members.size() == 1)
            throw InputError(places_.of(path + ".gap"),
                             fmt::format("impulses in the contact {} change nothing", contact_names(members)),
                             "look at the mass matrix, which must be positive definite, and at the gap");
        double sum = -values.back(), size = std::abs(sum);
        for (std::size_t i = 0; i < shares.size(); ++i) {
            sum += shares[i] * values[i];
            size += std::abs(shares[i] * values[i]);
        }
        constexpr double same = 1e-9;
        if (!(std::abs(sum) > same * size))
            throw InputError(places_.of(path),
                             fmt::format("the contacts {} are redundant: the velocity of one gap follows from the "
                                         "others, so that their forces are not determined",
                                         contact_names(members)),
                             "leave one out, or give a body between them a degree of freedom of its own");
    }
}

std::string ContactModes::mode_name(std::size_t base, const ContactStates& states) const {
    std::string name = model_.modes[base].name;
    for (std::size_t i = 0; i < states.size(); ++i)
        name += contact_words(model_.contacts[i].name, states[i]);
    return name;
}

bool ContactModes::possible(std::size_t base, const ContactStates& states) {
    const auto known = possible_.find({base, states});
    if (known != possible_.end())
        return known->second;
    return possible_[{base, states}] = mechanics(base).independent(states);
}

bool ContactModes::moves(std::size_t base, const ContactStates& states) {
    const auto [known, added] = moves_.emplace(std::pair(base, states), false);
    return known->second = added ? mechanics(base).can_slip(states) : known->second;
}

const ContactVariant& ContactModes::variant(std::size_t base, const ContactStates& states) {
    const auto known = variants_.find({base, states});
    if (known != variants_.end())
        return known->second;
    new_.emplace_back(base, states);
    return variants_.emplace(std::pair(base, states), made(base, states)).first->second;
}

std::vector<std::pair<std::size_t, ContactStates>> ContactModes::take_new() {
    return std::exchange(new_, {});
}

ContactVariant ContactModes::made(std::size_t base, const ContactStates& states) {
    const ContactMechanics& free = mechanics(base);
    ContactVariant result{.mode = *model_.find_mode(mode_name(base, states)), .states = states};
    result.force = free.forces(states);
    motion_.leave_surfaces();
    std::vector<bool> velocities(model_.states.size(), false);
    for (const std::size_t state : model_.contact_settings.velocities)
        velocities[state] = true;
    std::vector<bool> positions = velocities;
    positions.flip();
    for (std::size_t i = 0; i < states.size(); ++i)
        if (states[i] != ContactState::open)
            motion_.add_surface(free.gap(i), positions);
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (states[i] != ContactState::open)
            motion_.add_surface(free.normal(i).velocity, velocities);
        if (states[i] == ContactState::stick && !free.follows(states, i))
            motion_.add_surface(free.slip(i).velocity, velocities);
    }
    for (std::size_t i = 0; i < states.size(); ++i) {
        const auto accelerated = [&](const ContactDirection& direction) {
            return motion_.on_surface(direction.acceleration + direction.along(result.force.changes));
        };
        result.normal_acceleration.push_back(accelerated(free.normal(i)));
        result.slip_acceleration.push_back(free.rubs(i) ? accelerated(free.slip(i)) : model_.number(0));
    }
    if (result.mode != base) {
        std::vector<Expression> field = free.field();
        for (std::size_t k = 0; k < result.force.changes.size(); ++k) {
            Expression& rate = field[model_.contact_settings.velocities[k]];
            rate = rate + result.force.changes[k];
        }
        Mode& mode = model_.modes[result.mode];
        mode.text = model_.modes[base].text;
        mode.rates = motion_.tangent(std::move(field));
    }
    for (auto* forces : {&result.force.normal, &result.force.tangential, &result.force.regular, &result.force.joint,
                         &result.force.apart})
        *forces = motion_.on_surface(*forces);
    for (ContactLimit& limit : result.force.limits) {
        limit.function = motion_.on_surface(limit.function);
        limit.squares = motion_.on_surface(limit.squares);
    }
    return result;
}

StateMap ContactModes::velocity_map(const std::vector<Expression>& changes, const std::vector<Expression>& zero) {
    const std::vector<Expression> states = model_.state_symbols();
    std::vector<Expression> images = states;
    std::vector<bool> velocities(states.size(), false);
    for (std::size_t k = 0; k < changes.size(); ++k) {
        const std::size_t state = model_.contact_settings.velocities[k];
        velocities[state] = true;
        images[state] = states[state] + changes[k];
    }
    motion_.leave_surfaces();
    std::vector<std::size_t> replaced;
    for (const Expression& velocity : zero)
        if (const auto one = motion_.solved(motion_.on_surface(velocity), velocities); one && velocities[one->state]) {
            motion_.add_surface(velocity, velocities);
            replaced.push_back(one->state);
        }
    std::vector<Replacement> after;
    for (std::size_t i = 0; i < states.size(); ++i)
        after.emplace_back(states[i], images[i]);
    StateMap map(states);
    for (std::size_t i = 0; i < states.size(); ++i)
        if (const bool exact = std::ranges::find(replaced, i) != replaced.end(); exact)
            map[i] = substitute(motion_.on_surface(states[i]), after);
        else if (!(images[i] == states[i]))
            map[i] = images[i];
    return map;
}

} // namespace graze
