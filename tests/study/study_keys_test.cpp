#include "graze/study/study_keys.hpp"

#include "graze/results/name_advice.hpp"
#include "graze/study/study_schema.hpp"
#include "study/json.hpp"
#include "study/study_fixture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace graze::study_keys_test {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::Not;

std::string standard_of(RunKind kind, const std::string& name) {
    for (const StudyKey& key : study_keys(kind))
        if (key.name == name)
            return key.standard;
    return "there is no such key";
}

/// A run of a kind that varies parameters, with one more line.
std::string run_with(RunKind kind, const std::string& vary, const std::string& line) {
    return fmt::format("name = \"s\"\nmodel = \"impact-oscillator\"\n[runs.a]\nkind = \"{}\"\nvary = {}\n{}\n",
                       name_of(kind), vary, line);
}

std::string sweep_with(const std::string& line) {
    return run_with(RunKind::sweep, "{ omega = [2.7, 2.8] }", line);
}

TEST(StudyKeys, EachIsListedOnceWithAMeaning) {
    for (const std::string& name : kinds_of_runs()) {
        const RunKind kind = run_kind(name).value();
        std::set<std::string> names;
        for (const StudyKey& key : study_keys(kind)) {
            EXPECT_TRUE(names.insert(key.name).second) << name_of(kind) << " " << key.name;
            EXPECT_NE(key.meaning, "") << key.name;
            EXPECT_NE(key.type, "") << key.name;
        }
        EXPECT_TRUE(names.contains("kind"));
    }
}

TEST(StudyKeys, AreThoseOfTheKind) {
    EXPECT_THAT(study_keys(RunKind::sweep), Contains(Field(&StudyKey::name, "chaos_cycles")));
    EXPECT_THAT(study_keys(RunKind::orbit), Not(Contains(Field(&StudyKey::name, "chaos_cycles"))));
    EXPECT_THAT(study_keys(RunKind::ladder), Contains(Field(&StudyKey::name, "rungs")));
    EXPECT_THAT(study_keys(RunKind::identify), Not(Contains(Field(&StudyKey::name, "vary"))));
}

TEST(StudyKeys, TellTheirDefaults) {
    EXPECT_EQ(standard_of(RunKind::sweep, "cycles"), "150");
    EXPECT_EQ(standard_of(RunKind::sweep, "direction"), "up");
    EXPECT_EQ(standard_of(RunKind::follow, "direction"), "both");
    EXPECT_EQ(standard_of(RunKind::follow, "unphysical"), "false");
    EXPECT_EQ(standard_of(RunKind::sweep, "disturbance"), "1e-6");
    EXPECT_EQ(standard_of(RunKind::simulate, "time"), ""); // without end
    EXPECT_EQ(standard_of(RunKind::atlas, "direction"), "both");
    EXPECT_EQ(standard_of(RunKind::atlas, "branches"), "300");
    EXPECT_EQ(standard_of(RunKind::atlas, "draws"), "2");
    EXPECT_EQ(standard_of(RunKind::atlas, "minutes"), "");
}

TEST(StudyKeys, AreRefusedInRunsOfOtherKinds) {
    for (const StudyKey& key : study_keys(RunKind::record)) {
        const std::vector<StudyKey> of_sweeps = study_keys(RunKind::sweep);
        if (std::any_of(of_sweeps.begin(), of_sweeps.end(), [&](const auto& one) { return one.name == key.name; }))
            continue;
        const std::string refusal = testing::message_of([&] { parse_study(sweep_with(key.name + " = 1"), "s.toml"); });
        EXPECT_THAT(refusal, HasSubstr("runs of kind \"sweep\" have no `" + key.name + "`"));
    }
}

// What is listed is what the reader does: it takes the ends of each range, and nothing beyond.
void expect_ranges(RunKind kind, const std::string& vary, const std::set<std::string>& left_out) {
    for (const StudyKey& key : study_keys(kind)) {
        const auto takes = [&](const std::string& value) {
            const std::string text = run_with(kind, vary, key.name + " = " + value);
            return testing::message_of([&] { parse_study(text, "s.toml"); }).empty();
        };
        if (left_out.contains(key.name))
            continue;
        if (key.type == "whole number" && key.name != "order") { // whose range depends on its other options
            EXPECT_TRUE(takes(fmt::format("{:.0f}", *key.least))) << key.name;
            EXPECT_TRUE(takes(fmt::format("{:.0f}", *key.most))) << key.name;
            EXPECT_FALSE(takes(fmt::format("{:.0f}", *key.least - 1))) << key.name;
            EXPECT_FALSE(takes(fmt::format("{:.0f}", *key.most + 1))) << key.name;
        } else if (key.type == "number" && key.name != "tolerance") {
            EXPECT_EQ(takes(fmt::format("{}", *key.least)), key.includes_least) << key.name;
            EXPECT_FALSE(takes(fmt::format("{}", *key.least - 1e-3))) << key.name;
            if (key.most) {
                EXPECT_TRUE(takes(fmt::format("{}", *key.most))) << key.name;
                EXPECT_FALSE(takes(fmt::format("{}", *key.most * 1.001))) << key.name;
            }
        } else if (key.type == "one of") {
            for (const std::string& word : key.words)
                EXPECT_TRUE(takes('"' + word + '"')) << key.name;
            EXPECT_FALSE(takes("\"sideways\"")) << key.name;
        } else if (key.type == "true or false") {
            EXPECT_TRUE(takes("false")) << key.name;
            EXPECT_FALSE(takes("0")) << key.name;
        }
    }
}

TEST(StudyKeys, OfASweepAreTakenInTheirRangesAndRefusedBeyond) {
    const std::set<std::string> needs_others{"draws", "seed"};
    expect_ranges(RunKind::sweep, "{ omega = [2.7, 2.8] }", needs_others);
}

TEST(StudyKeys, OfAnAtlasAreTakenInTheirRangesAndRefusedBeyond) {
    const std::set<std::string> beyond_doubles{"seed"}; // the end of its range is no floating-point number
    expect_ranges(RunKind::atlas, "{ omega = [2.7, 2.8], e = [0.7, 0.8] }", beyond_doubles);
}

TEST(StudySchema, HasTheKeysOfEveryKind) {
    const Json schema = parse_json(study_schema(), Place{"schema", 0, 0});
    const Json* run = schema.find("properties")->find("runs")->find("additionalProperties");
    ASSERT_NE(run, nullptr);
    const std::vector<Json>& kinds = run->find("allOf")->items;
    ASSERT_EQ(kinds.size(), kinds_of_runs().size());
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
        EXPECT_EQ(kinds[kind].find("if")->find("properties")->find("kind")->find("const")->text, kinds_of_runs()[kind]);
        EXPECT_EQ(kinds[kind].find("then")->find("properties")->names,
                  names_of(study_keys(static_cast<RunKind>(kind))));
    }
}

} // namespace graze::study_keys_test
