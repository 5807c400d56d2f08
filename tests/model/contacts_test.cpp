// Contacts: what is made of them, how they are written, and mistakes in them.

#include "base/message_of.hpp"
#include "graze/base/input_errors.hpp"
#include "graze/model/check.hpp"
#include "graze/model/model_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace graze::contacts_test {

using namespace graze::testing;

const std::string corner = R"toml(name = "corner"
[parameters]
mu = 0.3
[states]
x = 1
y = 1
u = -1
v = -1
[modes.free]
rates = { x = "u", y = "v", u = 0, v = -1 }
[contacts]
law = "newton"
velocities = ["u", "v"]
mass = [1, 2]
[contacts.floor]
gap = "y"
restitution = 0.5
friction = "mu"
slip = "u"
[contacts.wall]
gap = "x"
restitution = 0.25
)toml";

Model parsed(const std::string& text) {
    return parse_model(text, "m.toml");
}

std::string with(std::string text, const std::string& part, const std::string& other) {
    const std::size_t at = text.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return text.replace(at, part.size(), other);
}

std::vector<std::string> names_of_modes(const Model& model) {
    std::vector<std::string> names;
    for (const Mode& mode : model.modes)
        names.push_back(mode.name);
    return names;
}

/// Returns a model whose contacts have not been completed.
Model declared(const std::string& text) {
    const Model made = parsed(text);
    Model model;
    model.graph = made.graph->copy();
    const auto own = [&](const Expression& one) { return model.graph->adopt(one); };
    model.name = made.name;
    model.parameters = made.parameters;
    model.states = made.states;
    for (State& state : model.states)
        state.initial = own(state.initial);
    model.modes = {made.modes.front()};
    model.modes.front().watched.clear();
    for (Expression& rate : model.modes.front().rates)
        rate = own(rate);
    model.contacts = made.contacts;
    for (UnilateralContact& contact : model.contacts) {
        contact.gap = own(contact.gap);
        contact.restitution = own(contact.restitution);
        if (contact.friction) {
            contact.friction = own(*contact.friction);
            contact.slip = own(*contact.slip);
        }
    }
    model.contact_settings = made.contact_settings;
    for (Expression& mass : model.contact_settings.mass)
        mass = own(mass);
    return model;
}

TEST(ContactDeclarations, MakeModes) {
    const Model model = parsed(corner);
    const std::vector<std::string> expected{"free",
                                            "free-wall",
                                            "free-floor-stick",
                                            "free-floor-stick-wall",
                                            "free-floor-forward",
                                            "free-floor-forward-wall",
                                            "free-floor-backward",
                                            "free-floor-backward-wall"};
    std::vector<std::string> names = names_of_modes(model);
    for (const std::string& name : names)
        EXPECT_NE(std::ranges::find(expected, name), expected.end()) << name;
    EXPECT_EQ(names.front(), "free");
    ASSERT_TRUE(model.find_event("floor") && model.find_event("free-floor-forward-floor-opens"));
    // The force of the floor is the weight, a unit of mass twice.
    const Event& opens = model.events[*model.find_event("free-floor-forward-floor-opens")];
    EXPECT_EQ(opens.function.node().value, 2);
}

TEST(ContactDeclarations, TwoStopsOnBothSidesHaveNoCommonMode) {
    const std::string stops = with(corner, "gap = \"x\"", "gap = \"2 - y\"");
    for (const std::string& name : names_of_modes(parsed(stops)))
        EXPECT_FALSE(name.find("floor") != std::string::npos && name.find("wall") != std::string::npos) << name;
}

TEST(ContactDeclarations, AreWrittenAndReadBack) {
    for (const char* law : {"newton", "moreau", "sequence"}) {
        const Model model = parsed(with(corner, "newton", law));
        const std::string text = write_model(model);
        EXPECT_NE(text.find(fmt::format("[contacts]\nlaw = \"{}\"\nvelocities = [\"u\", \"v\"]\nmass = [1, 2]\n", law)),
                  std::string::npos)
            << text;
        EXPECT_EQ(write_model(parsed(text)), text);
    }
    const std::string full = with(corner, "mass = [1, 2]", "mass = [[1, \"mu\"], [\"mu\", 2]]");
    EXPECT_NE(write_model(parsed(full)).find("mass = [[1, \"mu\"], [\"mu\", 2]]"), std::string::npos);
}

/// A model that was changed after its declarations were completed is written with what they have made.
TEST(ContactDeclarations, OfAChangedModelAreWrittenOut) {
    Model model = parsed(corner);
    model.modes.front().text = "changed";
    const std::string text = write_model(model);
    EXPECT_EQ(text.find("[contacts"), std::string::npos);
    const Model again = parsed(text);
    EXPECT_EQ(again.transitions.size(), model.transitions.size());
    EXPECT_EQ(write_model(again), text);
}

/// Forces are divided by the mass matrix.
TEST(ContactDeclarations, ForcesStandForRates) {
    const std::string forced = with(with(corner, "rates = { x = \"u\", y = \"v\", u = 0, v = -1 }",
                                         "rates = { x = \"u\", y = \"v\" }\nforces = { u = 3, v = -4 }"),
                                    "mass = [1, 2]", "mass = [[2, 1], [1, 2]]");
    const Model model = parsed(forced);
    const std::vector<double> rates = model.function_of(model.modes.front().rates)({{1, 1, -1, -1, 0.3}});
    EXPECT_NEAR(rates[2], 10.0 / 3, 1e-15);
    EXPECT_NEAR(rates[3], -11.0 / 3, 1e-15);
}

/// Of C++ models, whose parts no parser has checked.
TEST(ContactDeclarations, OfModelsBuiltInCodeAreChecked) {
    const Model good = declared(corner);
    const auto expect = [&](const std::function<void(Model&)>& change, const std::string& message) {
        Model bad = good;
        change(bad);
        const std::string told = message_of([&] {
            bad.complete();
            bad.validate();
        });
        EXPECT_NE(told.find(message), std::string::npos) << message << " in " << told;
        EXPECT_FALSE(told.empty());
    };
    expect([](Model& one) { one.contact_settings.velocities.clear(); }, "contacts.velocities names no state");
    expect([](Model& one) { one.contact_settings.velocities = {0, 99}; }, "contacts.velocities");
    expect([](Model& one) { one.contact_settings.mass.pop_back(); }, "has 1 entries for 2 velocities");
    expect([](Model& one) { one.contact_settings.modes = {7}; }, "contacts.modes");
    expect([](Model& one) { one.contact_settings.modes.emplace(); }, "no mode has contacts");
    expect([](Model& one) { one.contacts[0].slip.reset(); }, "friction without slip");
    expect([](Model& one) { one.contacts[1].gap = {}; }, "");
    expect([](Model& one) { one.contacts[1].name = "a b"; }, "a b");
}

TEST(ContactDeclarations, TellMistakes) {
    const auto expect = [](const std::string& text, const std::string& message) {
        EXPECT_EQ(message_of([&] { parsed(text); }), message);
    };
    expect(with(corner, "velocities = [\"u\", \"v\"]\n", ""),
           "m.toml:11:2: contacts has no velocities; add velocities = ...");
    expect(with(corner, "mass = [1, 2]", "mass = [1]"),
           "m.toml:14:8: contacts.mass has 1 entries for 2 velocities; give one for each of the velocities");
    expect(
        with(corner, "mass = [1, 2]", "mass = [[1, 2], [3, 4]]"),
        "m.toml:14:8: the mass matrix is not symmetric: entries 2,1 and 1,2 differ; write the same expression in both "
        "places");
    expect(with(corner, "slip = \"u\"\n", ""),
           "m.toml:15:11: contacts.floor has no velocity along the surface; add slip = ...");
    expect(with(corner, "mass = [1, 2]", "mass = [1, 0]"),
           "m.toml:14:1: the mass matrix is not positive definite at the initial state; give masses and moments of "
           "inertia, which are positive");
    expect(with(corner, "gap = \"x\"", "gap = \"x + u\""),
           "m.toml:21:7: the gap of 'wall' depends on the velocity 'u', which impulses change; give it in terms of "
           "positions");
    expect(with(corner, "gap = \"x\"", "gap = \"1 + 1\""),
           "m.toml:21:7: the rate of the gap of 'wall' does not depend on a velocity; name in `velocities` the states "
           "that "
           "impulses change, and give the gap in terms of positions whose rates contain them");
    expect(with(corner, "x = \"u\", y", "x = \"u^2\", y"),
           "m.toml:21:7: the rate of the gap of 'wall' is not linear in 'u'; give the gap in terms of positions, and "
           "velocities in which their rates are linear");
    expect(with(corner, "\"newton\"", "\"poisson\""),
           "m.toml:18:12: the law of Poisson is for contacts without friction, and 'floor' has friction; use law = "
           "\"newton\" or \"moreau\", or leave the friction out");
    expect(with(corner, "velocities = [\"u\", \"v\"]", "velocities = [\"u\", \"u\"]"),
           "m.toml:13:1: a velocity is named twice; remove one of the two");
    expect(with(corner, "[modes.free]\n", "[modes.free]\nforces = { u = 1 }\n"),
           "m.toml:10:1: mode 'free' has no force on the velocity 'v'; give a force for each of contacts.velocities "
           "and no other state, or the rates instead");
    expect(with(corner, "[modes.free]\n", "[modes.free]\nforces = { u = 1, v = 2, x = 0 }\n"),
           "m.toml:10:1: mode 'free' has a force on a state that impulses do not change, 'x'; give a force for each "
           "of contacts.velocities and no other state, or the rates instead");
    expect(with(corner, "gap = \"x\"", "gap = \"2 - y\"") + "[initial]\nmode = \"free-floor-stick-wall\"\n",
           "m.toml:24:8: the mode 'free-floor-stick-wall' does not exist: at the initial state its contacts cannot be "
           "closed at once; name one of 'free', 'free-wall', 'free-floor-stick', 'free-floor-forward', "
           "'free-floor-backward'");
    expect(with(corner, "[modes.free]\n", "[modes.free]\nforces = { u = 1, v = 2 }\n"),
           "m.toml:10:1: mode 'free' has both a rate and a force for 'u'; keep one of the two");
    expect(
        corner + "\n[friction.rub]\nvelocity = \"u\"\nnormal = 1\ncoefficient = 1\n",
        "m.toml:24:2: a model with contacts cannot have slides or frictions; give friction to contacts, or write the "
        "modes out");
    expect(
        with(corner, "gap = \"x\"", "gap = \"2*y\""),
        "m.toml:20:11: the contacts 'floor', 'wall' are redundant: the velocity of one gap follows from the others, so "
        "that their forces are not determined; leave one out, or give a body between them a degree of freedom of its "
        "own");
}

/// Whether a contact acts again in expansion is decided by its rate after compression. Alone it never does; beside one
/// that closes, one that was closed does not if both coefficients are the same, where its rate is zero: round-off would
/// decide on the alternatives that are missing.
TEST(ContactDeclarations, PoissonsLawDecidesNothingByRoundOff) {
    const auto labels_with_again = [](const std::string& other, const std::string& transition) {
        const Model model = parsed(fmt::format(R"toml(parameters = {{ e = 0.7, f = 0.7 }}
states = {{ x = 0, v = 0, y = 1.5, u = 0 }}
modes.free.rates = {{ x = "v", v = "-x - 0.1*v", y = "u", u = "1.2 - y - 0.1*u" }}
contacts.velocities = ["v", "u"]
contacts.mass = [1, 0.5]
contacts.law = "poisson"
contacts.stop = {{ gap = "x + 0.5", restitution = "e" }}
contacts.pair = {{ gap = "y - x - 0.7", restitution = "{}" }}
)toml",
                                               other));
        return std::ranges::count_if(model.transitions, [&](const Transition& one) {
            return one.label.starts_with(transition) && one.label.find("again") != std::string::npos;
        });
    };
    for (const std::string other : {"e", "f"}) {
        EXPECT_EQ(labels_with_again(other, "free:stop:"), 0);
        EXPECT_EQ(labels_with_again(other, "free:pair:"), 0);
    }
    EXPECT_LT(labels_with_again("e", "free-stop:pair:"), labels_with_again("f", "free-stop:pair:"));
}

} // namespace graze::contacts_test
