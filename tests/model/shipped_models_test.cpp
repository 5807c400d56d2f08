#include "graze/model/check.hpp"
#include "model/shipped_model.hpp"
#include "places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace graze::shipped_models_test {

using testing::evaluate;
using testing::expressions_of;
using testing::jumped;
using testing::ModelFunction;
using testing::models_folder;
using testing::random_state;
using testing::rate_of;
using testing::shipped;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

std::vector<std::string> shipped_names() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(models_folder()))
        if (entry.path().extension() == ".toml")
            names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

class ShippedModel : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedModel, IsValidAndGivesNoWarnings) {
    const Model model = shipped(GetParam());
    EXPECT_NO_THROW(model.validate());
    EXPECT_EQ(model.name, GetParam());
    EXPECT_EQ(model_warnings(model), std::vector<std::string>{});
    EXPECT_NE(connectivity_graph(model).find("digraph"), std::string::npos);
}

TEST_P(ShippedModel, IsDocumented) {
    const Model model = shipped(GetParam());
    EXPECT_FALSE(model.text.empty());
    EXPECT_FALSE(model.source.empty());
    const auto expect_texts = [](const auto& items, const char* kind) {
        for (const auto& item : items)
            EXPECT_FALSE(item.text.empty()) << kind << ' ' << item.name;
    };
    expect_texts(model.parameters, "parameter");
    expect_texts(model.states, "state");
    expect_texts(model.definitions, "definition");
    expect_texts(model.modes, "mode");
    expect_texts(model.events, "event");
    expect_texts(model.jumps, "jump");
    expect_texts(model.sections, "section");
    expect_texts(model.symmetries, "symmetry");
    expect_texts(model.quantities, "quantity");
    EXPECT_FALSE(model.sections.empty());
    EXPECT_FALSE(model.quantities.empty());
    const std::string page = GetParam() + ".md";
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(testing::source_folder) / "docs" / "models" / page))
        << page;
}

TEST_P(ShippedModel, ReadsBackWhenWritten) {
    const Model model = shipped(GetParam());
    const Model read = parse_model(write_model(model), GetParam());
    EXPECT_EQ(read.text, model.text);
    EXPECT_EQ(read.parameter_values(), model.parameter_values());
    EXPECT_EQ(read.initial_state(), model.initial_state());
    EXPECT_EQ(read.initial_mode, model.initial_mode);
    std::mt19937_64 random(3);
    const std::vector<double> state = random_state(model, 0.01, random);
    EXPECT_EQ(evaluate(read, expressions_of(read), state), evaluate(model, expressions_of(model), state));
}

TEST_P(ShippedModel, InitialStateIsWithinTheBarriers) {
    const Model model = shipped(GetParam());
    const std::vector<double> state = model.initial_state();
    for (const std::size_t event : model.modes[model.initial_mode].watched)
        if (model.events[event].kind == EventKind::barrier) {
            EXPECT_GE(evaluate(model, model.events[event].function, state), 0) << model.events[event].name;
        }
    for (const double rate : evaluate(model, model.modes[model.initial_mode].rates, state))
        EXPECT_TRUE(std::isfinite(rate));
}

/// Chatter ends where the contact can persist: gap and contact speed are zero after the jump and stay zero in the
/// sticking mode, which ends exactly when the free motion would leave the surface.
TEST_P(ShippedModel, SticksAsLongAsTheFreeMotionWouldPressOnTheSurface) {
    const Model model = shipped(GetParam());
    std::mt19937_64 random(1);
    for (const Transition& transition : model.transitions) {
        if (!transition.chatter)
            continue;
        const std::size_t sticking = transition.chatter->mode;
        const Expression gap = model.events[transition.event].function;
        const Expression speed = rate_of(model, gap, transition.mode);
        const Expression acceleration = rate_of(model, speed, transition.mode);
        std::vector<Expression> expressions = {gap, speed, rate_of(model, gap, sticking),
                                               rate_of(model, speed, sticking), acceleration};
        const std::size_t first_event = expressions.size();
        for (const std::size_t event : model.modes[sticking].watched)
            expressions.push_back(model.events[event].function);
        const ModelFunction values(model, expressions);
        std::vector<int> agreements(model.modes[sticking].watched.size());
        int decided = 0;
        for (int trial = 0; trial < 100; ++trial) {
            const std::vector<double> before = random_state(model, 0.7, random);
            const std::vector<double> state = jumped(model, transition.chatter->jump, before);
            const std::vector<double> value = values(state);
            double size = 1;
            for (const double rate : evaluate(model, model.modes[transition.mode].rates, state))
                size = std::max(size, std::abs(rate));
            for (std::size_t i = 0; i + 1 < first_event; ++i)
                EXPECT_NEAR(value[i], 0, 8 * epsilon * size) << transition.label << ' ' << i;
            if (std::abs(value[first_event - 1]) < 1e-9 * size)
                continue;
            ++decided;
            for (std::size_t i = 0; i < agreements.size(); ++i)
                agreements[i] += (value[first_event + i] > 0) == (value[first_event - 1] < 0);
        }
        // One of the events that end sticking is the release.
        EXPECT_EQ(*std::max_element(agreements.begin(), agreements.end()), decided) << transition.label;
    }
}

/// Compares images under a symmetry, with phases modulo their periods.
void expect_same_states(const Model& model, std::span<const double> one, std::span<const double> other) {
    for (std::size_t i = 0; i < model.states.size(); ++i) {
        double difference = one[i] - other[i];
        if (model.states[i].period)
            difference = std::remainder(difference, evaluate(model, *model.states[i].period, one));
        EXPECT_NEAR(difference, 0, 16 * epsilon * (1 + std::abs(one[i]))) << model.states[i].name;
    }
}

TEST_P(ShippedModel, SymmetriesMapSolutionsToSolutions) {
    const Model model = shipped(GetParam());
    std::mt19937_64 random(2);
    for (const Symmetry& symmetry : model.symmetries)
        for (int trial = 0; trial < 50; ++trial) {
            const std::vector<double> state = random_state(model, 0.5, random);
            const std::vector<double> image = evaluate(model, symmetry.map, state);
            for (std::size_t mode = 0; mode < model.modes.size(); ++mode) {
                std::vector<Expression> moved;
                for (const Expression& coordinate : symmetry.map)
                    moved.push_back(rate_of(model, coordinate, mode));
                const std::vector<double> expected = evaluate(model, moved, state);
                const std::vector<double> actual = evaluate(model, model.modes[symmetry.modes[mode]].rates, image);
                // Adding half a period rounds the phase, and some rates are 1000 times as large.
                for (std::size_t i = 0; i < expected.size(); ++i)
                    EXPECT_NEAR(actual[i], expected[i], 1000 * epsilon * (1 + std::abs(expected[i]))) << i;
            }
            for (const Transition& transition : model.transitions) {
                const double value = evaluate(model, model.events[transition.event].function, state);
                const auto partner =
                    std::find_if(model.transitions.begin(), model.transitions.end(), [&](const Transition& other) {
                        const double other_value = evaluate(model, model.events[other.event].function, image);
                        return other.mode == symmetry.modes[transition.mode] &&
                               std::abs(other_value - value) < 16 * epsilon * (1 + std::abs(value));
                    });
                ASSERT_NE(partner, model.transitions.end()) << transition.label;
                const std::vector<double> after = jumped(model, transition.jump, state);
                expect_same_states(model, evaluate(model, symmetry.map, after), jumped(model, partner->jump, image));
            }
        }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedModel, ::testing::ValuesIn(shipped_names()), [](const auto& shipped_model) {
    std::string name = shipped_model.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

TEST(ShippedModels, AreComplete) {
    const std::vector<std::string> expected = {"ball-and-shaker",
                                               "belt-oscillator",
                                               "bouncing-ball",
                                               "cam-follower",
                                               "chua-circuit",
                                               "dry-friction-oscillator",
                                               "electromagnetic-testbed",
                                               "impact-microactuator",
                                               "impact-oscillator",
                                               "impact-oscillator-two-stops",
                                               "mems-switch",
                                               "mems-switch-device",
                                               "microbeam",
                                               "rocking-block",
                                               "spring-walker",
                                               "welander-convection"};
    EXPECT_EQ(shipped_names(), expected);
}

} // namespace graze::shipped_models_test
