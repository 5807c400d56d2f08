// The page of a design: its panels and their contents.

#include "graze/picture/design_page.hpp"

#include "graze/model/catalogue.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::testing::design_page_test {

struct PageOfASwitch : public ::testing::Test {
    PageOfASwitch() {
        design.name = "switch";
        design.model = load_model("mems-switch");
        design.control = "V";
        design.control_parameter = design.model.independent_parameter("V");
        for (const char* name : {"delta", "zeta"}) {
            DesignDimension& one = design.dimensions.emplace_back();
            one.name = name;
            one.parameter = design.model.independent_parameter(name);
            one.least = 0.5;
            one.greatest = 1;
        }
        design.adjustable = 0;
        SpecialPoint point;
        point.type = PointType::grazing;
        point.solution.orbit.parameters = design.model.parameter_values();
        trip.emplace(TripPoint{System(design.model), point, design.control_parameter, "approach", "GR1", {}, 1});
        report.value = 0.2;
        report.found.outcome = GrazingOutcome::lost;
        const auto mapped = [](double x, double y, GrazingOutcome outcome) {
            return MappedValue{x, y, true, x + y, true, outcome, {}};
        };
        report.curves.push_back({0,
                                 {mapped(0.5, 0, GrazingOutcome::lost), mapped(0.75, 0, GrazingOutcome::persists),
                                  mapped(1, 0, GrazingOutcome::persists)}});
        DimensionPlane& plane = report.planes.emplace_back();
        plane.up = 1;
        for (const double y : {0.5, 1.0})
            for (const double x : {0.5, 1.0})
                plane.points.push_back(mapped(x, y, GrazingOutcome::lost));
    }
    Design design;
    std::optional<TripPoint> trip;
    DesignReport report;
};

TEST_F(PageOfASwitch, CurvesHaveALineForEachClass) {
    const Figure page = design_page(design, *trip, report);
    ASSERT_EQ(page.panels.size(), 2U); // no times, tuning or devices
    const FigurePanel& curve = page.panels[0];
    ASSERT_EQ(curve.series.size(), 3U); // two classes and the device
    EXPECT_EQ(curve.series[0].title, "trips");
    EXPECT_EQ(curve.series[1].title, "persists");
    // The first line extends to the first point of the second.
    EXPECT_TRUE(std::isfinite(curve.series[0].points[1].y));
    EXPECT_FALSE(std::isfinite(curve.series[0].points[2].y));
    EXPECT_FALSE(std::isfinite(curve.series[1].points[0].y));
}

TEST_F(PageOfASwitch, EachCurveHasAPanel) {
    EXPECT_EQ(design_page(design, *trip, report).columns, 2U);
    const DimensionCurve curve = report.curves.front();
    const std::size_t many = 9;
    report.curves.assign(many, curve);
    const Figure page = design_page(design, *trip, report);
    ASSERT_EQ(page.panels.size(), many + 1); // and a plane
    EXPECT_EQ(page.columns, 3U);
}

TEST_F(PageOfASwitch, PlanesHaveColouredCellsAndContours) {
    const Figure page = design_page(design, *trip, report);
    const FigurePanel& plane = page.panels[1];
    ASSERT_FALSE(plane.series.empty());
    EXPECT_EQ(plane.series.front().style, FigureSeries::Style::cells);
    EXPECT_EQ(plane.series.front().cells.size(), 4U);
    EXPECT_FALSE(plane.labels.empty());
    const FigureLabel& label = plane.labels.front();
    EXPECT_NEAR(label.at.x + label.at.y, std::stod(label.text), 1e-12); // the values are bilinear
}

TEST_F(PageOfASwitch, TitleHasTripValueAndClass) {
    report.reset.value = 0.1;
    EXPECT_EQ(design_page(design, *trip, report).title, "switch: trips at V = 0.2, back at 0.1");
}

} // namespace graze::testing::design_page_test
