// What is told of the contacts of a model.

#include "graze/base/input_error.hpp"
#include "model/contact_modes.hpp"
#include "model/model_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

namespace {

/// Returns pairs of contacts that may be closed at once and of which an impulse in one changes the velocity of the
/// other: what an impact of both does depends on the law.
std::vector<std::string> coupled_contacts(const Model& model) {
    Model declared = declared_model(model);
    Expander expander(declared);
    SurfaceMotion motion(declared, expander);
    const ContactMechanics mechanics(declared, Places(model.name), motion, modes_with_contacts(declared).front());
    std::vector<std::string> pairs;
    for (std::size_t i = 0; i < mechanics.size(); ++i)
        for (std::size_t j = i + 1; j < mechanics.size(); ++j) {
            ContactStates both(mechanics.size(), ContactState::open);
            both[i] = both[j] = ContactState::closed;
            if (!mechanics.normal(i).along(mechanics.normal(j).response).is_number(0) && mechanics.independent(both))
                pairs.push_back(fmt::format("{} and {}", model.contacts[i].name, model.contacts[j].name));
        }
    return pairs;
}

} // namespace

std::string contact_text(const UnilateralContact& contact) {
    const std::string friction =
        contact.friction ? fmt::format(", friction {} against {}", formula(*contact.friction), formula(*contact.slip))
                         : "";
    return fmt::format("gap {}, restitution {}{}", formula(contact.gap), formula(contact.restitution), friction);
}

std::vector<std::string> contact_remarks(const Model& model) {
    if (model.contacts.empty() || !model.declared)
        return {};
    const ContactSettings& settings = model.contact_settings;
    std::vector<std::string> velocities, masses;
    for (const std::size_t state : settings.velocities)
        velocities.push_back(model.states[state].name);
    for (const Expression& mass : settings.mass)
        masses.push_back(formula(mass));
    std::vector<std::string> remarks{fmt::format(
        "law {}, impulses change {}, mass matrix {}{}", impact_law_words[static_cast<std::size_t>(settings.law)],
        fmt::join(velocities, ", "), masses.size() > velocities.size() ? "" : "diagonal ", fmt::join(masses, ", "))};
    const std::string handled =
        settings.law == ImpactLaw::sequence ? "one after another, in the order of the file" : "all at once";
    for (const std::string& pair : coupled_contacts(model))
        remarks.push_back(fmt::format("{} are coupled by the mass matrix: what an impact of both does depends on the "
                                      "law; this one takes them {}",
                                      pair, handled));
    return remarks;
}

} // namespace graze
