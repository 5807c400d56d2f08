// Reports of the MEMS switch and of an oscillator, against published values and closed forms.

#include "graze/design/design_report.hpp"

#include "graze/model/model_file.hpp"
#include "switches.hpp"

#include <algorithm>

namespace graze::testing::design_report_test {

const Sensitivity& of(const DesignReport& report, const std::string& name) {
    return *std::find_if(report.sensitivities.begin(), report.sensitivities.end(),
                         [&](const Sensitivity& one) { return one.name == name; });
}

TEST(DesignReport, OfTheMemsSwitchHasThePublishedValues) {
    Design design = load_design("mems-switch");
    design.curve_points = design.plane_points = 3;
    design.yield.devices = 50;
    const TripPoint trip = trip_of(design);
    const DesignReport report = report_of(design, trip);
    EXPECT_NEAR(report.value, 0.2013662121541341, 1e-12);
    EXPECT_EQ(report.found.outcome, GrazingOutcome::lost);
    const auto row = std::find_if(report.times.rows.begin(), report.times.rows.end(),
                                  [](const OvershootTrip& one) { return one.overshoot == 1e-4; });
    ASSERT_NE(row, report.times.rows.end());
    ASSERT_TRUE(row->best());
    EXPECT_NEAR(row->best()->time, 27.31773570163, 1e-8 * 27);
    EXPECT_FALSE(report.reset.value); // the gap stays closed
    EXPECT_EQ(report.trial.outcome, TrialOutcome::agreed);
    EXPECT_TRUE(report.trial.rests_below && report.trial.trips_above);
    EXPECT_EQ(of(report, "e").derivative, 0); // there is no impact before the touch
    EXPECT_EQ(report.curves.size(), 3U);
    EXPECT_EQ(report.planes.size(), 1U);
    ASSERT_TRUE(report.tuning && report.yield);
    EXPECT_EQ(report.yield->made, 50U);
    // The device's model as written for other commands; its value was solved for again, to round-off.
    const Model device = parse_model(write_model(model_of_device(trip)), "device.toml");
    EXPECT_NEAR(device.parameter_values()[device.independent_parameter("V").place()], report.value, 1e-13);
}

TEST(DesignReport, OfAnOscillatorHasExactDerivatives) {
    const Design design = oscillator_design();
    const DesignReport report = report_of(design, trip_of(design));
    const double omega = 0.5, zeta = 0.1, sigma = 0.2, root = oscillator_value(1, zeta);
    EXPECT_NEAR(of(report, "sigma").derivative, root, 1e-10);
    EXPECT_NEAR(of(report, "zeta").derivative, sigma * 4 * zeta * omega * omega / root, 1e-10);
    EXPECT_NEAR(of(report, "omega").derivative,
                sigma * (-2 * omega * (1 - omega * omega) + 4 * zeta * zeta * omega) / root, 1e-10);
    EXPECT_NEAR(*of(report, "sigma").relative, 1, 1e-10);
    // The value is linear in the stop's position, which has one percent: so have the devices.
    ASSERT_TRUE(report.yield);
    EXPECT_NEAR(report.yield->linear_deviation, 0.01 * report.value, 1e-12);
    EXPECT_LT(report.yield->largest_departure, 1e-10);
}

TEST(DesignReport, IsInterruptedBetweenItsParts) {
    const Design design = oscillator_design();
    DesignReportOptions options;
    options.interrupted = [] { return true; };
    EXPECT_TRUE(report_of(design, trip_of(design), options).interrupted);
}

TEST(DesignReport, EachTableHasAFile) {
    const auto [design, trip] = with_trip(oscillator_design());
    std::vector<std::string> names;
    for (const NamedTable& table : tables_of(design, trip, report_of(design, trip))) {
        names.push_back(table.name);
        EXPECT_GT(table.table.columns().size(), 0U);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"facts", "sensitivities", "earlier", "trip-times", "curve-sigma",
                                               "curve-zeta", "plane-sigma-zeta", "tuning", "devices"}));
}

} // namespace graze::testing::design_report_test
