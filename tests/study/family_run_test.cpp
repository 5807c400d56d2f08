// Runs along families of orbits: what studies say, what results have, and what starts from them.

#include "graze/study/stored_study.hpp"
#include "study/study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::family_run_test {

using ::testing::HasSubstr;

const std::string spring = R"([parameters]
k = 1
[states]
x = 0.3
v = 0
[modes.free]
rates = { x = "v", v = "-k*x - x^3" }
watch = ["wall"]
[events]
wall = "0.7 - x"
[jumps.impact]
v = "-v"
[[transitions]]
mode = "free"
event = "wall"
label = "impact"
jump = "impact"
next = "free"
[sections.left]
function = "v"
direction = "rising"
[conserved]
energy = { value = "v^2/2 + k*x^2/2 + x^4/4", unit = "J" }
)";
const std::string head = "name = \"s\"\nmodel = \"./model.toml\"\n";
/// Energy at which the wall is touched.
constexpr double touched = 0.5 * 0.49 + 0.25 * 0.49 * 0.49;

class FamilyRun : public testing::StudyFixture {
protected:
    FamilyRun() { folder_.write("model.toml", spring); }
};

/// Sums and products are printed in an order that depends on what was read before.
TEST_F(FamilyRun, ItsConservedQuantityIsReadAgainInAnyOrder) {
    folder_.write("model.toml", R"([states]
x = 0
y = 0.1
u = 0
v = 0
[modes.free]
rates = { x = "u", y = "v", u = "-x - 2*x*y", v = "-y - x^2 + y^2" }
[sections.top]
function = "v"
direction = "falling"
[conserved]
energy = "(u^2 + v^2)/2 + (x^2 + y^2)/2 + x^2*y - y^3/3"
)");
    testing::expect_complete(run(head + R"([runs.axis]
kind = "continue"
signature = "top"
along = { energy = [0.002, 0.01] }
)"));
    const Study stored = stored_study(ResultFile(path_, ResultFile::Access::read));
    ASSERT_EQ(stored.runs.size(), 1U);
    EXPECT_TRUE(stored.runs[0].branch().settings.family);
}

TEST_F(FamilyRun, StoresItsCoordinateAndStartsFurtherRuns) {
    testing::expect_complete(run(head + R"([runs.free]
kind = "continue"
signature = "left"
along = { energy = [0.02, 2] }
[runs.impacting]
kind = "continue"
start = { run = "free", point = "GR1" }
along = { energy = [0.02, 2] }
[runs.period]
kind = "continue"
start = { run = "free", at = { energy = 0.1 } }
along = { period = [5.8, 6.1] }
direction = "up"
[runs.stiffer]
kind = "continue"
start = { run = "free", at = { energy = 0.1 } }
along = { k = [0.5, 2] }
direction = "up"
monitors = { energy = { conserved = "energy", fixed = 0.1 } }
[runs.grazing]
kind = "curve"
start = { run = "free", point = "GR1" }
along = { k = [0.5, 2], energy = [0.01, 3] }
direction = "up"
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto grazing = file.orbit("free", std::string("GR1"));
    ASSERT_TRUE(grazing);
    auto rows = file.query("SELECT energy, period FROM branch_free WHERE label = 'GR1'");
    ASSERT_TRUE(rows.next());
    EXPECT_NEAR(rows.number(0), touched, 1e-12);
    for (const std::string run : {"free", "impacting"}) {
        auto all = file.query("SELECT min(energy), max(energy), min(stable) FROM branch_" + run);
        ASSERT_TRUE(all.next());
        EXPECT_NEAR(run == "free" ? all.number(0) : all.number(1), run == "free" ? 0.02 : 2, 1e-11) << run;
        EXPECT_EQ(all.number(2), 1) << run;
    }
    auto period = file.query("SELECT max(period), max(k) FROM branch_period");
    ASSERT_TRUE(period.next());
    EXPECT_NEAR(period.number(0), 6.1, 1e-10);
    EXPECT_EQ(period.number(1), 1);
    auto stiffer = file.query("SELECT min(energy), max(energy), max(k) FROM branch_stiffer");
    ASSERT_TRUE(stiffer.next());
    EXPECT_NEAR(stiffer.number(0), 0.1, 1e-11);
    EXPECT_NEAR(stiffer.number(1), 0.1, 1e-11);
    EXPECT_EQ(stiffer.number(2), 2);
    auto curve = file.query("SELECT energy, k FROM branch_grazing");
    int points = 0;
    for (; curve.next(); ++points)
        EXPECT_NEAR(curve.number(0), 0.245 * curve.number(1) + 0.25 * 0.49 * 0.49, 1e-10);
    EXPECT_GT(points, 3);
}

TEST_F(FamilyRun, SaysWhatCannotBeFollowed) {
    const auto problem = [&](const std::string& text) {
        std::string all;
        for (const RunReport& report : run(head + "[runs.a]\nkind = \"continue\"\nsignature = \"left\"\n" + text))
            all += report.problem;
        return all;
    };
    EXPECT_THAT(testing::message_of([&] { problem("along = { momentum = [0, 1] }"); }),
                HasSubstr("the model has no parameter 'momentum'"));
    EXPECT_THAT(testing::message_of([&] { problem("along = { energi = [0, 1] }"); }), HasSubstr("'energy'"));
    EXPECT_THAT(
        testing::message_of([&] { problem("along = { energy = [0, 1] }\nmonitors = { a = { conserved = \"b\" } }"); }),
        HasSubstr("the model has no conserved quantity 'b'"));
    EXPECT_THAT(problem("along = { energy = [1, 2] }"), HasSubstr("lies beyond its bound"));
    // A wrong declaration is followed neither along it nor held at its value: the motion conserves another energy.
    for (const std::string wrong : {"v^2/2 + k*x^2/3 + x^4/4", "v^2/2"}) {
        std::string model = spring;
        const std::string right = "v^2/2 + k*x^2/2 + x^4/4";
        folder_.write("model.toml", model.replace(model.find(right), right.size(), wrong));
        for (const std::string along : {"along = { energy = [0, 1] }", "along = { k = [0.5, 1] }"})
            EXPECT_THAT(problem(along), HasSubstr("'energy' is not conserved: in mode 'free' it changes at the rate"));
        EXPECT_EQ(problem("along = { period = [5, 7] }\ndirection = \"up\""), "");
    }
    for (const auto& [none, told] :
         {std::pair("3", "the same value at all states"), std::pair("k", "the same value at all states"),
          std::pair("sqrt(-1 - x^2)", "in mode 'free' it is not a number")}) {
        std::string model = spring;
        const std::string right = "v^2/2 + k*x^2/2 + x^4/4";
        folder_.write("model.toml", model.replace(model.find(right), right.size(), none));
        EXPECT_THAT(problem("along = { energy = [0, 1] }"), HasSubstr(told)) << none;
    }
    folder_.write("model.toml", spring);
    // Only `along` of branches and curves takes what is conserved, and once.
    for (const std::string text :
         {"along = { k = [0, 1] }\nfree = [\"energy\"]", "along = { k = [0, 1] }\nfree = [\"period\"]"})
        EXPECT_THAT(testing::message_of([&] { problem(text); }),
                    HasSubstr("is no parameter of the model; name a parameter"));
    EXPECT_THAT(testing::message_of([&] {
                    run(head + "[runs.a]\nkind = \"continue\"\nsignature = \"left\"\nalong = { energy = [0.01, 2] }\n"
                               "[runs.b]\nkind = \"ladder\"\nstart = { run = \"a\", point = \"GR1\" }\n"
                               "along = { energy = [0.01, 2] }\n");
                }),
                HasSubstr("'energy' is no parameter of the model; name a parameter"));
}

} // namespace graze::family_run_test
