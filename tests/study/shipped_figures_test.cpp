// What the shipped studies show of figures and tables of the dissertation, against values that were computed
// independently, and against what is printed.

#include "graze/grazing/verdict.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/study_catalogue.hpp"
#include "graze/study/study_table.hpp"

#include "study_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace graze::shipped_figures_test {

/// Some runs of a shipped study, done.
class ShippedResults : public testing::StudyResults {
public:
    using StudyResults::StudyResults;
    /// With the runs that they start from.
    void run(const std::vector<std::string>& names) {
        for (const RunReport& report : StudyResults::run(names))
            expect_end(report.name);
    }
    SpecialPoint point(const std::string& run, const std::string& label) const {
        for (const OrbitRecord& record : file().orbits(run, true))
            if (record.label == label)
                return record.point;
        throw std::out_of_range(run + ":" + label);
    }
    double parameter(const SpecialPoint& point, const char* name) const {
        return point.solution.orbit.parameters[study.runs.front().model.independent_parameter(name).place()];
    }
    double monitor(const std::string& run, const std::string& name) const {
        auto rows = StoredRun(file(), run, {}).rows({.quantities = {name}});
        return rows.next() ? rows.number(0) : throw std::out_of_range(run);
    }

private:
    /// A branch ends where something ends it, unless the study says after how many steps.
    void expect_end(const std::string& name) const {
        const auto run =
            std::find_if(study.runs.begin(), study.runs.end(), [&](const StudyRun& one) { return one.name == name; });
        if (run == study.runs.end() || !run->is_branch() || run->branch().settings.steps != BranchSettings().steps)
            return;
        for (const OrbitRecord& record : file().orbits(name, true))
            EXPECT_NE(record.point.detail, name_of(BranchOutcome::steps)) << name;
    }
};

/// @param voltage its column, with lambda next to it; @param computed voltages of all grazings @param printed those in
/// the text, with ratios of them
void expect_ladder(const ShippedResults& results, const std::string& name, const std::vector<double>& computed,
                   const std::vector<double>& printed, const std::vector<double>& ratios, std::size_t voltage) {
    const Table table = make_table(results.table(name), results.file());
    ASSERT_GE(table.rows(), computed.size());
    for (std::size_t i = 0; i < computed.size(); ++i) {
        EXPECT_NEAR(table.number(i, voltage), computed[i], 1e-12) << name << ' ' << i;
        EXPECT_NEAR(table.number(i, voltage), printed[i], 1e-4) << name << ' ' << i; // one is cut off, not rounded
    }
    for (std::size_t i = 0; i + 2 < computed.size(); ++i) {
        const double first = computed[i + 1] - computed[i], second = computed[i + 2] - computed[i + 1];
        EXPECT_NEAR(table.number(i, voltage + 1), second / first, 4e-12 / first) << name << ' ' << i;
    }
    for (std::size_t i = 0; i < ratios.size(); ++i) {
        // They were printed of voltages with more digits, or of those with four.
        const double first = computed[i + 1] - computed[i];
        EXPECT_NEAR(table.number(i, voltage + 1), ratios[i], 1e-4 * (1 + ratios[i]) / first) << name << ' ' << i;
    }
    for (std::size_t row = table.rows() - 2; row < table.rows(); ++row)
        EXPECT_TRUE(table.is_missing(row, voltage + 1));
}

TEST(ShippedFigures, LaddersOfGrazingsOfTheMicroactuatorAreThePublishedOnes) {
    ShippedResults results("microactuator");
    results.run({"five_impacts", "fast_ladder"});
    const std::vector<double> computed{0.5876212422746997, 0.7304755333366196, 0.8095127614194632, 0.8558788675649937,
                                       0.8819580628177297};
    expect_ladder(results, "grazings", computed, {.5876, .7305, .8095, .8559, .8819}, {.5528, .5873, .5603}, 4);
    expect_ladder(results, "grazings-fast",
                  {.52745995765981, .66636423118007, .74940362005310, .79897011651099, .82715666925300, .84240315127881,
                   .85032000894172, .85431167398464},
                  {.5275, .6664, .7494, .7990, .8271, .8424, .8503, .8543}, {.5978, .5968, .5686, .5417, .5191, .5038},
                  2);
    // Where they lead; ChatterLimit has tests of the method.
    const Table onset = make_table(results.table("onset-of-chatter"), results.file());
    ASSERT_EQ(onset.rows(), 1U);
    EXPECT_NEAR(onset.number(0, 2), .85816132239, 3e-11);
    EXPECT_LT(onset.number(0, 3), onset.number(0, 2));
    EXPECT_LT(onset.number(0, 4) - onset.number(0, 3), 2e-9); // more than it is off, by the lowest flight
    // Fig. 2.7: G-4 has six segments, G-5 eight; the front is touched by the longest one while the frame sticks.
    for (const auto& [run, impacts] : {std::pair("three_impacts", 3u), std::pair("four_impacts", 4u)}) {
        const SpecialPoint point = results.point(run, "GR1");
        EXPECT_EQ(point.solution.orbit.segments(), 2 * impacts);
        EXPECT_EQ(results.study.runs.front().model.events[point.event].name, "front");
        EXPECT_NEAR(point.parameter, computed[impacts], 1e-12);
        EXPECT_FALSE(point.at_end);
    }
}

TEST(ShippedFigures, MapOfTheMicroactuatorIsThePublishedOne) {
    ShippedResults results("microactuator");
    results.run({"touches_1", "touches_2", "touches_3", "flips_1", "joining_folds_1", "slow_flips_1"});
    const Table joints = make_table(results.table("joints"), results.file());
    // Two joints and the lowest voltage, by the published values; columns label, omega, V.
    const std::vector<std::array<double, 2>> expected{{0.61364946180363, 0.58163432990654},
                                                      {0.48780870043972, 0.17106668895821},
                                                      {0.48719539788245, 0.17099889286674}};
    ASSERT_EQ(joints.rows(), 4U);
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (std::size_t column = 0; column < 2; ++column)
            EXPECT_NEAR(joints.number(i + 1, column + 1), expected[i][column], 1e-9) << i;
    // The curve of flips with one impact ends at the first joint, by its own equations.
    const SpecialPoint end = results.point("flips_1", "GR1");
    EXPECT_NEAR(results.parameter(end, "omega"), expected[0][0], 1e-12);
    EXPECT_NEAR(results.parameter(end, "V"), expected[0][1], 1e-12);
    // One curve of folds leads from joint to joint. At the cusp between them two folds meet: see below.
    const Table folds = make_table(results.table("joining-folds"), results.file());
    ASSERT_EQ(folds.rows(), 3U);
    for (std::size_t column = 0; column < 2; ++column) {
        EXPECT_NEAR(folds.number(0, column + 1), expected[0][column], 1e-9);
        EXPECT_NEAR(folds.number(2, column + 1), expected[1][column], 1e-9);
    }
    // At the cusp the curve turns in both parameters.
    EXPECT_NEAR(folds.number(1, 1), 0.7454, 5e-5); // known from elsewhere to four digits
    auto on_folds = StoredRun(results.file(), "joining_folds_1", {}).rows({.quantities = {"omega", "V"}});
    while (on_folds.next())
        for (std::size_t column = 0; column < 2; ++column)
            EXPECT_LE(on_folds.number(column), folds.number(1, column + 1) + 1e-12);
    // The flips from the slower joint.
    const SpecialPoint slow = results.point("slow_flips_1", "EP1");
    EXPECT_NEAR(results.parameter(slow, "omega"), expected[1][0], 1e-9);
    EXPECT_NEAR(results.parameter(slow, "V"), expected[1][1], 1e-9);
    // Slowly, touches come near to the static pull-in voltage 2 d / 3 sqrt(k d / (3 alpha)).
    for (const char* run : {"touches_1", "touches_2", "touches_3"}) {
        double slowest = 1, voltage = 0;
        auto rows = StoredRun(results.file(), run, {}).rows({.quantities = {"omega", "V"}});
        while (rows.next())
            if (rows.number(0) < slowest) {
                slowest = rows.number(0);
                voltage = rows.number(1);
            }
        EXPECT_NEAR(slowest, 0.05, 1e-12);
        EXPECT_NEAR(voltage, 0.3849, 0.02) << run;
    }
}

TEST(ShippedFigures, MapsOfTheMicrobeamAreThePublishedOnes) {
    ShippedResults results("microbeam");
    results.run({"no_stop", "folds_low_stiffness", "folds_high_stiffness", "folds_low_damping", "folds_high_damping"});
    // Without a stop the curves come to the folds of a branch that has none.
    const auto voltage = [&](const char* run, const char* label) {
        return results.parameter(results.point(run, label), "V");
    };
    EXPECT_NEAR(voltage("folds_low_stiffness", "BD2"), results.point("no_stop", "SN1").parameter, 1e-12);
    EXPECT_NEAR(voltage("folds_high_stiffness", "BD2"), results.point("no_stop", "SN2").parameter, 1e-12);
    // One curve from both its folds: across a cusp and a contact that begins with another event.
    for (const auto& [low, high] : {std::pair("DZ1", "DZ1"), {"CP1", "CP1"}, {"BD1", "BD2"}, {"BD2", "BD1"}})
        EXPECT_NEAR(voltage("folds_low_damping", low), voltage("folds_high_damping", high), 1e-11) << low;
}

/// The clamped beam's mode i in terms of its middle: even or odd functions, in which nothing cancels.
class BeamMode {
public:
    explicit BeamMode(int i) : even_(i % 2 == 1) {
        // tan(k/2) = -tanh(k/2) or tanh(k/2), which together are cos(k) cosh(k) = 1; by bisection.
        const long double pi = std::numbers::pi_v<long double>;
        long double low = (static_cast<long double>(i) + 0.25L) * pi, high = low + 0.5L * pi;
        const auto residual = [&](long double k) {
            return std::sin(k / 2) + (even_ ? 1 : -1) * std::tanh(k / 2) * std::cos(k / 2);
        };
        for (int step = 0; step < 100; ++step) {
            const long double middle = (low + high) / 2;
            ((residual(low) > 0) == (residual(middle) > 0) ? low : high) = middle;
        }
        k_ = low;
    }
    long double frequency() const { return k_ * k_; }
    /// At a distance from the middle.
    long double shape(long double s) const {
        return even_ ? std::cos(k_ * s) / std::cos(k_ / 2) - std::cosh(k_ * s) / std::cosh(k_ / 2)
                     : std::sin(k_ * s) / std::sin(k_ / 2) - std::sinh(k_ * s) / std::sinh(k_ / 2);
    }
    long double slope(long double s) const {
        return k_ * (even_ ? -std::sin(k_ * s) / std::cos(k_ / 2) - std::sinh(k_ * s) / std::cosh(k_ / 2)
                           : std::cos(k_ * s) / std::sin(k_ / 2) - std::cosh(k_ * s) / std::sinh(k_ / 2));
    }

private:
    bool even_;
    long double k_ = 0;
};

constexpr std::size_t intervals = 20000;

/// Values of a function at equal distances over the beam.
template <class Function>
std::vector<long double> over_the_beam(Function function) {
    std::vector<long double> values(intervals + 1);
    for (std::size_t i = 0; i <= intervals; ++i)
        values[i] = function(static_cast<long double>(i) / intervals - 0.5L);
    return values;
}
/// Integral of the product of two functions over the beam, by Simpson's rule.
long double integral(const std::vector<long double>& one, const std::vector<long double>& other) {
    long double sum = 0;
    for (std::size_t i = 0; i <= intervals; ++i)
        sum += (i == 0 || i == intervals ? 1 : i % 2 == 1 ? 4 : 2) * one[i] * other[i];
    return sum / (3 * intervals);
}

TEST(ShippedFigures, ModalFrequenciesAndSlopesOfTheMicrobeamAreThePublishedOnes) {
    ShippedResults results("microbeam-modes");
    results.run({});
    const Table table = make_table(results.table("table-3-1"), results.file());
    ASSERT_EQ(table.rows(), 9u);
    const double computed[] = {22.37328544806, 61.67282286792, 120.9033917271, 199.8594481272, 298.5555352982,
                               416.9907858354, 555.1652475668, 713.0789179784, 890.7317971983};
    const double printed[] = {22.4, 61.7, 121, 200, 299, 417, 555, 713, 891};
    std::vector<BeamMode> modes;
    std::vector<long double> sizes;
    std::vector<std::vector<long double>> slopes;
    for (int i = 1; i <= 9; ++i) {
        const BeamMode mode(i);
        modes.push_back(mode);
        const std::vector<long double> shape = over_the_beam([&](long double s) { return mode.shape(s); });
        sizes.push_back(std::sqrt(integral(shape, shape)));
        slopes.push_back(over_the_beam([&](long double s) { return mode.slope(s); }));
    }
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_EQ(table.text(i, 0), "mode_" + std::to_string(i + 1));
        // Of motions that were integrated to 1e-12; computed values have thirteen digits, printed ones three.
        const double frequency = table.number(i, 1);
        EXPECT_NEAR(frequency, computed[i], 1e-12 * frequency) << i;
        EXPECT_NEAR(frequency, static_cast<double>(modes[i].frequency()), 1e-12 * frequency) << i;
        EXPECT_NEAR(frequency, printed[i], frequency < 100 ? 0.05 : 0.5) << i;
        for (std::size_t j = 0; j < 9; ++j) {
            const long double product = integral(slopes[i], slopes[j]);
            // The sign of a mode's shape is free: here all are positive at x = 1/2 - 0, or rise there.
            EXPECT_NEAR(std::abs(table.number(i, 2 + j)), std::abs(static_cast<double>(product / sizes[i] / sizes[j])),
                        1e-9)
                << i << ' ' << j;
        }
    }
    const struct {
        std::size_t i, j;
        double printed, tolerance;
    } products[] = {{1, 1, 12.3, .05},   {1, 3, -9.73, .005}, {1, 5, -7.62, .005}, {1, 7, -6.11, .005},
                    {1, 9, -5.07, .005}, {2, 2, 46.1, .051},  {2, 4, -17.1, .05},  {2, 6, -15.2, .05},
                    {2, 8, -13.1, .05},  {3, 3, 98.9, .05},   {3, 5, -24.3, .051}, {3, 7, -23.0, .05},
                    {3, 9, -20.9, .05},  {4, 4, 172, .5},     {4, 6, -31.3, .05},  {4, 8, -30.6, .05},
                    {5, 5, 264, .5},     {5, 7, -38.0, .05},  {5, 9, -38.0, .05},  {6, 6, 376, .5},
                    {6, 8, -44.7, .05},  {7, 7, 508, .5},     {7, 9, -51.2, .05},  {8, 8, 660, .5},
                    {9, 9, 831, .5}}; // 836 there
    for (const auto& product : products) {
        EXPECT_NEAR(table.number(product.i - 1, 1 + product.j), product.printed, product.tolerance)
            << product.i << ' ' << product.j;
        EXPECT_NEAR(table.number(product.j - 1, 1 + product.i), product.printed, product.tolerance);
    }
    const double tenth[][3] = {{1, 1, 12.302618622966},
                               {1, 3, -9.7307922131},
                               {3, 3, 98.9048014025},
                               {5, 5, 263.997980736},
                               {9, 9, 831.041536780}};
    for (const auto& [i, j, value] : tenth)
        EXPECT_NEAR(table.number(static_cast<std::size_t>(i) - 1, 1 + static_cast<std::size_t>(j)), value, 1e-9);
}

TEST(ShippedFigures, OrbitsAndBranchesOfTheMicrobeamAreThePublishedOnes) {
    ShippedResults results("microbeam");
    results.run({"grazing", "high_penetration", "contact", "no_stop", "one_mode_contact", "one_mode_high_penetration"});
    EXPECT_NEAR(results.point("no_contact", "GR1").parameter, 0.030040810557599, 1e-13);
    EXPECT_NEAR(results.point("contact", "SN1").parameter, 0.032825650930776, 1e-13);
    EXPECT_NEAR(results.point("contact", "SN2").parameter, 0.022532683475758, 1e-13);
    EXPECT_NEAR(results.point("no_stop", "SN1").parameter, 0.036662363851355, 1e-13);
    // Fig. 3.3: one orbit touches the stop, the other is on the branch beyond the folds.
    EXPECT_NEAR(results.monitor("grazing", "V"), 0.030040810557599, 1e-13);
    EXPECT_EQ(results.point("grazing", "EP1").solution.orbit.segments(), 2u);
    EXPECT_EQ(results.point("high_penetration", "EP1").solution.orbit.segments(), 4u);
    // Fig. 3.6: the stop is touched at the same voltage however stiff it is, and the fold follows closely.
    const double grazing = results.point("one_mode_no_contact", "GR1").parameter;
    EXPECT_NEAR(grazing, 0.030040810557599, 1e-13);
    const double fold = results.point("one_mode_contact", "SN1").parameter;
    EXPECT_GT(fold, grazing);
    EXPECT_LT(fold, 1.01 * grazing);
    EXPECT_LT(fold, results.point("contact", "SN1").parameter);
    for (const OrbitRecord& record : results.file().orbits("one_mode_contact", false))
        EXPECT_LE(record.point.parameter, fold * (1 + 1e-12));
}

/// Fig. 3.5: a sweep and the equations of the orbit agree on the speed at which the stop is met.
TEST(ShippedFigures, ContactSpeedOfTheMicrobeamIsThePublishedOne) {
    ShippedResults results("microbeam");
    results.run({"penetration", "high_penetration"});
    const StoredRun sweep(results.file(), "penetration", {});
    auto samples = sweep.rows({.samples = true,
                               .columns = {"direction"},
                               .quantities = {"V"},
                               .values = {"contact_speed"},
                               .samplings = {"touch"}});
    double first = 1, last_down = 1, at_033 = 0, before_jump = 0, after_jump = 0;
    while (samples.next()) {
        const double voltage = samples.number(1), speed = samples.number(2);
        EXPECT_GT(speed, 0);
        if (samples.text(0) == "up") {
            first = std::min(first, voltage);
            if (voltage < 0.0328256)
                before_jump = std::max(before_jump, speed);
            else
                after_jump = after_jump == 0 ? speed : std::min(after_jump, speed);
            if (std::abs(voltage - 0.033) < 1e-9)
                at_033 = speed;
        } else {
            last_down = std::min(last_down, voltage);
        }
    }
    EXPECT_NEAR(first, 0.03005, 1e-12);     // the first step beyond 0.030040810557599
    EXPECT_NEAR(last_down, 0.02255, 1e-12); // the last one above 0.022532683475758
    EXPECT_GT(after_jump, 3 * before_jump);
    const StoredRun orbit(results.file(), "high_penetration", {});
    auto segments = orbit.rows({.samples = true, .columns = {"ending", "approach_speed"}});
    double approach = 0;
    while (segments.next())
        if (segments.text(0).find("touch") != std::string::npos)
            approach = segments.number(1);
    // Newton's method ends at 1e-10 of the orbit's size in either.
    EXPECT_NEAR(std::abs(approach), at_033, 1e-8);
}

TEST(ShippedFigures, NineModesMeetAStiffStopAsPublished) {
    ShippedResults results("microbeam");
    results.run({"one_mode", "nine_modes"});
    const Table table = make_table(results.table("modal-amplitudes"), results.file());
    ASSERT_EQ(table.rows(), 1u);
    const double percent[] = {11.21, 2.28, .525, .182}, digit[] = {.01, .01, .001, .001};
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(table.number(0, 4 + i), percent[i], digit[i] / 2);
    const double one = std::max(results.monitor("one_mode", "highest_q1"), -results.monitor("one_mode", "lowest_q1"));
    EXPECT_NEAR(one / table.number(0, 3), 1, 0.05);
}

/// Section 3.4: how much higher modes have of the motion, and how many of them it takes to tell that of the first.
TEST(ShippedFigures, AmplitudesOfModesAgainstThreeStopsAreThePublishedOnes) {
    ShippedResults results("microbeam-amplitudes");
    results.run({});
    const Table nine = make_table(results.table("modes-9"), results.file());
    ASSERT_EQ(nine.rows(), 3U);
    // Computed independently for the stiffest stop; what is printed for the others is rounded to one or two digits.
    const double computed[] = {11.21, 2.28, .525, .182}, digit[] = {.01, .01, .001, .001};
    const double printed[2][4] = {{3, .6, .1, .05}, {5, .4, .2, .05}}, rounding[] = {.5, .1, .05, .01};
    const std::size_t first = 7; // columns run, label, k, V, two of the first mode, one of the third
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(nine.number(2, first + i), computed[i], digit[i] / 2) << i;
        for (std::size_t stop = 0; stop < 2; ++stop)
            EXPECT_NEAR(nine.number(stop, first + i), printed[stop][i], rounding[i]) << stop << ' ' << i;
    }
    // One mode is within 3, 3 and 5 percent of nine, seven within 0.2; the more, the closer.
    const double one_mode[] = {.04, .04, .05};
    for (std::size_t stop = 0; stop < 3; ++stop) {
        double before = 1;
        for (const int modes : {1, 3, 5, 7}) {
            const Table table = make_table(results.table("modes-" + std::to_string(modes)), results.file());
            ASSERT_EQ(table.rows(), 3U) << modes;
            const double error = std::abs(table.number(stop, 4) / nine.number(stop, 4) - 1);
            EXPECT_LT(error, before) << stop << ' ' << modes;
            EXPECT_LT(error, modes == 1 ? one_mode[stop] : modes == 7 ? 0.002 : 1) << stop << ' ' << modes;
            before = error;
        }
    }
}

/// Figs 3.4 and 3.5 with the unstable branches between the folds, for three stops.
TEST(ShippedFigures, StopsOfThreeStiffnessesGiveThePublishedBranches) {
    ShippedResults results("microbeam-stops");
    results.run({"contact_100", "contact_500", "contact_5000", "polynomial_contact"});
    EXPECT_NEAR(results.point("contact_100", "SN1").parameter, 0.032825650930776, 1e-13);
    EXPECT_NEAR(results.point("contact_100", "SN2").parameter, 0.022532683475758, 1e-13);
    const double touch = results.point("no_contact", "GR1").parameter;
    EXPECT_NEAR(touch, 0.030040810557599, 1e-13);
    double low_before = 1, high_before = 1, deep_before = 1;
    for (const char* run : {"contact_100", "contact_500", "contact_5000"}) {
        const SpecialPoint low = results.point(run, "SN1"), high = results.point(run, "SN2");
        // The stiffer the stop, the nearer to the touch low penetration ends, and the further down high penetration
        // goes.
        EXPECT_GT(low.parameter, touch);
        EXPECT_LT(low.parameter, low_before);
        EXPECT_LT(high.parameter, high_before);
        EXPECT_LT(high.monitors.at(0), deep_before);
        low_before = low.parameter;
        high_before = high.parameter;
        deep_before = high.monitors.at(0);
        for (const OrbitRecord& record : results.file().orbits(run, false)) {
            const double depth = record.point.monitors.at(0);
            const bool between = depth > low.monitors.at(0) && depth < high.monitors.at(0);
            if (depth < 0.95 * low.monitors.at(0) ||
                (between && depth < 0.95 * high.monitors.at(0) && depth > 1.05 * low.monitors.at(0))) {
                EXPECT_EQ(record.stable, !between) << run << ' ' << record.point.parameter;
            }
            EXPECT_GT(record.point.monitors.at(1), 0); // the speed at contact
        }
    }
    // The polynomial is another first mode: its frequency is 0.34 % higher.
    EXPECT_NEAR(results.point("polynomial_contact", "SN1").parameter, 0.0328, 2e-4);
    EXPECT_NEAR(results.point("polynomial_contact", "SN2").parameter, 0.0225, 3e-4);
}

/// The steady voltage at which the beam rests at a deflection, by the balance of forces alone:
/// V^2 = elastic(q)/attraction(q).
double steady_voltage(Model model, double deflection) {
    const auto rate = [&](double voltage) {
        model.set_parameter("V", voltage);
        std::vector<double> inputs{deflection, 0, 0};
        const std::vector<double> parameters = model.parameter_values();
        inputs.insert(inputs.end(), parameters.begin(), parameters.end());
        return model.function_of(std::vector<Expression>{model.modes[0].rates[1]})(inputs)[0];
    };
    return std::sqrt(-rate(0) / (rate(1) - rate(0)));
}

/// The static pull-in curve: w and V at its fold.
TEST(ShippedFigures, PullInUnderASteadyVoltageIsAsPublished) {
    ShippedResults results("microbeam-stops");
    results.run({"equilibria", "oscillations"});
    const Model model = load_model("microbeam-steady");
    const auto voltage_at = [&](double q) { return steady_voltage(model, q); };
    double low = 0.005, high = 0.024; // the greatest voltage, by thirds
    for (int i = 0; i < 60; ++i) {
        const double one = low + (high - low) / 3, other = high - (high - low) / 3;
        (voltage_at(one) < voltage_at(other) ? low : high) = voltage_at(one) < voltage_at(other) ? one : other;
    }
    const SpecialPoint fold = results.point("equilibria", "SN1");
    EXPECT_NEAR(fold.parameter, voltage_at(low), 1e-12);
    EXPECT_NEAR(fold.monitors.at(0) / 1.5881462620646052, low, 1e-7); // flat at its top
    // Newton's last correction is 1e-10 of each unknown, which unstable equilibria magnify.
    for (const OrbitRecord& record : results.file().orbits("equilibria", false))
        EXPECT_NEAR(record.point.parameter, voltage_at(record.point.monitors.at(0) / 1.5881462620646052), 1e-9);
    // In pulses at this frequency, near the first mode's, less is enough.
    EXPECT_NEAR(results.point("oscillations", "SN1").parameter, 0.036662363851355, 1e-13);
}

/// Eq. (3.29): the fold is where its root manifold turns, the better the stiffer the stop.
TEST(ShippedFigures, DistanceOfTheFoldFromTheTouchIsAsPublished) {
    ShippedResults results("microbeam-stops");
    double before = 0, alpha_before = 0, stiffness_before = 0;
    for (const int stiffness : {500, 1000, 2000, 5000, 10000}) {
        const std::string touch = "touch_" + std::to_string(stiffness), fold = "fold_" + std::to_string(stiffness);
        results.run({touch, fold});
        const StoredRun run(results.file(), touch, {});
        const System system(run.model);
        const Orbit orbit = results.point(touch, "EP1").solution.orbit;
        CycleMapOptions options;
        options.parameter = run.model.independent_parameter("V");
        const CycleMap map = cycle_map(system, orbit, touches_of(system, orbit).at(0), options);
        const Verdict verdict = verdict_of(map);
        ASSERT_EQ(verdict.outcome, GrazingOutcome::folds);
        const double voltage = orbit.parameters[options.parameter->place()];
        const SpecialPoint measured = results.point(fold, "SN1");
        const double error = std::abs((measured.parameter - voltage) / *verdict.fold_distance - 1);
        // Depth and clearance of the fold of the cubic.
        EXPECT_NEAR(*verdict.fold_depth, std::pow(2 / (3 * *verdict.alpha), 2), 1e-12);
        EXPECT_NEAR(*verdict.fold_clearance, -4 / (27 * *verdict.alpha * *verdict.alpha), 1e-12);
        EXPECT_NEAR(measured.monitors.at(0) / *verdict.fold_depth, 1, 3 * 100.0 / stiffness);
        // Fig. 3.2: orbits between touch and fold are roots of the cubic, tau = -depth^(1/2), as well as the fold is.
        std::size_t roots = 0;
        for (const OrbitRecord& record : results.file().orbits(fold, false)) {
            const double depth = record.point.monitors.at(0), tau = -std::sqrt(std::max(0.0, depth));
            const double beta = *map.clearance_rate * (record.point.parameter - voltage);
            const double cubic = *verdict.alpha * tau * tau * tau + tau * tau + beta;
            EXPECT_NEAR(cubic, 0, 150.0 / stiffness * std::abs(*verdict.fold_clearance)) << stiffness << ' ' << depth;
            ++roots;
        }
        EXPECT_GE(roots, 2U);
        if (before > 0) {
            const double times = stiffness / stiffness_before;
            EXPECT_NEAR(*verdict.alpha / alpha_before, times, 1e-6 * times); // its force is in proportion
            // The next order of the map is by one root of the depth more, which is by one over the stiffness.
            EXPECT_NEAR(std::log(before / error) / std::log(times), 1, 0.2) << stiffness;
        }
        before = error;
        alpha_before = *verdict.alpha;
        stiffness_before = stiffness;
    }
    EXPECT_LT(before, 0.01);
}

/// Fig. 3.2: between touch and fold, and beyond it, contacts are roots of one cubic. In units of its fold it is
/// beta = 3 tau^2 - 2 tau^3, whatever alpha is.
TEST(ShippedFigures, RootManifoldOfACompliantContactIsAsPublished) {
    ShippedResults results("microbeam-stops");
    double before = 0;
    for (const int stiffness : {1000, 2000, 5000, 10000}) {
        const std::string run = "roots_" + std::to_string(stiffness);
        results.run({run});
        // What the study's monitor measures from is the touch itself.
        EXPECT_NEAR(results.point("no_contact", "GR1").parameter, 0.030040810557599, 1e-14);
        const SpecialPoint fold = results.point(run, "SN1");
        double largest = 0;
        std::size_t beyond = 0;
        for (const OrbitRecord& record : results.file().orbits(run, false)) {
            const double tau = record.point.monitors.at(0) / fold.monitors.at(0),
                         beta = record.point.monitors.at(1) / fold.monitors.at(1);
            beyond += tau > 1.1 ? 1 : 0;
            constexpr double stretch = 1.25; // up to which all of them go
            if (tau < stretch)
                largest = std::max(largest, std::abs(beta - tau * tau * (3 - 2 * tau)));
        }
        EXPECT_GT(beyond, 3U) << stiffness;
        EXPECT_LT(largest, 100.0 / stiffness) << stiffness; // the next order is by one over the stiffness
        if (before > 0) {
            EXPECT_LT(largest, before) << stiffness;
        }
        before = largest;
    }
}

/// Fig. 3.2, the other sign: where alpha is negative the orbit goes on into contact, without a fold.
TEST(ShippedFigures, AContactThatDoesNotFoldIsAsPublished) {
    ShippedResults results("microbeam-stops");
    results.run({"persisting"});
    const StoredRun run(results.file(), "no_contact_20", {});
    const System system(run.model);
    const Orbit orbit = results.point("no_contact_20", "GR1").solution.orbit;
    CycleMapOptions options;
    options.parameter = run.model.independent_parameter("V");
    const Verdict verdict = verdict_of(cycle_map(system, orbit, touches_of(system, orbit).at(0), options));
    EXPECT_EQ(verdict.outcome, GrazingOutcome::persists);
    EXPECT_LT(*verdict.alpha, 0);
    // What the study's monitor measures from is the touch itself.
    EXPECT_NEAR(orbit.parameters[options.parameter->place()], 0.016867990101159434, 1e-14);
    double root_before = 0, distance_before = 0;
    for (const OrbitRecord& record : results.file().orbits("persisting", false)) {
        const double root = record.point.monitors.at(0), distance = record.point.monitors.at(1);
        EXPECT_LT(root, root_before);
        EXPECT_LT(distance, distance_before);
        root_before = root;
        distance_before = distance;
    }
    EXPECT_LT(distance_before, -60); // to the edge of the picture
}

/// Pull-in by the gap: static equilibria by the balance of forces alone, whose voltage is greatest at the fold.
TEST(ShippedFigures, PullInByTheGapIsAsPublished) {
    ShippedResults results("microbeam-stops");
    results.run({"static_pull_in", "dynamic_pull_in"});
    Model model = load_model("microbeam-steady");
    std::size_t points = 0;
    for (const OrbitRecord& record : results.file().orbits("static_pull_in", false)) {
        const std::vector<double>& parameters = record.point.solution.orbit.parameters;
        const double gap = parameters[model.independent_parameter("g0").place()],
                     q = record.point.solution.orbit.starts[0][0];
        model.set_parameter("g0", gap);
        const auto voltage_at = [&](double deflection) { return steady_voltage(model, deflection); };
        EXPECT_NEAR(record.point.parameter, gap, 1e-14);
        EXPECT_NEAR(parameters[model.independent_parameter("V").place()], voltage_at(q), 1e-10) << gap;
        const double step = 1e-4 * q; // it is flat there
        EXPECT_LT(std::abs(voltage_at(q + step) - voltage_at(q - step)), 1e-9 * voltage_at(q)) << gap;
        ++points;
    }
    EXPECT_GT(points, 10U);
    // At the shipped gap of 0.04 the orbit under pulses folds at two thirds of that.
    EXPECT_NEAR(
        results.point("dynamic_pull_in", "EP1").solution.orbit.parameters[model.independent_parameter("V").place()],
        0.036662363851355, 1e-11);
}

TEST(ShippedFiguresSlow, StopsOfThreeStiffnessesAndNineModesGiveThePublishedBranches) {
    ShippedResults results("microbeam-stops");
    results.run({"nine_contact_100", "nine_contact_500", "nine_contact_5000"});
    // Both folds that one mode has at the published voltages: the higher modes are small.
    EXPECT_NEAR(results.point("nine_contact_100", "SN1").parameter, 0.032825650930776, 0.01 * 0.0328);
    EXPECT_NEAR(results.point("nine_contact_100", "SN2").parameter, 0.022532683475758, 0.01 * 0.0225);
    for (const char* run : {"nine_contact_500", "nine_contact_5000"})
        EXPECT_LT(results.point(run, "SN2").parameter, results.point(run, "SN1").parameter) << run;
    const double touch = results.point("nine_no_contact", "GR1").parameter;
    const double middle = results.point("nine_contact_500", "SN1").parameter,
                 stiff = results.point("nine_contact_5000", "SN1").parameter;
    EXPECT_GT(middle, stiff);
    EXPECT_GT(stiff, touch);
    EXPECT_LT(stiff, 1.001 * touch);
}

TEST(ShippedFiguresSlow, NineModesAreFollowedUpToTheirFold) {
    ShippedResults results("microbeam");
    results.run({"nine_modes_contact", "nine_modes_high_penetration"});
    const SpecialPoint grazing = results.point("nine_modes_no_contact", "GR1");
    const double fold = results.point("nine_modes_contact", "SN1").parameter;
    EXPECT_NEAR(grazing.parameter, 0.03, 5e-5);    // as printed, to one digit
    EXPECT_NEAR(grazing.monitors.at(0), 0, 1e-12); // the penetration
    EXPECT_GT(fold, grazing.parameter);
    EXPECT_LT(fold, 1.01 * grazing.parameter);
    // Beside both a branch of high penetration, which stays on all of the figure.
    for (const OrbitRecord& record : results.file().orbits("nine_modes_high_penetration", false)) {
        EXPECT_TRUE(record.stable);
        EXPECT_GT(record.point.monitors.at(0), 0.007);
    }
}

/// Fig. 5.14 (d), of a sweep that is only as long as the figure needs.
TEST(ShippedFigures, MotionsOnBothSidesOfTheOnsetAt7HzAreAsPublished) {
    const std::string whole = "from = 3.0, to = 5.5", part = "from = 3.66, to = 3.68";
    std::string text = shipped_study_text("electromagnetic-testbed");
    ASSERT_NE(text.find(whole), std::string::npos);
    text.replace(text.find(whole), whole.size(), part);
    ShippedResults results(parse_study(text, "electromagnetic-testbed"));
    results.run({"before_onset_7Hz", "after_onset_7Hz", "no_impact_7Hz"});
    EXPECT_NEAR(results.point("no_impact_7Hz", "GR1").parameter, 3.675357252066, 1e-10);
    // Half a period on, the motion without impacts is its own image: the current changes sign, the velocity does not.
    auto before = StoredRun(results.file(), "before_onset_7Hz", {}).rows({.samples = true, .values = {"v", "I"}});
    std::vector<double> velocities, currents;
    while (before.next()) {
        velocities.push_back(before.number(0));
        currents.push_back(before.number(1));
    }
    ASSERT_EQ(velocities.size(), 400u);
    for (std::size_t i = 0; i < 200; ++i) {
        EXPECT_NEAR(velocities[i], velocities[i + 200], 1e-8) << i;
        EXPECT_NEAR(currents[i], -currents[i + 200], 1e-8) << i;
    }
    const StoredRun after(results.file(), "after_onset_7Hz", {});
    auto phases = after.rows({.samples = true, .values = {"v"}, .samplings = {"phases"}});
    std::size_t count = 0;
    double least = 1, greatest = -1; // of velocities at one phase, which vary from period to period
    while (phases.next())
        if (count++ % 100 == 0) {
            least = std::min(least, phases.number(0));
            greatest = std::max(greatest, phases.number(0));
        }
    EXPECT_EQ(count, 4000u);
    EXPECT_GT(greatest - least, 0.01);
}

} // namespace graze::shipped_figures_test
