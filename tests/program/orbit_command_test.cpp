#include "branch_results.hpp"
#include "graze/orbit/orbit_file.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>

namespace graze::testing::orbit_command_test {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double eps = std::numeric_limits<double>::epsilon();
using OrbitCommand = BranchResults;

/// A ball that flies between two walls at unit distance from the centre. Its orbit is symmetric, and only the half in
/// which it flies to the right is stored.
constexpr const char* box = R"(
name = "box"
[parameters]
speed = 1
[states]
x = -1
v = "speed"
[modes.free]
rates = { x = "v", v = 0 }
watch = ["right", "left"]
[events.right]
function = "1 - x"
[events.left]
function = "x + 1"
[jumps.turn]
v = "-v"
[[transitions]]
mode = "free"
event = "right"
label = "R"
jump = "turn"
next = [{ mode = "free" }]
[[transitions]]
mode = "free"
event = "left"
label = "L"
jump = "turn"
next = [{ mode = "free" }]
[symmetries.mirror]
map = { x = "-x", v = "-v" }
)";

TEST_F(OrbitCommand, PrintsTheMotionOverOnePeriod) {
    write_branches();
    const std::string printed =
        done({"orbit", path, "SN1", "--samples", "8", "--quantity", "energy", "--format", "csv"});
    EXPECT_THAT(printed, StartsWith("segment,mode,end,t,x,v,energy\n1,flight,bounce,0,0,1,0.5\n"));
    const Csv csv(printed);
    ASSERT_EQ(csv.rows.size(), 9U);
    for (std::size_t row = 0; row < 9; ++row) {
        const double t = csv.number(row, "t");
        EXPECT_NEAR(t, static_cast<double>(row) / 8, 4 * eps);
        EXPECT_NEAR(csv.number(row, "x"), t - t * t, 8 * eps);
        EXPECT_NEAR(csv.number(row, "v"), 1 - 2 * t, 8 * eps);
        EXPECT_NEAR(csv.number(row, "energy"), 0.5, 16 * eps);
    }
    EXPECT_EQ(csv.number(8, "t"), 1);
}

TEST_F(OrbitCommand, AnotherRunCanStartFromTheCsv) {
    write_branches();
    const Printed printed = run_graze({"orbit", path, "PD1", "--format", "csv"});
    const Orbit orbit = parse_orbit_table(model, printed.out, "", "orbit.csv");
    EXPECT_EQ(orbit.signature, parse_signature(model, "bounce"));
    EXPECT_EQ(orbit.starts, (std::vector<std::vector<double>>{{0, 1}}));
    EXPECT_EQ(orbit.durations, std::vector<double>{2 / 0.9});
}

/// Laws of friction, contacts and slides make names with hyphens.
TEST_F(OrbitCommand, AnotherRunCanStartFromTheCsvOfDerivedModes) {
    OrbitRecord record = orbit_of("up", PointType::end, 1, true, true);
    record.point.monitors = {};
    model = parse_model(R"(
parameters.mu = 0.5
states = { x = 0, v = 0, s = { initial = 0, period = 4 } }
modes.free.rates = { x = "v", v = "2*cos(pi*s/2) - x - ground", s = 1 }
friction.ground = { velocity = "v", normal = 1, coefficient = "mu" }
)",
                        "rubbing.toml");
    RunRecord run = run_of("rubbing", "continue");
    run.coordinates = {{"mu", ""}};
    run.states = {{"x", ""}, {"v", ""}, {"s", ""}};
    run.values = {};
    Orbit& orbit = record.point.solution.orbit;
    orbit.signature =
        parse_signature(model, "free-stick:forward free-forward:stops free-stick:backward free-backward:stops");
    orbit.parameters = {0.5};
    orbit.starts = {{-1, 0, 3}, {-1, 0, 3.5}, {1, 0, 1}, {1, 0, 1.5}};
    orbit.durations = {0.5, 1.5, 0.5, 1.5};
    {
        ResultFile file(path, ResultFile::Access::write);
        write_run(file, run, {record});
    }
    const Printed printed = run_graze({"orbit", path, "0", "--samples", "4", "--format", "csv"});
    const Orbit read = parse_orbit_table(model, printed.out, "", "orbit.csv");
    EXPECT_EQ(read.signature, orbit.signature);
    EXPECT_EQ(read.starts, orbit.starts);
    EXPECT_EQ(read.durations, orbit.durations);
}

TEST_F(OrbitCommand, ShowsBothHalvesOfASymmetricOrbit) {
    OrbitRecord record = orbit_of("up", PointType::end, 1, true, true);
    record.point.monitors = {};
    model = parse_model(box, "box.toml");
    RunRecord run = run_of("halves", "continue");
    run.coordinates = {{"speed", ""}};
    run.values = {};
    Orbit& orbit = record.point.solution.orbit;
    orbit.signature = parse_signature(model, "R");
    orbit.parameters = {2};
    orbit.starts = {{-1, 2}};
    orbit.durations = {1};
    orbit.symmetry = 0;
    {
        ResultFile file(path, ResultFile::Access::write);
        write_run(file, run, {record});
    }
    const Printed printed = run_graze({"orbit", path, "0", "--samples", "4", "--format", "csv"});
    EXPECT_EQ(printed.out, "segment,mode,end,t,x,v\n1,free,R,0,-1,2\n1,free,R,0.5,0,2\n1,free,R,1,1,2\n"
                           "2,free,L,1,1,-2\n2,free,L,1.5,0,-2\n2,free,L,2,-1,-2\n");
    EXPECT_THAT(run_graze({"points", path}).out, HasSubstr("mirror"));
}

TEST_F(OrbitCommand, ShowsSegmentsOfNegativeDuration) {
    OrbitRecord record = orbit_of("up", PointType::vanishing, 1, true, false);
    record.point.solution.orbit.durations = {-0.5};
    {
        ResultFile file(path, ResultFile::Access::write);
        write_run(file, run_of("backwards", "continue"), {record});
    }
    const Csv csv(run_graze({"orbit", path, "DZ1", "--samples", "2", "--format", "csv"}).out);
    ASSERT_EQ(csv.rows.size(), 3U);
    EXPECT_EQ(csv.number(2, "t"), -0.5);
    EXPECT_NEAR(csv.number(2, "x"), -0.5 - 0.125, 4 * eps);
    EXPECT_NEAR(csv.number(2, "v"), 1.5, 4 * eps);
}

TEST_F(OrbitCommand, JsonIdentifiesTheOrbit) {
    write_branches();
    const Printed printed = run_graze({"orbit", path, "second:GR1", "--format", "json"});
    EXPECT_TRUE(JsonCheck(printed.out).valid());
    for (const char* part :
         {"\"run\":\"second\"", "\"label\":\"GR1\"", "\"type\":\"GR\"", "\"parameters\":{\"g\":1.25,\n\"w\":2}",
          "\"period\":1.6", "\"signature\":\"bounce\"",
          "\"multipliers\":[{\"real\":0.5,\n\"imaginary\":0},\n{\"real\":0.25,\n\"imaginary\":0.125}", "\"stable\":1",
          "\"admissible\":1"})
        EXPECT_THAT(printed.out, HasSubstr(part));
}

TEST_F(OrbitCommand, FindsPointsByLabelAndNumber) {
    write_branches();
    const auto period = [&](const std::string& point) {
        const Csv csv(run_graze({"orbit", path, point, "--samples", "1", "--format", "csv"}).out);
        return csv.rows.empty() ? 0 : csv.number(csv.rows.size() - 1, "t");
    };
    EXPECT_EQ(period("SN1"), 1);
    EXPECT_EQ(period("first:GR1"), 1.25);
    EXPECT_EQ(period("second:GR1"), 1.6);
    EXPECT_EQ(period("first:9"), 2.5);
    EXPECT_EQ(period("alone"), 0.5);
    const auto said = [&](const std::vector<std::string>& words) {
        const Printed run = run_graze(words);
        EXPECT_EQ(run.code, 2);
        return run.err;
    };
    EXPECT_THAT(said({"orbit", path, "GR1"}), HasSubstr("write first:GR1 or second:GR1"));
    EXPECT_THAT(said({"orbit", path, "GR7"}), HasSubstr("no run has an orbit 'GR7'"));
    EXPECT_THAT(said({"orbit", path, "first:GR7"}), HasSubstr("GR1"));
    EXPECT_THAT(said({"orbit", path, "first:99"}), HasSubstr("--all lists its 10 orbits"));
    EXPECT_THAT(said({"orbit", path, "frist:GR1"}), HasSubstr("did you mean 'first'?"));
    EXPECT_THAT(said({"orbit", path, "first:"}), HasSubstr("no orbit ''"));
    EXPECT_THAT(said({"orbit", path}), HasSubstr("the point is missing; write graze orbit FILE POINT"));
    EXPECT_THAT(said({"orbit", path, "SN1", "--quantity", "enrgy"}), HasSubstr("energy"));
    EXPECT_THAT(said({"orbit", path, "SN1", "--samples", "0"}), HasSubstr("--samples"));
    EXPECT_THAT(said({"orbit", path, "SN1", "--x", "v"}), HasSubstr("--plot FILE"));
}

TEST_F(OrbitCommand, WarnsOfInadmissibleOrbits) {
    write_branches();
    EXPECT_THAT(run_graze({"orbit", path, "first:EP2"}).err, HasSubstr("event 'floor' happens within segment 1"));
    EXPECT_EQ(run_graze({"orbit", path, "first:EP1"}).err, "");
}

TEST_F(OrbitCommand, DrawsPortraitsAndHistories) {
    write_branches();
    const std::string picture = folder / "orbit.svg", data = folder / "orbit.gp";
    const std::string portrait = done({"orbit", path, "first:GR1", "--plot", picture, "--data", data});
    EXPECT_EQ(portrait, picture + "\n");
    EXPECT_GT(std::filesystem::file_size(picture), 2'000U);
    const std::string script = contents(data);
    EXPECT_NE(script.find("set label \"floor\" at "), std::string::npos);
    // The jump from v = -1 to 1 at the floor is dotted: many strokes, all of them at x = 0.
    std::istringstream lines(script);
    std::size_t strokes = 0;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream numbers(line);
        double x = 1, v = 0;
        strokes += (numbers >> x >> v) && std::abs(x) < 1e-12 && std::abs(v) < 0.999 ? 1 : 0;
    }
    EXPECT_GT(strokes, 20U);
    done({"orbit", path, "first:SN1", "--plot", picture, "--x", "t", "--y", "x,energy"});
    EXPECT_EQ(run_graze({"orbit", path, "first:SN1", "--plot", folder / "orbit.doc"}).code, 2);
    EXPECT_THAT(run_graze({"orbit", path, "first:SN1", "--plot", picture, "--y", "z"}).err, HasSubstr("z"));
}

} // namespace graze::testing::orbit_command_test
