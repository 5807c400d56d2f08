#include "model/coefficients.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/model_completion.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

namespace {

std::string shown(double number) {
    return std::isnan(number) ? "not a number" : fmt::format("{:g}", number);
}

} // namespace

std::string Coefficient::part() const {
    return path.substr(0, path.find('.', path.find('.') + 1));
}

bool Coefficient::allows(double number) const {
    switch (range) {
    case Range::finite:
        return std::isfinite(number);
    case Range::not_negative:
        return std::isfinite(number) && number >= 0;
    case Range::share:
        return number >= 0 && number <= 1;
    }
    return false;
}

const char* Coefficient::allowed() const {
    switch (range) {
    case Range::finite:
        return "a finite number";
    case Range::not_negative:
        return "a number that is not negative";
    case Range::share:
        return "a number from 0 to 1";
    }
    return "";
}

std::vector<Coefficient> coefficients_of(const Model& model) {
    std::vector<Coefficient> result;
    for (const UnilateralContact& contact : model.contacts) {
        const std::string path = "contacts." + contact.name + ".",
                          of = fmt::format(" of the contact '{}'", contact.name);
        result.push_back(
            {path + "restitution", "the restitution" + of, contact.restitution, Coefficient::Range::share});
        if (contact.friction)
            result.push_back({path + "friction", "the friction" + of, *contact.friction});
    }
    for (const Friction& friction : model.frictions) {
        const std::string path = "friction." + friction.name + ".",
                          of = fmt::format(" of the friction '{}'", friction.name);
        result.push_back({path + "coefficient", "the coefficient" + of, friction.coefficient});
        if (friction.static_coefficient)
            result.push_back({path + "static", "the static coefficient" + of, *friction.static_coefficient});
    }
    for (std::size_t i = 0; i < model.contact_settings.mass.size(); ++i)
        result.push_back({"contacts.mass", fmt::format("entry {} of the mass matrix", i + 1),
                          model.contact_settings.mass[i], Coefficient::Range::finite});
    return result;
}

void check_coefficients(const Model& model, const Places& places) {
    for (const Coefficient& one : coefficients_of(model)) {
        if (!symbols_of({&one.value, 1}).empty())
            continue;
        const std::vector<double> number = values_at_start(model, {&one.value, 1});
        if (!number.empty() && !one.allows(number.front()))
            throw InputError(places.of(one.path), fmt::format("{} is {}", one.what, shown(number.front())),
                             fmt::format("give {}", one.allowed()));
    }
}

} // namespace graze
