#include "graze/design/finished_design.hpp"

#include "graze/model/model_file.hpp"
#include "graze/results/result_file.hpp"
#include "switches.hpp"

#include <gmock/gmock.h>

#include <filesystem>

namespace graze::testing::finished_design_test {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class FinishedDesigns : public ::testing::Test {
protected:
    FinishedDesign finished(const std::string& rest, const DesignReportOptions& options = {}) {
        return finish_design(oscillator_design(rest), {path("written.sqlite"), [&] { return path("device.sqlite"); }},
                             options);
    }
    std::string path(const std::string& name) const { return folder_ / name; }

private:
    TemporaryFolder folder_;
};

TEST_F(FinishedDesigns, TheDeviceFoundForWhatIsWantedHasItsOwnBranchAndReport) {
    const FinishedDesign found = finished("[wanted]\nvalue = 0.2\n");
    ASSERT_TRUE(found.trip);
    EXPECT_FALSE(found.interrupted);
    const std::vector<double> values = found.device.model.parameter_values();
    const auto of = [&](const char* name) { return values[found.device.model.independent_parameter(name).place()]; };
    EXPECT_NEAR(found.trip->value(), 0.2, 1e-9);
    EXPECT_NEAR(oscillator_value(of("sigma"), of("zeta")), found.trip->value(), 1e-10);
    EXPECT_NEAR(found.report.value, found.trip->value(), 1e-12);
    EXPECT_FALSE(found.trips_elsewhere());
    EXPECT_EQ(found.written.model.parameter_values()[found.written.model.independent_parameter("sigma").place()], 0.2);
    EXPECT_FALSE(ResultFile(path("written.sqlite"), ResultFile::Access::read).runs().empty());
    EXPECT_FALSE(ResultFile(path("device.sqlite"), ResultFile::Access::read).runs().empty());
}

TEST_F(FinishedDesigns, WithoutWishesTheDeviceIsTheWrittenOne) {
    const FinishedDesign found = finished("");
    ASSERT_TRUE(found.trip);
    EXPECT_EQ(write_model(found.device.model), write_model(found.written.model));
    EXPECT_FALSE(std::filesystem::exists(path("device.sqlite")));
    EXPECT_TRUE(found.is_untried()); // this oscillator does not reach the end that counts as tripped
    EXPECT_THAT(found.warnings(), ElementsAre(HasSubstr("not checked by simulation")));
}

TEST_F(FinishedDesigns, WhatIsNotMetIsAWarning) {
    const FinishedDesign found = finished("[wanted]\nvalue = 0.9\n");
    EXPECT_FALSE(found.interrupted);
    EXPECT_THAT(found.warnings(), Contains(HasSubstr("what is wanted: unmet")));
}

TEST_F(FinishedDesigns, AClassThatIsNotWantedIsAWarning) {
    FinishedDesign found = finished("");
    found.device.wanted.outcome =
        found.report.found.outcome == GrazingOutcome::lost ? GrazingOutcome::persists : GrazingOutcome::lost;
    EXPECT_THAT(found.warnings(), Contains(HasSubstr("is wanted")));
    found.device.wanted.outcome = found.report.found.outcome;
    EXPECT_THAT(found.warnings(), Not(Contains(HasSubstr("is wanted"))));
}

TEST_F(FinishedDesigns, ATripElsewhereIsAWarning) {
    FinishedDesign found = finished("[wanted]\nvalue = 0.2\n");
    found.report.wishes->trip_value = 0.2 * (1 + 1e-5);
    EXPECT_TRUE(found.trips_elsewhere());
    EXPECT_THAT(found.warnings(), Contains(HasSubstr("comes first to another one")));
}

TEST_F(FinishedDesigns, AnInterruptionIsTold) {
    DesignReportOptions options;
    options.interrupted = [] { return true; };
    const FinishedDesign found = finished("[wanted]\nvalue = 0.2\n", options);
    EXPECT_TRUE(found.interrupted);
}

} // namespace graze::testing::finished_design_test
