#include "base/message_of.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/orbit/signature.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace graze::signature_test {

std::string rewritten(const char* model_name, const char* text) {
    const Model model = load_model(model_name);
    const Signature signature = parse_signature(model, text);
    validate_signature(model, signature);
    const std::string written = to_string(model, signature);
    EXPECT_EQ(parse_signature(model, written), signature) << written;
    return written;
}

TEST(Signature, RepetitionsAndSeparatorsAreNormalised) {
    EXPECT_EQ(rewritten("impact-microactuator", "{J1,J8}^2"), "(J1 J8)^2");
    EXPECT_EQ(rewritten("impact-microactuator", "J5"), "J5");
    EXPECT_EQ(rewritten("impact-microactuator", "{J1 J8}^10, J1, J8"), "(J1 J8)^11");
    EXPECT_EQ(rewritten("impact-oscillator", "impact^3"), "impact^3");
    EXPECT_EQ(rewritten("electromagnetic-testbed", "phase0"), "phase0");
    // Names that are derived have hyphens and colons.
    EXPECT_EQ(rewritten("dry-friction-oscillator", "mass-backward:stops, mass-forward:stops"),
              "mass-backward:stops mass-forward:stops");
    EXPECT_EQ(rewritten("impact-oscillator-two-stops", "(free:right free:left)^2"), "(free:right free:left)^2");
}

TEST(Signature, HomoclinicOrbitsEndAtTheirSaddle) {
    EXPECT_EQ(rewritten("impact-oscillator", "impact^2 saddle"), "impact^2 free:saddle");
    EXPECT_EQ(rewritten("impact-oscillator", "~ saddle"), "free:~ free:saddle");
    const Model model = load_model("impact-oscillator");
    const Signature signature = parse_signature(model, "impact saddle");
    EXPECT_TRUE(is_homoclinic(signature));
    EXPECT_FALSE(is_homoclinic(parse_signature(model, "impact")));
    const auto message = [&](const char* text) { return testing::message_of([&] { parse_signature(model, text); }); };
    EXPECT_NE(message("saddle impact").find("write 'saddle' once, at the end"), std::string::npos)
        << message("saddle impact");
    EXPECT_NE(testing::message_of([&] {
                  validate_signature(model, {signature[1], signature[0]});
              }).find("let that be its last segment"),
              std::string::npos);
}

TEST(Signature, ModesFollowFromTheGraph) {
    const Model model = load_model("impact-microactuator");
    const Signature signature = parse_signature(model, "J1 J8");
    EXPECT_EQ(model.modes[signature[0].mode].name, "stick");
    EXPECT_EQ(model.modes[signature[1].mode].name, "slip_plus");
}

std::string message(const char* text) {
    const Model model = load_model("impact-microactuator");
    return testing::message_of([&] { parse_signature(model, text, {"study.toml", 3, 10}); });
}

TEST(Signature, MistakesAreReportedWithTheirPlace) {
    EXPECT_NE(message("J1 J99").find("study.toml:3:13: in the signature 'J1 J99': the model has no transition"),
              std::string::npos)
        << message("J1 J99");
    EXPECT_NE(message("J5 J1 J9").find("'J9' leads to mode 'slip_plus', and 'J5', the first segment, is in 'stick'"),
              std::string::npos)
        << message("J5 J1 J9");
    EXPECT_NE(message("J8 J6").find("'J6' cannot follow 'J8'"), std::string::npos) << message("J8 J6");
    EXPECT_NE(message("{J1").find("not closed"), std::string::npos);
    EXPECT_NE(message("J1)").find("closes nothing"), std::string::npos);
    EXPECT_NE(message("J1^0").find("repetitions"), std::string::npos);
    EXPECT_NE(message("J1^x").find("repetitions"), std::string::npos);
    EXPECT_NE(message("J1^99999 J8^99999").find("too many"), std::string::npos);
    EXPECT_NE(message("").find("empty"), std::string::npos);
    EXPECT_NE(message("J1;J8").find("does not belong"), std::string::npos);
    EXPECT_NE(message("J1 \u00e9").find("'\u00e9' does not belong"), std::string::npos) << message("J1 \u00e9");
}

const std::string corner = R"toml(
parameters = { g = 9.81, mu = 0.2 }
states = { x = 1, y = 0.5, u = -2, v = 0 }
modes.free.rates = { x = "u", y = "v", u = 0, v = "-g" }
contacts.velocities = ["u", "v"]
contacts.mass = [1, 1]
contacts.floor = { gap = "y", restitution = 0.6, friction = "mu", slip = "u" }
contacts.wall = { gap = "x", restitution = 0.8 }
)toml";

const std::string smooth_corner = R"toml(
states = { x = 1, y = 0.5, u = -2, v = 0 }
modes.free.rates = { x = "u", y = "v", u = 0, v = -1 }
contacts.velocities = ["u", "v"]
contacts.mass = [1, 1]
contacts.floor = { gap = "y", restitution = 0.6 }
contacts.wall = { gap = "x", restitution = 0.8 }
)toml";

const std::string rubbing = R"toml(
states = { x = 0, v = 0, s = { initial = 0, period = 4 } }
modes.free = { watch = ["front"], rates = { x = "v", v = "2*cos(pi*s/2) - x - ground", s = 1 } }
friction.ground = { velocity = "v", normal = 1, coefficient = 0.5, static = 0.7 }
events.front = "0.8 - x"
jumps.impact.v = "-v"
transitions = [{ mode = "free", event = "front", label = "hit-front", jump = "impact", next = "free" }]
)toml";

const std::string relay = R"toml(
states = { x = 1, v = 1 }
modes.pull.rates = { x = "v", v = "1" }
modes.push.rates = { x = "v", v = "-1" }
events.line = "v + x/2"
slides.along-line = { surface = "line", between = ["pull", "push"] }
initial.mode = "push"
)toml";

/// Returns the shortest signature that begins with a transition; empty if no motion comes back to its mode.
Signature cycle_with(const Model& model, std::size_t first) {
    std::vector<Signature> ways{{{model.transitions[first].mode, SegmentEnd::event, first}}};
    std::vector<bool> seen(model.transitions.size(), false);
    for (std::size_t k = 0; k < ways.size(); ++k) {
        const Transition& last = model.transitions[ways[k].back().index];
        if (can_lead_to(last, model.transitions[first].mode))
            return ways[k];
        for (std::size_t t = 0; t < model.transitions.size(); ++t)
            if (!seen[t] && can_lead_to(last, model.transitions[t].mode)) {
                seen[t] = true;
                ways.push_back(ways[k]);
                ways.back().push_back({model.transitions[t].mode, SegmentEnd::event, t});
            }
    }
    return {};
}

/// Declarations of contacts, frictions and slides make labels such as `free-stick:forward`.
TEST(Signature, LabelsOfDerivedTransitionsCanBeWritten) {
    for (const std::string& text : {corner, smooth_corner, rubbing, relay}) {
        const Model model = parse_model(text, "m.toml");
        std::size_t cycles = 0, with_hyphen = 0;
        for (std::size_t t = 0; t < model.transitions.size(); ++t) {
            const std::string& label = model.transitions[t].label;
            const std::string told = testing::message_of([&] { parse_signature(model, label); });
            EXPECT_EQ(told.find("does not belong"), std::string::npos) << told;
            EXPECT_EQ(told.find("has no transition"), std::string::npos) << told;
            const Signature cycle = cycle_with(model, t);
            if (cycle.empty())
                continue;
            ++cycles;
            with_hyphen += label.find('-') != std::string::npos ? 1 : 0;
            EXPECT_EQ(parse_signature(model, to_string(model, cycle)), cycle) << to_string(model, cycle);
            std::string in_modes; // as a table of an orbit names the ends of its segments
            for (const Segment& segment : cycle)
                in_modes += model.modes[segment.mode].name + ":" + end_name(model, segment) + " ";
            EXPECT_EQ(parse_signature(model, in_modes), cycle) << in_modes;
        }
        EXPECT_GT(cycles, 1U) << text;
        EXPECT_GT(with_hyphen, 0U) << text;
    }
}

/// The event of contacts that close at once is that of one of them. Their transitions come first.
TEST(Signature, ALabelComesBeforeAnEventOfTheSameName) {
    const Model model = parse_model(smooth_corner, "m.toml");
    for (const char* label : {"free:floor", "free:wall", "free:floor-wall:floor-wall", "free:floor-wall:none"})
        EXPECT_EQ(end_name(model, parse_signature(model, label)[0]), label);
    EXPECT_EQ(to_string(model, parse_signature(model, "free:floor*, free-floor:wall:wall^2, free-floor:floor-opens")),
              "free:floor* free-floor:wall:wall^2 free-floor:floor-opens");
}

} // namespace graze::signature_test
