#include "graze/study/stored_study.hpp"

#include "study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace graze::study_set_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

constexpr const char* text = R"(
name = "s"
model = "impact-oscillator"
set = { omega = 1.5, amplitude = "omega/3" }
[runs.a]
kind = "sweep"
vary = { amplitude = { from = "omega/10", to = "omega", points = 3 } }
[runs.b]
kind = "simulate"
set = { sigma = "2*omega", omega = 2 }
time = "2*pi/omega"
[runs.c]
kind = "simulate"
time = 1
)";

double value(const StudyRun& run, const std::string& name) {
    return run.model.parameter_values()[run.model.independent_parameter(name).place()];
}

TEST(StudySet, ExpressionsOfTheStudySeeTheValue) {
    const Study own = parse_study(text, "s.toml"), set = parse_study(text, "s.toml", {{"omega", 3}});
    EXPECT_EQ(value(own.runs[0], "omega"), 1.5);
    EXPECT_TRUE(own.set.empty());
    EXPECT_THAT(set.set, ElementsAre(Pair("omega", 3)));
    for (const StudyRun& run : set.runs)
        EXPECT_EQ(value(run, "omega"), 3) << run.name; // also where the run itself sets it
    EXPECT_EQ(value(set.runs[2], "amplitude"), 1);
    EXPECT_EQ(set.runs[0].motion().axes[0].values.front(), 0.3);
    EXPECT_EQ(set.runs[0].motion().axes[0].values.back(), 3);
    EXPECT_EQ(value(set.runs[1], "sigma"), 6);
    EXPECT_DOUBLE_EQ(set.runs[1].motion().transient.time, 2 * 3.14159265358979323846 / 3);
}

TEST(StudySet, GivesTheResultsOfAStudyWithThatValue) {
    std::string other = text;
    other.replace(other.find("omega = 1.5"), 11, "omega = 2.5");
    other.replace(other.find(", omega = 2 }"), 13, ", omega = 2.5 }");
    const Study set = parse_study(text, "s.toml", {{"omega", 2.5}}), changed = parse_study(other, "s.toml");
    ASSERT_EQ(set.runs.size(), changed.runs.size());
    for (std::size_t r = 0; r < set.runs.size(); ++r) {
        EXPECT_EQ(settings_of(set.runs[r]), settings_of(changed.runs[r]));
        EXPECT_EQ(set.runs[r].model.parameter_values(), changed.runs[r].model.parameter_values());
    }
}

TEST(StudySet, RefusesValuesThatChangeNothing) {
    const auto message = [](const ParameterValues& set) {
        return testing::message_of([&] { parse_study(text, "s.toml", set); });
    };
    EXPECT_THAT(message({{"omga", 1}}), HasSubstr("did you mean 'omega'?"));
    EXPECT_THAT(message({{"x", 1}}), HasSubstr("'x' is a state, not a parameter; change in the study"));
    const std::string one = std::string(text).substr(0, std::string(text).find("[runs.b]"));
    EXPECT_THROW(parse_study(one, "s.toml", {{"amplitude", 1}}), InputError);
    EXPECT_EQ(message({{"amplitude", 1}}), ""); // of use to the others
}

TEST(StudySet, IsStoredWithTheResults) {
    const testing::TemporaryFolder folder;
    {
        ResultFile file(folder / "r.sqlite", ResultFile::Access::write);
        EXPECT_FALSE(stored_set(file));
        run_study(parse_study(text, "s.toml", {{"omega", 2.5}, {"sigma", 0.25}}), file, {});
    }
    {
        const ResultFile file(folder / "r.sqlite", ResultFile::Access::read);
        EXPECT_THAT(stored_set(file).value(), ElementsAre(Pair("omega", 2.5), Pair("sigma", 0.25)));
        EXPECT_EQ(stored_study(file).set.size(), 2U);
    }
}

} // namespace graze::study_set_test
