#include "graze/picture/trajectory_figure.hpp"

#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "picture/figure_layout.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace graze::testing::trajectory_figure_test {

/// @param columns names of values; @param histories the number of columns, from the first, that are drawn over time
Figure drawn(const Model& model, double time, const std::vector<std::string>& columns, std::size_t histories,
             const std::vector<std::pair<std::size_t, std::size_t>>& portraits) {
    MotionPanelChoice choice;
    for (const std::string& name : columns)
        choice.columns.push_back(named_value(model, name, {}));
    for (std::size_t i = 0; i < histories; ++i)
        choice.histories.push_back(i);
    choice.portraits = portraits;
    choice.marked.assign(model.events.size(), true);
    const Simulation simulation{System(model)};
    MotionRecorder recorder(simulation, choice);
    Trajectory trajectory(simulation, model.parameter_values(), borrowed(recorder));
    trajectory.start(model.initial_state(), model.initial_mode, 0, time);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    recorder.finish(trajectory);
    return trajectory_figure(recorder);
}

const FigureSeries* series(const FigurePanel& panel, const std::string& title) {
    for (const FigureSeries& one : panel.series)
        if (one.title == title)
            return &one;
    return nullptr;
}

// The velocity of a ball falls along each arc and rises only at contacts.
TEST(TrajectoryFigure, CurvesAreInterruptedAtJumps) {
    const Figure figure = drawn(load_model("bouncing-ball"), 0.25, {"v"}, 1, {});
    ASSERT_EQ(figure.panels.size(), 1U);
    int arcs = 0;
    bool fresh = true;
    double last = 0;
    for (const PlanePoint& point : figure.panels[0].series[0].points) {
        if (!std::isfinite(point.y)) {
            fresh = true;
            continue;
        }
        EXPECT_TRUE(fresh || point.y <= last);
        arcs += fresh ? 1 : 0;
        fresh = false;
        last = point.y;
    }
    EXPECT_EQ(arcs, 2);
    const FigureSeries* contacts = series(figure.panels[0], "contact");
    ASSERT_NE(contacts, nullptr);
    EXPECT_EQ(contacts->points.size(), 2U) << "before and after the only one";
}

TEST(TrajectoryFigure, APortraitSpansAllHistories) {
    const Figure figure = drawn(load_model("electromagnetic-testbed"), 1, {"q", "v", "I"}, 3, {{0, 1}});
    ASSERT_EQ(figure.panels.size(), 4U);
    EXPECT_EQ(figure.columns, 2U);
    const FigureLayout page = layout_of(figure);
    const Box& portrait = page.panels[1].frame;
    EXPECT_DOUBLE_EQ(portrait.high, page.panels[0].frame.high);
    EXPECT_NEAR(portrait.low, page.panels[3].frame.low, 1e-9);
    EXPECT_GT(portrait.left, page.panels[0].frame.right);
    for (const std::size_t history : {2U, 3U})
        EXPECT_DOUBLE_EQ(page.panels[history].frame.left, page.panels[0].frame.left);
    EXPECT_EQ(figure.panels[0].x_range->second, 1);
}

// x' = x^2 from x(0) = 1 is singular at t = 1: the axis of x must not be that of its last moments.
TEST(TrajectoryFigure, UnboundedValuesLeaveTheFrame) {
    const Model model = parse_model(R"(name = "blows"
[states]
x = 1
[modes.only]
rates = { x = "x^2" }
)",
                                    "blows.toml");
    const Figure figure = drawn(model, 2, {"x"}, 1, {});
    ASSERT_EQ(figure.panels[0].marks.size(), 1U);
    EXPECT_NEAR(figure.panels[0].marks[0], 1, 1e-9);
    EXPECT_LT(figure.panels[0].y_range->second, 1e3);
    EXPECT_GT(figure.panels[0].x_range->second, 1);
}

} // namespace graze::testing::trajectory_figure_test
