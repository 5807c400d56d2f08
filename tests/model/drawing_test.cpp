#include "graze/model/drawing.hpp"

#include "base/message_of.hpp"
#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/check.hpp"
#include "graze/model/microbeam.hpp"
#include "graze/model/model_file.hpp"
#include "graze/model/named_value.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace graze::drawing_test {

using testing::message_of;

const char* const equations = R"toml(name = "mass"
[parameters]
stop = 1
width = { value = "stop/2", text = "of the mass" }
[states]
x = 0
v = 1
[definitions]
face = "x + width/2"
[modes.free]
rates = { x = "v", v = "-x" }
[modes.held]
rates = { x = 0, v = 0 }
[events]
reached = "stop - face"
[[transitions]]
mode = "free"
event = "reached"
next = "held"
[initial]
mode = "free"
)toml";

/// Has every kind of shape; its tenth line is the first of the drawing.
const char* const every_kind = R"toml([drawing]
text = "a mass in front of a stop"
x = ["-2*stop", "stop + width"]
y = [-1, 1.5]
[[drawing.shapes]]
kind = "wall"
from = ["stop", -0.5]
to = ["stop", 0.5]
[[drawing.shapes]]
kind = "box"
at = ["x", 0]
size = ["width", 0.25]
colour = "blue"
modes = ["free"]
[[drawing.shapes]]
kind = "circle"
at = [ "face" , "0" ]
radius = "width/10"
modes = ["free", "held"]
[[drawing.shapes]]
kind = "path"
points = [[0, 0], [1, "v"], ["2", "1 + 1"]]
colour = "red"
[[drawing.shapes]]
kind = "text"
at = [0, 1]
text = "<b>stop</b>"
[[drawing.shapes]]
kind = "spring"
from = [-2, 0]
to = ["x - width/2", 0]
[[drawing.shapes]]
kind = "line"
from = [0, 0]
to = [1, 0]
[[drawing.shapes]]
kind = "arrow"
from = ["x", 0]
to = ["x + v", 0]
)toml";

Model drawn(const std::string& drawing) {
    return parse_model(equations + drawing, "mass.toml");
}

/// The message for a drawing with one shape, or with these limits.
std::string refused_shape(const std::string& shape) {
    return message_of([&] { drawn("[drawing]\nx = [0, 1]\ny = [0, 1]\nshapes = [\n{ " + shape + " }\n]\n"); });
}
std::string refused_limits(const std::string& x) {
    return message_of([&] {
        drawn("[drawing]\nx = " + x + "\ny = [0, 1]\nshapes = [{ kind = \"circle\", at = [0, 0], radius = 1 }]\n");
    });
}

TEST(Drawing, EveryKindOfShapeIsRead) {
    const Model model = drawn(every_kind);
    ASSERT_TRUE(model.drawing);
    const ModelDrawing& drawing = *model.drawing;
    EXPECT_EQ(drawing.text, "a mass in front of a stop");
    ASSERT_EQ(drawing.shapes.size(), 8U);
    const DrawnShape &wall = drawing.shapes[0], &box = drawing.shapes[1], &circle = drawing.shapes[2],
                     &path = drawing.shapes[3], &text = drawing.shapes[4];
    EXPECT_EQ(wall.kind, ShapeKind::wall);
    ASSERT_EQ(wall.points.size(), 2U);
    EXPECT_EQ(wall.points[1].x, "stop");
    EXPECT_EQ(wall.points[1].y, "0.5");
    EXPECT_EQ(wall.colour, ShapeColour::black);
    EXPECT_TRUE(wall.modes.empty());
    EXPECT_EQ(box.size.x, "width");
    EXPECT_EQ(box.size.y, "0.25");
    EXPECT_EQ(box.colour, ShapeColour::blue);
    EXPECT_EQ(box.modes, std::vector<std::size_t>{0});
    EXPECT_EQ(circle.radius, "width/10");
    EXPECT_EQ(circle.modes, (std::vector<std::size_t>{0, 1}));
    ASSERT_EQ(path.points.size(), 3U);
    EXPECT_EQ(path.points[2].y, "2");
    EXPECT_EQ(text.text, "<b>stop</b>");
}

TEST(Drawing, LimitsFollowTheParameters) {
    Model model = drawn(every_kind);
    EXPECT_EQ(scene_limits(model).value().x, (std::array<double, 2>{-2, 1.5}));
    model.set_parameter("stop", 2);
    EXPECT_EQ(scene_limits(model).value().x, (std::array<double, 2>{-4, 3}));
    EXPECT_EQ(scene_limits(model).value().y, (std::array<double, 2>{-1, 1.5}));
    EXPECT_FALSE(scene_limits(parse_model(equations, "mass.toml")));
    // Nothing fails because of a drawing where a parameter takes an unusual value.
    const auto warned = [](const Model& of) {
        const std::vector<std::string> all = model_warnings(of);
        return std::ranges::any_of(all, [](const std::string& one) { return one.starts_with("at these parameters"); });
    };
    EXPECT_FALSE(warned(model));
    model.set_parameter("stop", -2);
    EXPECT_FALSE(scene_limits(model));
    EXPECT_TRUE(warned(parse_model(write_model(model), "again.toml")));
}

TEST(Drawing, IsWrittenWithTheModel) {
    const Model model = drawn(every_kind);
    const std::string written = write_model(model);
    EXPECT_NE(written.find("{ kind = \"box\", at = [\"x\", 0], size = [\"width\", 0.25], colour = \"blue\", modes = "
                           "[\"free\"] }"),
              std::string::npos)
        << written;
    EXPECT_EQ(write_model(parse_model(written, "again.toml")), written);
}

TEST(Drawing, EquationsAreTheSameWithoutIt) {
    const Model bare = parse_model(equations, "mass.toml"), model = drawn(every_kind);
    EXPECT_EQ(write_equations(model), write_model(bare));
    EXPECT_EQ(write_equations(bare), write_model(bare));
    // Not a node of the graph is added, on which the order of operations could depend.
    EXPECT_EQ(model.graph->size(), bare.graph->size());
}

TEST(Drawing, WhatItUsesIsUsed) {
    const std::string mark = "[definitions]\n";
    std::string text = equations + std::string(every_kind);
    text.insert(text.find(mark) + mark.size(), "only_drawn = \"x + 1\"\n");
    const auto warned = [&] {
        const std::vector<std::string> all = model_warnings(parse_model(text, "mass.toml"));
        return std::ranges::find(all, "nothing uses the definition 'only_drawn'") != all.end();
    };
    EXPECT_TRUE(warned());
    text.replace(text.find("\"face\" ,"), 8, "\"only_drawn\" ,");
    EXPECT_FALSE(warned());
}

TEST(Drawing, AMistakeInAnExpressionHasItsPlace) {
    const std::string message = refused_shape("kind = \"circle\", at = [\"x + y\", 0], radius = 1");
    EXPECT_EQ(message.substr(0, 33), "mass.toml:26:31: unknown name 'y'") << message;
    EXPECT_NE(refused_shape("kind = \"circle\", at = [\"x +\", 0], radius = 1").find("mass.toml:26:29"),
              std::string::npos);
    EXPECT_NE(refused_shape("kind = \"circle\", at = [0, 0], radius = inf").find("radius is inf; give a finite number"),
              std::string::npos);
    EXPECT_NE(refused_shape("kind = \"circle\", at = [0, 0], radius = \"abs(x)\"").find("'abs' is not analytic"),
              std::string::npos);
    EXPECT_NE(refused_shape("kind = \"circle\", at = [0, 0], radius = true").find("must be a number or an expression"),
              std::string::npos);
}

TEST(Drawing, AShapeHasTheKeysOfItsKind) {
    EXPECT_NE(refused_shape("at = [0, 0]").find("drawing.shapes.1 has no kind"), std::string::npos);
    EXPECT_NE(refused_shape("kind = \"ball\"").find("choose from line, arrow, spring, wall, path, box, circle, text"),
              std::string::npos);
    EXPECT_NE(refused_shape("kind = \"circle\", at = [0, 0]").find("is a circle without 'radius'; add radius = 0.1"),
              std::string::npos);
    EXPECT_NE(refused_shape("kind = \"line\", from = [0, 0], to = [1, 1], radius = 1").find("a line has no 'radius'"),
              std::string::npos);
    EXPECT_NE(refused_shape("kind = \"circle\", at = [0, 0], radius = 1, color = \"red\"").find("mean 'colour'?"),
              std::string::npos);
    EXPECT_NE(refused_shape("kind = \"circle\", at = [0, 0], radius = 1, colour = \"pink\"").find("choose from black"),
              std::string::npos);
    EXPECT_NE(refused_shape("kind = \"circle\", at = 0, radius = 1").find("must be a list of two coordinates"),
              std::string::npos);
    EXPECT_NE(refused_shape("kind = \"box\", at = [0, 0], size = [1, 2, 3]").find("a list of width and height"),
              std::string::npos);
    EXPECT_NE(refused_shape("kind = \"circle\", at = [0, 0], radius = 1, modes = [\"fre\"]").find("mean 'free'?"),
              std::string::npos);
    EXPECT_NE(refused_shape("kind = \"path\", points = [[0, 0]]").find("is a path of 1 points"), std::string::npos);
    EXPECT_NE(refused_shape("kind = \"text\", at = [0, 0], text = \"\"").find("is empty"), std::string::npos);
    EXPECT_NE(refused_shape("kind = \"text\", at = [0, 0], text = \"\\u001b[2J\"").find("control a terminal"),
              std::string::npos);
}

TEST(Drawing, LimitsAreFiniteAndInOrder) {
    EXPECT_NE(refused_limits("[0, inf]").find("mass.toml:23:9: drawing.x.2 is inf; give a finite number"),
              std::string::npos);
    EXPECT_NE(refused_limits("[0, \"1/0\"]").find("give a finite number"), std::string::npos);
    EXPECT_NE(refused_limits("[1, 1]").find("goes from 1 to 1; give the lower limit first"), std::string::npos);
    EXPECT_NE(refused_limits("[-1e308, 1e308]").find("give the lower limit first"), std::string::npos);
    EXPECT_NE(refused_limits("[0, \"x\"]").find("mass.toml:23:10: drawing.x uses 'x', which is no parameter"),
              std::string::npos);
    EXPECT_NE(refused_limits("[0]").find("a list of two limits of the scene"), std::string::npos);
    EXPECT_NE(message_of([] { drawn("[drawing]\nx = [0, 1]\n"); }).find("no limits in y; add y = [-1, 1]"),
              std::string::npos);
    EXPECT_NE(message_of([] { drawn("[drawing]\nx = [0, 1]\ny = [0, 1]\n"); }).find("the drawing has no shapes"),
              std::string::npos);
    EXPECT_NE(message_of([] { drawn("drawing = 3\n"); }).size(), 0U);
}

TEST(Drawing, HugeDrawingsAreRefused) {
    std::string shapes = "[drawing]\nx = [0, 1]\ny = [0, 1]\nshapes = [\n";
    for (int i = 0; i < 100'000; ++i)
        shapes += "{ kind = \"line\", from = [0, 0], to = [1, 1] },\n";
    EXPECT_EQ(
        message_of([&] { drawn(shapes + "]\n"); }),
        "mass.toml:126:1: the drawing has more than 100 shapes; draw the mechanics only, or join lines to a path");
    std::string points = "kind = \"path\", points = [";
    for (int i = 0; i < 100'000; ++i)
        points += "[0, 0], ";
    EXPECT_NE(refused_shape(points + "]").find("has more than 200 points"), std::string::npos);
}

TEST(Drawing, AModelBuiltFromCppIsChecked) {
    const auto refused = [](const auto& change) {
        Model model = drawn(every_kind);
        change(*model.drawing);
        return message_of([&] { model.validate(); });
    };
    EXPECT_EQ(refused([](ModelDrawing&) {}), "");
    EXPECT_NE(
        refused([](ModelDrawing& one) { one.shapes[0].points.pop_back(); }).find("is a wall with 1 points; give 2"),
        std::string::npos);
    EXPECT_NE(refused([](ModelDrawing& one) { one.shapes[1].modes = {7}; }).find("refers to mode 7, but there are 2"),
              std::string::npos);
    EXPECT_NE(refused([](ModelDrawing& one) { one.shapes[2].radius = "y"; }).find("shapes.3.radius: unknown name 'y'"),
              std::string::npos);
    EXPECT_NE(refused([](ModelDrawing& one) { one.shapes[1].size = {}; }).find("shapes.2.size"), std::string::npos);
    EXPECT_NE(refused([](ModelDrawing& one) { one.x[0] = "inf"; }).find("drawing.x.1"), std::string::npos);
    EXPECT_NE(refused([](ModelDrawing& one) { one.shapes.resize(101, one.shapes[0]); }).find("101 shapes"),
              std::string::npos);
}

/// A drawing shows something of the model: it has finite numbers at the beginning, and parts that move.
void expect_shows(const Model& model) {
    ASSERT_TRUE(model.drawing) << model.name;
    EXPECT_FALSE(model.drawing->text.empty()) << model.name;
    const SceneLimits limits = scene_limits(model).value();
    std::vector<double> inputs = model.initial_state();
    for (const double value : model.parameter_values())
        inputs.push_back(value);
    bool moves = false;
    for (const DrawnShape& shape : model.drawing->shapes)
        for (const DrawnPair& point : shape.points) {
            const Expression x = named_value(model, point.x, {}).value, y = named_value(model, point.y, {}).value;
            const std::vector<double> at = model.function_of({{x, y}})(inputs);
            EXPECT_GE(at[0], limits.x[0]) << model.name << " " << point.x;
            EXPECT_LE(at[0], limits.x[1]) << model.name << " " << point.x;
            EXPECT_GE(at[1], limits.y[0]) << model.name << " " << point.y;
            EXPECT_LE(at[1], limits.y[1]) << model.name << " " << point.y;
            std::vector<double> moved = inputs;
            for (std::size_t i = 0; i < model.states.size(); ++i)
                moved[i] += 0.001;
            moves = moves || model.function_of({{x, y}})(moved) != at;
        }
    EXPECT_TRUE(moves) << model.name;
}

TEST(Drawing, EveryShippedModelHasOne) {
    for (const CatalogueEntry& entry : catalogue())
        expect_shows(load_model(entry.name));
}

TEST(Drawing, EveryMicrobeamHasOne) {
    expect_shows(microbeam({.modes = 3}));
    expect_shows(microbeam({.trial = TrialFunctions::polynomial}));
    expect_shows(microbeam({.steady = true}));
    expect_shows(microbeam({.stop_distance = 0.02}));
    // The deflected shape is that of the definitions, enlarged: at x = 0.25 and at mid-span.
    Model model = microbeam();
    model.set_initial("q1", 0.01);
    std::vector<double> inputs = model.initial_state();
    for (const double value : model.parameter_values())
        inputs.push_back(value);
    const std::vector<DrawnPair>& beam = model.drawing->shapes.back().points;
    const auto value = [&](const std::string& text) {
        return model.function_of({{named_value(model, text, {}).value}})(inputs)[0];
    };
    EXPECT_EQ(value(beam[5].x), 0.25);
    EXPECT_NEAR(value(beam[5].y), 5 * value("deflection_5"), 1e-14);
    EXPECT_NEAR(value(beam[10].y), 5 * value("deflection_10"), 1e-14);
    EXPECT_EQ(value(beam[20].y), 0);
}

} // namespace graze::drawing_test
