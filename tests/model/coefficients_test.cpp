// Coefficients of contacts and frictions outside the range of their laws.

#include "model/coefficients.hpp"

#include "base/message_of.hpp"
#include "graze/model/check.hpp"
#include "graze/model/model_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace graze::coefficients_test {

using testing::message_of;

/// A mass that falls on a rough floor.
Model block(const std::string& restitution, const std::string& friction, const std::string& mass,
            const std::string& parameters = "") {
    return parse_model("[parameters]\n" + parameters +
                           "\n[states]\nx = 0\ny = 1\nu = 1\nv = 0\n"
                           "[modes.free]\nrates = { x = 'u', y = 'v', u = 0, v = -1 }\n"
                           "[contacts]\nvelocities = ['u', 'v']\nmass = " +
                           mass + "\n[contacts.floor]\ngap = 'y'\nslip = 'u'\nrestitution = " + restitution +
                           "\nfriction = " + friction + "\n",
                       "m.toml");
}

/// A mass on a belt.
Model belt(const std::string& coefficients, const std::string& parameters = "") {
    return parse_model("[parameters]\n" + parameters +
                           "\n[states]\nx = 0\nv = 0\n"
                           "[modes.run]\nrates = { x = 'v', v = '-x - rub' }\n"
                           "[friction.rub]\nvelocity = 'v - 1'\nnormal = 1\n" +
                           coefficients,
                       "m.toml");
}

/// Returns whether there is such a warning, about a table of contacts or frictions.
bool warns(const Model& model, const std::string& text) {
    return std::ranges::any_of(located_warnings(model), [&](const ModelWarning& one) {
        return one.text.find(text) != std::string::npos &&
               (one.part == "contacts.floor" || one.part == "contacts.mass" || one.part == "friction.rub");
    });
}

TEST(Coefficients, NumbersOutOfRangeAreRefused) {
    const auto told = [](const std::string& e, const std::string& mu, const std::string& mass) {
        return message_of([&] { block(e, mu, mass); });
    };
    EXPECT_EQ(told("0", "0", "[1, 2]"), "");
    EXPECT_EQ(told("1", "2.5", "[[1, 0.5], [0.5, 2]]"), "");
    EXPECT_EQ(told("-1", "0.3", "[1, 2]"),
              "m.toml:16:15: the restitution of the contact 'floor' is -1; give a number from 0 to 1");
    EXPECT_EQ(told("'2*0.75'", "0.3", "[1, 2]"),
              "m.toml:16:15: the restitution of the contact 'floor' is 1.5; give a number from 0 to 1");
    EXPECT_EQ(told("0.5", "-0.3", "[1, 2]"),
              "m.toml:17:12: the friction of the contact 'floor' is -0.3; give a number that is not negative");
    for (const std::string mass : {"[1, 'sqrt(-1)']", "[[1, 'sqrt(-1)'], ['sqrt(-1)', 2]]"})
        EXPECT_NE(told("0.5", "0.3", mass).find("entry 2 of the mass matrix is not a number; give a finite number"),
                  std::string::npos);
    EXPECT_NE(told("0.5", "0.3", "[1, -2]").find("the mass matrix is not positive definite"), std::string::npos);
    EXPECT_NE(told("'0/0'", "0.3", "[1, 2]").find("the restitution of the contact 'floor' is not a number"),
              std::string::npos);
    EXPECT_EQ(message_of([] { belt("coefficient = 0.5\nstatic = 0.7\n"); }), "");
    EXPECT_NE(message_of([] { belt("coefficient = -0.5\n"); }).find("the coefficient of the friction 'rub' is -0.5"),
              std::string::npos);
    EXPECT_NE(message_of([] {
                  belt("coefficient = 0.5\nstatic = -1\n");
              }).find("the static coefficient of the friction 'rub' is -1"),
              std::string::npos);
}

TEST(Coefficients, ThatDependOnParametersGiveWarnings) {
    EXPECT_FALSE(warns(block("'e'", "'mu'", "['m', 1]", "e = 0.5\nmu = 0.3\nm = 2"), "it should be"));
    EXPECT_TRUE(warns(block("'e'", "'mu'", "['m', 1]", "e = 1.5\nmu = 0.3\nm = 2"),
                      "the restitution of the contact 'floor' is 1.5: it should be a number from 0 to 1"));
    EXPECT_TRUE(warns(block("'e'", "'mu'", "['m', 1]", "e = 0.5\nmu = -0.3\nm = 2"),
                      "the friction of the contact 'floor' is -0.3: it should be a number that is not negative"));
    EXPECT_FALSE(warns(belt("coefficient = 'mu/(1 + v^2)'\n", "mu = 0.3"), "it should be"));
    EXPECT_TRUE(warns(belt("coefficient = 'mu'\nstatic = 0.5\n", "mu = -0.3"),
                      "the coefficient of the friction 'rub' is -0.3"));
}

} // namespace graze::coefficients_test
