// What declarations of contacts must be, whoever has written them.

#include "graze/base/input_error.hpp"
#include "model/contact_modes.hpp"
#include "model/model_completion.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <set>
#include <string>

namespace graze {

void check_contacts(const Model& model, const Places& places) {
    if (model.contacts.empty())
        return;
    const auto fail = [&](const std::string& path, const std::string& problem, const std::string& remedy) {
        throw InputError(places.of(path), problem, remedy);
    };
    const ContactSettings& settings = model.contact_settings;
    const std::size_t n = settings.velocities.size();
    if (n == 0)
        fail("contacts.velocities", "contacts.velocities names no state", "name the velocities that impulses change");
    if (std::set(settings.velocities.begin(), settings.velocities.end()).size() != n)
        fail("contacts.velocities", "a velocity is named twice", "remove one of the two");
    if (settings.mass.size() != n && settings.mass.size() != n * n)
        fail("contacts.mass", fmt::format("the mass matrix has {} entries for {} velocities", settings.mass.size(), n),
             "give its diagonal or all of its rows");
    if (!model.slides.empty() || !model.frictions.empty())
        fail(model.slides.empty() ? "friction" : "slides", "a model with contacts cannot have slides or frictions",
             "give friction to contacts, or write the modes out");
    if (modes_with_contacts(model).empty())
        fail("contacts.modes", "no mode has contacts", "name a mode, or leave the list out");
    for (const std::size_t mode : modes_with_contacts(model))
        if (model.modes[mode].derived)
            fail("contacts.modes", fmt::format("the mode '{}' is made by contacts", model.modes[mode].name),
                 "name the modes in which all contacts are open");
    for (const UnilateralContact& contact : model.contacts) {
        const std::string path = "contacts." + contact.name;
        if (contact.friction.has_value() != contact.slip.has_value())
            fail(path,
                 fmt::format("the contact '{}' has friction without slip, or slip without friction", contact.name),
                 "give both, or none");
        if (contact.friction && settings.law == ImpactLaw::poisson)
            fail(
                path + ".friction",
                fmt::format("the law of Poisson is for contacts without friction, and '{}' has friction", contact.name),
                "use law = \"newton\" or \"moreau\", or leave the friction out");
    }
}

} // namespace graze
