#include "graze/orbit/orbit_file.hpp"

#include "base/message_of.hpp"
#include "graze/base/input_error.hpp"
#include "graze/orbit/solve.hpp"
#include "trajectory/simulate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

namespace graze::orbit_file_test {

using namespace graze::testing;

using ::testing::HasSubstr;

/// The first and the last row of each segment of the linear impact oscillator's orbit.
const std::string heading = "segment,mode,end,t,x,v,theta\n";
const std::string rows =
    "1,free,impact,0.5,0.1,-0.9,2.8\n1,free,impact,2.0,-1.3,-0.1,6\n1,free,impact,3.35,0.1,1.1,2.8\n";

Model oscillator() {
    return shipped_with("impact-oscillator", {{"omega", 2.2}});
}

TEST(OrbitTable, GivesStartsAndDurations) {
    const Model model = oscillator();
    const Orbit orbit = parse_orbit_table(model, "# a comment\n\n" + heading + rows, "", "orbit.csv");
    ASSERT_EQ(orbit.segments(), 1u);
    EXPECT_EQ(to_string(model, orbit.signature), "impact");
    EXPECT_EQ(orbit.starts[0], (std::vector<double>{0.1, -0.9, 2.8}));
    EXPECT_NEAR(orbit.durations[0], 2.85, 1e-15);
    EXPECT_EQ(orbit.parameters, model.parameter_values());
    // Columns in another order, with the signature as an argument.
    const Orbit other =
        parse_orbit_table(model, "theta,v,x,t,segment\n2.8,-0.9,0.1,0,1\n2.8,1.1,0.1,2.85,1\n", "impact", "orbit.csv");
    EXPECT_EQ(other.starts, orbit.starts);
    EXPECT_EQ(other.signature, orbit.signature);
}

TEST(OrbitTable, IsAFirstGuessOfTheOrbit) {
    const Model model = oscillator();
    const OrbitSolution solution =
        solve_orbit(System(model), parse_orbit_table(model, heading + rows, "", "orbit.csv"));
    ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
    EXPECT_TRUE(solution.certificate.admissible) << solution.certificate.reason;
    EXPECT_NEAR(solution.orbit.period(), 2 * 3.14159265358979312 / 2.2, 1e-14);
}

TEST(OrbitTable, MistakesAreReportedWithTheirPlace) {
    const Model model = oscillator();
    const auto refusal = [&](const std::string& text, const std::string& signature = "impact") {
        return message_of([&] { parse_orbit_table(model, text, signature, "orbit.csv"); });
    };
    EXPECT_THAT(refusal(""), HasSubstr("orbit.csv:1:1: the table is empty"));
    EXPECT_THAT(refusal(heading), HasSubstr("the table has no rows"));
    EXPECT_THAT(refusal("segment,t,x,v\n1,0,1,2\n"), HasSubstr("orbit.csv:1:1: there is no column 'theta'"));
    EXPECT_THAT(refusal("segment,t,x,v,theta\n1,0,0.1,-1\n"),
                HasSubstr("orbit.csv:2:1: there are 4 cells under 5 names"));
    EXPECT_THAT(refusal("segment,t,x,v,theta\n1,0,0.1,fast,0\n"), HasSubstr("orbit.csv:2:9: 'fast' is not a number"));
    EXPECT_THAT(refusal("segment,t,x,v,theta\n1,0,0.1,nan,0\n"), HasSubstr("'nan' is not a number"));
    EXPECT_THAT(refusal("segment,t,x,v,theta\n2,0,0.1,1,0\n"), HasSubstr("orbit.csv:2:1: segment 2 follows 0"));
    EXPECT_THAT(refusal("segment,t,x,v,theta\n1,1,0.1,1,0\n1,0,0.1,1,0\n"), HasSubstr("orbit.csv:3:3: time goes back"));
    EXPECT_THAT(refusal("segment,t,x,v,theta\n1,1,0.1,1,0\n", ""), HasSubstr("the ends of the segments are not given"));
    EXPECT_THAT(refusal("segment,t,x,v,theta\n1,1,0.1,1,0\n2,1,0.1,1,0\n"),
                HasSubstr("the signature has 1 segments and the table 2"));
    EXPECT_THAT(refusal("segment,t,x,v,theta\n1,1,0.1,1,0\n", "bang"), HasSubstr("bang"));
    EXPECT_THAT(refusal("segment,t,x,v,theta,ent\n1,1,0.1,1,0,impact\n"), HasSubstr("did you mean 'end'?"));
    EXPECT_THAT(refusal("segment,t,x,v,theta,y\n1,1,0.1,1,0,1\n"),
                HasSubstr("orbit.csv:1:21: there is a column 'y', which means nothing"));
    EXPECT_THAT(refusal("segment,t,x,v,theta,x\n1,1,0.1,1,0,1\n"), HasSubstr("there are two columns 'x'"));
    EXPECT_EQ(refusal("segment,t,x,v,theta,2*x\n1,1,0.1,1,0,1\n"), "") << "whatever graze orbit --quantity adds";
    EXPECT_THROW(read_orbit_table(model, "/no/such/file.csv", "impact"), InputError);
}

} // namespace graze::orbit_file_test
