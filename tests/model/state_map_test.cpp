#include "graze/model/state_map.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/model.hpp"

#include <gtest/gtest.h>

namespace graze::state_map_test {

class StateMaps : public ::testing::Test {
protected:
    std::shared_ptr<Graph> graph = Graph::create();
    Expression x = graph->symbol("x"), v = graph->symbol("v"), s = graph->symbol("s");
    std::vector<Expression> states{x, v, s};
};

TEST_F(StateMaps, BehaveAsVectors) {
    StateMap map{x, -v};
    EXPECT_EQ(map.size(), 2u);
    map.push_back(s);
    EXPECT_EQ(map, (std::vector{x, -v, s}));
    map[0] = 2 * x;
    map.back() = v;
    EXPECT_EQ(std::vector<Expression>(map), (std::vector{2 * x, -v, v}));
    map.pop_back();
    EXPECT_EQ(map, (StateMap{2 * x, -v}));
    EXPECT_FALSE(map == (StateMap{2 * x, v}));
    map.clear();
    EXPECT_TRUE(map.empty());
    EXPECT_TRUE(StateMap().empty());
    EXPECT_EQ(std::vector<Expression>(StateMap()), std::vector<Expression>());
}

TEST_F(StateMaps, ShareTheirCommonPartWithCopies) {
    const StateMap stays(states);
    StateMap one = stays, other = stays;
    one[1] = -v;
    other[2] = x;
    other[0] = v;
    EXPECT_EQ(one.shared(), stays.shared());
    EXPECT_EQ(other.shared(), stays.shared());
    EXPECT_EQ(stays, states);
    ASSERT_EQ(other.changes().size(), 2u);
    EXPECT_EQ(other.changes()[0].state, 0u);
    EXPECT_EQ(other.changes()[1].image, x);
    const StateMap& read = one;
    EXPECT_EQ(read[1], -v);
    EXPECT_EQ(read[2], s);
    EXPECT_EQ(read.changes().size(), 1u);
}

TEST_F(StateMaps, RefuseIndicesOutOfRange) {
    StateMap map(states);
    const StateMap& read = map;
    EXPECT_THROW(map[3] = x, InputError);
    EXPECT_THROW(read[3], InputError);
    StateMap nothing;
    EXPECT_THROW(nothing.pop_back(), InputError);
    EXPECT_THROW(map.replace(nullptr, [](Expression&) {}), InputError);
}

/// A model of two states with two jumps that share all images that they do not change.
Model two_jumps() {
    Model model;
    model.states = {{.name = "x", .initial = model.number(1)}, {.name = "v", .initial = model.number(0)}};
    const Expression x = model.symbol("x"), v = model.symbol("v");
    StateMap stays(model.state_symbols());
    model.jumps.push_back({.name = "back", .map = stays});
    model.jumps.back().map[1] = -v;
    model.jumps.push_back({.name = "home", .map = stays});
    model.jumps.back().map[0] = model.number(0);
    model.modes.push_back({.name = "free", .rates = {v, -x}, .watched = {0, 1}});
    model.events = {{.name = "one", .function = x}, {.name = "other", .function = x + 2}};
    model.transitions = {{.label = "A", .event = 0, .jump = 1, .next = {{.mode = 0}}},
                         {.label = "B", .event = 1, .jump = 2, .next = {{.mode = 0}}}};
    return model;
}

TEST(StateMapsOfModels, AreCopiedIntoTheGraphOfTheCopyAndSharedThere) {
    const Model model = two_jumps();
    const Model copy = model;
    copy.validate();
    EXPECT_EQ(copy.jumps[1].map.shared(), copy.jumps[2].map.shared());
    EXPECT_NE(copy.jumps[1].map.shared(), model.jumps[1].map.shared());
    EXPECT_EQ(copy.jumps[1].map, (StateMap{copy.symbol("x"), -copy.symbol("v")}));
    EXPECT_EQ(copy.jumps[2].map, (StateMap{copy.number(0), copy.symbol("v")}));
}

TEST(StateMapsOfModels, AreValidatedWhetherSharedOrNot) {
    const auto problem = [](const Model& model) -> std::string {
        try {
            model.validate();
        } catch (const InputError& error) {
            return error.problem();
        }
        return "";
    };
    Model model = two_jumps();
    model.jumps[2].map[1] = {};
    EXPECT_EQ(problem(model), "jumps.home.v is missing");
    // An image that every jump overrides may be missing from the shared images.
    model = two_jumps();
    StateMap holes(std::vector<Expression>(2));
    model.jumps[1].map = model.jumps[2].map = holes;
    for (std::size_t j : {1, 2})
        for (std::size_t i : {0, 1})
            model.jumps[j].map[i] = model.symbol("x");
    EXPECT_EQ(problem(model), "");
    model.jumps[2].map = holes;
    model.jumps[2].map[1] = model.symbol("x");
    EXPECT_EQ(problem(model), "jumps.home.x is missing");
    model = two_jumps();
    model.jumps[1].map[0] = model.symbol("y");
    EXPECT_EQ(problem(model), "jumps.back.x uses the unknown name 'y'");
}

} // namespace graze::state_map_test
