#include "graze/page/page_file.hpp"

#include "base/message_of.hpp"
#include "base/temporary_folder.hpp"
#include "graze/study/runner.hpp"
#include "page/stored_page.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

namespace graze {
namespace {

using testing::message_of;

const char* const text = R"toml(name = "hostile"
text = "</script><script>alert(1)</script>"
model = "impact-oscillator"

[runs.rest]
kind = "orbit"
set = { omega = 4 }
from = { x = -0.07 }

[runs.free]
kind = "continue"
start = { run = "rest" }
along = { omega = [2.2, 4.5] }
direction = "down"
point_names = { GR1 = "</script><script>alert(2)</script>" }

[runs.impacting]
kind = "continue"
start = { run = "free", point = "GR1" }
along = { omega = [2.2, 4.5] }

[runs.sweep]
kind = "sweep"
vary = { omega = { from = 2.7, to = 2.9, points = 5 } }
cycles = 60

[pictures.both]
kind = "branch"
run = ["free", "impacting"]
title = "</script><script>alert(3)</script>"
)toml";

const ResultFile& results() {
    static const testing::TemporaryFolder folder;
    static const std::unique_ptr<ResultFile> file = [] {
        auto made = std::make_unique<ResultFile>(folder / "results.sqlite", ResultFile::Access::write);
        for (const RunReport& report : run_study(parse_study(text, "hostile.toml"), *made, {}))
            EXPECT_EQ(report.problem, "") << report.name;
        return made;
    }();
    return *file;
}

nlohmann::json page_of(const PageFileOptions& options) {
    return nlohmann::json::parse(stored_page(results(), options));
}

TEST(PageFile, HasAllThatThePageShows) {
    const nlohmann::json page = page_of({});
    EXPECT_EQ(page.at("session").at("stored"), true);
    EXPECT_EQ(page.at("session").at("can_compute"), false);
    EXPECT_EQ(page.at("session").at("title"), "hostile");
    EXPECT_EQ(page.at("runs").size(), 4U);
    EXPECT_EQ(page.at("pictures").at(0).at("name"), "both");
    EXPECT_EQ(page.at("models").at("free").at("name"), "impact-oscillator");
    EXPECT_FALSE(page.at("models").at("free").at("drawing").is_null());
    EXPECT_FALSE(page.at("special_points").at("free").empty());
    // The picture of the study, one for each run, one for all branches.
    std::vector<std::string> keys;
    for (const nlohmann::json& figure : page.at("figures"))
        keys.push_back(figure.at("key").dump());
    EXPECT_EQ(keys, (std::vector<std::string>{"\"both\"", R"({"runs":["rest"]})", R"({"runs":["free"]})",
                                              R"({"runs":["impacting"]})", R"({"runs":["sweep"]})",
                                              R"({"runs":["free","impacting"]})"}));
    // Every orbit of these short branches, with its motion.
    const std::size_t orbits = results().point_count("free") + results().point_count("impacting");
    EXPECT_EQ(page.at("points").size(), orbits + 1 + results().point_count("sweep"));
    for (const auto& [key, point] : page.at("points").items())
        EXPECT_TRUE(key.starts_with("sweep") || page.at("motions").contains(key)) << key;
}

TEST(PageFile, MotionsAreWhatTheDrawingNeeds) {
    const nlohmann::json page = page_of({.runs = {"impacting"}});
    const nlohmann::json& motion = page.at("motions").begin().value();
    std::vector<std::string> names;
    for (const nlohmann::json& column : motion.at("columns"))
        names.push_back(column.at("name"));
    for (const char* name : {"t", "x", "theta", "gap", "x - 0.3", "sigma - 3.6"})
        EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
    EXPECT_EQ(motion.at("values").size(), names.size());
    const std::size_t rows = motion.at("values").at(0).size();
    EXPECT_LT(rows, 450U);
    EXPECT_GT(rows, 100U);
    for (const nlohmann::json& row : motion.at("contacts"))
        EXPECT_LT(row.get<std::size_t>(), rows);
}

TEST(PageFile, HasFewerPointsWhereRoomIsShort) {
    const std::size_t whole = stored_page(results(), {}).size();
    const PageFileOptions options{.most_bytes = whole / 2};
    const std::string half = stored_page(results(), options);
    EXPECT_LE(half.size(), whole / 2 + 1000);
    const nlohmann::json page = nlohmann::json::parse(half);
    EXPECT_EQ(page.at("figures").size(), 6U);
    // Special points come first; the others are spread over the branch.
    for (const OrbitRecord& orbit : results().orbits("free", true))
        EXPECT_TRUE(page.at("points").contains("free/" + std::to_string(orbit.number))) << orbit.label;
    EXPECT_EQ(nlohmann::json::parse(stored_page(results(), {.most_bytes = 1})).at("points").size(), 0U);
}

TEST(PageFile, IsTheSameForTheSameResults) {
    EXPECT_EQ(stored_page(results(), {}), stored_page(results(), {}));
}

TEST(PageFile, NothingInTheResultsEndsTheScript) {
    const std::string data = stored_page(results(), {});
    EXPECT_EQ(data.find('<'), std::string::npos);
    EXPECT_NE(data.find("alert(2)"), std::string::npos);
    const std::string page = page_with("<html><head><script>run()</script></head></html>", data);
    EXPECT_EQ(page.find("<script type=\"application/json\" id=\"stored\">"), page.find("<script"));
    const std::string filled = page_with(
        "<body><script type=\"application/json\" id=\"stored\">null</script><script nonce=\"@nonce@\">run()</script>",
        "[1]");
    EXPECT_EQ(filled, "<body><script type=\"application/json\" id=\"stored\">[1]</script><script>run()</script>");
}

TEST(PageFile, OnlyChosenRunsAndPictures) {
    StudyPicture picture;
    picture.name = "asked";
    picture.kind = "branch";
    picture.runs = {"free"};
    picture.y = {"period"};
    const nlohmann::json page = page_of({.title = "one branch", .runs = {"free"}, .pictures = {picture}});
    EXPECT_EQ(page.at("runs").size(), 1U);
    EXPECT_EQ(page.at("session").at("title"), "one branch");
    EXPECT_EQ(page.at("pictures").size(), 1U); // that of the study shows another run too
    EXPECT_EQ(page.at("figures").at(0).at("key"), "asked");
    EXPECT_EQ(message_of([] { stored_page(results(), {.runs = {"fre"}}); }),
              "there is no run 'fre' in the results; did you mean 'free'?");
    picture.y = {"nothing"};
    EXPECT_NE(message_of([&] { stored_page(results(), {.pictures = {picture}}); }), "");
}

} // namespace
} // namespace graze
