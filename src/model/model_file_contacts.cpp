#include "model/model_file_contacts.hpp"

#include "graze/base/input_error.hpp"
#include "model/contact_forces.hpp"
#include "model/model_completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// Keys of the table itself; all other entries are contacts.
constexpr std::array general_keys{"law", "velocities", "mass", "modes"};

bool is_general(const TomlEntry& entry) {
    return std::ranges::find(general_keys, entry.name) != general_keys.end();
}

} // namespace

void ContactParts::read_contacts(const TomlEntry& group) {
    std::vector<TomlEntry> general;
    for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
        places_.set(entry.path, entry.place);
        if (is_general(entry)) {
            general.push_back(entry);
            continue;
        }
        UnilateralContact& contact = model_.contacts.emplace_back();
        contact.name = entry.name;
        mistakes_.attempt([&] {
            if (!entry.node->is_table())
                throw InputError(entry.place, fmt::format("the contact '{}' is not a table", entry.name),
                                 fmt::format("write [contacts.{}] with gap = \"...\"; general keys are law, "
                                             "velocities, mass, modes",
                                             entry.name));
            read_contact(entry, contact);
        });
    }
    mistakes_.attempt([&] { read_settings(general); });
    mistakes_.attempt([&] {
        if (model_.contacts.empty())
            throw InputError(group.place, "[contacts] has no contact", "add one: [contacts.floor] with gap = \"...\"");
        for (const auto& [key, what] : {std::pair("velocities", "velocities"), std::pair("mass", "mass matrix")})
            if (std::ranges::find(general, key, &TomlEntry::name) == general.end())
                fail_missing(group, what, key);
    });
}

void ContactParts::read_forces(std::size_t mode, const TomlEntry& part) {
    ModeForces& forces = forces_[mode];
    forces.place = part.place;
    forces.of_states.resize(model_.states.size());
    for (const TomlEntry& force : reader_.entries(reader_.table(part), part.path))
        forces.of_states[key_index(force, model_.states, "state")] = expression(force);
}

bool ContactParts::has_force(std::size_t mode, std::size_t state) const {
    const auto found = forces_.find(mode);
    return found != forces_.end() && !found->second.of_states[state].empty();
}

/// Forces stand for the rates of all velocities that contacts change.
void ContactParts::set_accelerations() {
    const ContactSettings& settings = model_.contact_settings;
    for (const auto& one : forces_) {
        const std::size_t mode = one.first;
        const ModeForces& given = one.second;
        if (settings.velocities.empty())
            throw InputError(given.place,
                             fmt::format("mode '{}' has forces, and no contacts.velocities say on what they act",
                                         model_.modes[mode].name),
                             "give rates, or name the velocities in [contacts]");
        std::vector<Expression> forces;
        const auto refuse = [&](std::size_t state, const char* what) {
            throw InputError(
                given.place,
                fmt::format("mode '{}' has {} '{}'", model_.modes[mode].name, what, model_.states[state].name),
                "give a force for each of contacts.velocities and no other state, or the rates instead");
        };
        for (const std::size_t velocity : settings.velocities)
            if (given.of_states[velocity].empty())
                refuse(velocity, "no force on the velocity");
            else
                forces.push_back(given.of_states[velocity]);
        for (std::size_t state = 0; state < given.of_states.size(); ++state)
            if (!given.of_states[state].empty() && std::ranges::count(settings.velocities, state) == 0)
                refuse(state, "a force on a state that impulses do not change,");
        const std::vector<Expression> accelerations = accelerations_by(settings.mass, forces);
        for (std::size_t i = 0; i < forces.size(); ++i) {
            Expression& rate = model_.modes[mode].rates[settings.velocities[i]];
            if (!rate.empty())
                throw InputError(given.place,
                                 fmt::format("mode '{}' has both a rate and a force for '{}'", model_.modes[mode].name,
                                             model_.states[settings.velocities[i]].name),
                                 "keep one of the two");
            rate = accelerations[i];
        }
    }
}

void ContactParts::read_settings(const std::vector<TomlEntry>& entries) {
    ContactSettings& settings = model_.contact_settings;
    for (const TomlEntry& entry : entries)
        if (entry.name == "law") {
            settings.law = static_cast<ImpactLaw>(
                choice(entry, std::vector<std::string>(impact_law_words.begin(), impact_law_words.end())));
        } else if (entry.name == "velocities") {
            for (const TomlEntry& state : reader_.elements(entry))
                settings.velocities.push_back(index(state, model_.states, "state"));
        } else if (entry.name == "modes") {
            settings.modes.emplace();
            for (const TomlEntry& mode : reader_.elements(entry))
                settings.modes->push_back(index(mode, model_.modes, "mode"));
        }
    for (const TomlEntry& entry : entries)
        if (entry.name == "mass")
            read_mass(entry);
}

/// Reads the diagonal of the mass matrix, or all of its rows.
void ContactParts::read_mass(const TomlEntry& entry) {
    std::vector<Expression>& mass = model_.contact_settings.mass;
    const std::size_t n = model_.contact_settings.velocities.size();
    const std::vector<TomlEntry> rows = reader_.elements(entry);
    const auto require_size = [&](const TomlEntry& one, std::size_t size) {
        if (n > 0 && size != n)
            throw InputError(reader_.place(*one.node),
                             fmt::format("{} has {} entries for {} velocities", one.path, size, n),
                             "give one for each of the velocities");
    };
    require_size(entry, rows.size());
    const bool full = !rows.empty() && rows.front().node->is_array();
    for (const TomlEntry& row : rows) {
        if (row.node->is_array() != full)
            throw InputError(reader_.place(*row.node), "some entries of the mass matrix are rows and some are not",
                             "give the diagonal, one entry for each velocity, or all rows");
        if (!full) {
            mass.push_back(expression(row));
            continue;
        }
        const std::vector<TomlEntry> columns = reader_.elements(row);
        require_size(row, columns.size());
        for (const TomlEntry& column : columns)
            mass.push_back(expression(column));
    }
    for (std::size_t i = 0; full && i < n; ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (!(mass[i * n + j] == mass[j * n + i]))
                throw InputError(reader_.place(*entry.node),
                                 fmt::format("the mass matrix is not symmetric: entries {},{} and {},{} differ", i + 1,
                                             j + 1, j + 1, i + 1),
                                 "write the same expression in both places");
}

void ContactParts::read_contact(const TomlEntry& entry, UnilateralContact& contact) {
    read_parts(entry, {{"gap", expression_into(contact.gap)},
                       {"restitution", expression_into(contact.restitution)},
                       {"friction", [&](const TomlEntry& part) { contact.friction = expression(part); }},
                       {"slip", [&](const TomlEntry& part) { contact.slip = expression(part); }},
                       {"text", text_into(contact.text)}});
    if (contact.gap.empty())
        fail_missing(entry, "gap", "gap");
    if (contact.restitution.empty())
        fail_missing(entry, "restitution", "restitution");
    if (contact.friction.has_value() != contact.slip.has_value())
        fail_missing(entry, contact.friction ? "velocity along the surface" : "coefficient of friction",
                     contact.friction ? "slip" : "friction");
}

} // namespace graze
