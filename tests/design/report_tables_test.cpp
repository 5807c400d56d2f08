// Tables of reports, which other programs read.

#include "graze/design/design_report.hpp"

#include "switches.hpp"

#include <algorithm>

namespace graze::testing::report_tables_test {

std::optional<std::size_t> row_of(const Table& facts, const std::string& quantity) {
    for (std::size_t row = 0; row < facts.rows(); ++row)
        if (facts.text(row, 0) == quantity)
            return row;
    return std::nullopt;
}

TEST(ReportTables, FactsAreThoseOfTheReport) {
    const auto [design, trip] = with_trip(oscillator_design("[wanted]\nvalue = 0.2\n"));
    DesignReport report = report_of(design, trip);
    Table facts = facts_of(design, trip, report);
    ASSERT_TRUE(row_of(facts, "trip_value"));
    EXPECT_EQ(facts.number(*row_of(facts, "trip_value"), 1), report.value);
    EXPECT_EQ(facts.number(*row_of(facts, "sigma"), 1), 0.2);
    EXPECT_NEAR(facts.number(*row_of(facts, "sensitivity_sigma"), 1), 1, 1e-10); // the value is linear in it
    EXPECT_FALSE(row_of(facts, "wishes"));
    report.wishes = meet_wishes(design, trip);
    facts = facts_of(design, trip, report);
    EXPECT_EQ(facts.text(*row_of(facts, "wishes"), 1), "met");
    EXPECT_NEAR(facts.number(*row_of(facts, "want_value"), 1), 0.2, 1e-9);
}

TEST(ReportTables, CurvesAndPlanesHaveARowForEachDevice) {
    const auto [design, trip] = with_trip(oscillator_design());
    const DesignReport report = report_of(design, trip);
    for (const NamedTable& one : tables_of(design, trip, report)) {
        if (one.name == "curve-sigma") {
            EXPECT_EQ(one.table.rows(), design.curve_points);
            EXPECT_EQ(one.table.columns()[1].name, "amplitude");
        }
        if (one.name == "plane-sigma-zeta") {
            EXPECT_EQ(one.table.rows(), design.plane_points * design.plane_points);
        }
        if (one.name == "devices") {
            EXPECT_EQ(one.table.rows(), design.yield.devices);
        }
    }
}

} // namespace graze::testing::report_tables_test
