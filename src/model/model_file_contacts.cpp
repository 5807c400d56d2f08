#include "model/model_file_contacts.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
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
        if (model_.contact_settings.velocities.empty())
            fail_missing(group, "velocities", "velocities");
        if (model_.contact_settings.mass.empty())
            fail_missing(group, "mass matrix", "mass");
    });
}

void ContactParts::read_settings(const std::vector<TomlEntry>& entries) {
    ContactSettings& settings = model_.contact_settings;
    for (const TomlEntry& entry : entries)
        if (entry.name == "law") {
            settings.law = std::array{ImpactLaw::newton, ImpactLaw::moreau, ImpactLaw::poisson,
                                      ImpactLaw::sequence}[choice(entry, {"newton", "moreau", "poisson", "sequence"})];
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
