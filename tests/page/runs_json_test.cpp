#include "page/runs_json.hpp"

#include "graze/study/run_summary.hpp"
#include "page/json_text.hpp"
#include "page/page_results.hpp"
#include "page/pictures_json.hpp"
#include "results/run_of_model.hpp"

#include <gmock/gmock.h>

namespace graze {
namespace {

class RunsJson : public testing::PageResults {};

nlohmann::json run_named(const nlohmann::json& runs, const std::string& name) {
    for (const nlohmann::json& run : runs)
        if (run["name"] == name)
            return run;
    return {};
}

TEST_F(RunsJson, SaysWhatTheFileSays) {
    const nlohmann::json runs = runs_json(file(), nullptr);
    ASSERT_EQ(runs.size(), file().runs().size());
    const nlohmann::json sweep = run_named(runs, "sweep"), chain = run_named(runs, "chain");
    EXPECT_EQ(sweep["kind"], "sweep");
    EXPECT_EQ(sweep["kind_words"], "attractors as a parameter changes");
    EXPECT_EQ(sweep["status"], "complete");
    EXPECT_EQ(sweep["points"], file().point_count("sweep"));
    EXPECT_EQ(sweep["directions"], nlohmann::json::parse(R"(["up", "down"])"));
    EXPECT_EQ(sweep["coordinates"][0]["name"], "omega");
    EXPECT_EQ(sweep["values"][0]["name"], "v");
    EXPECT_EQ(sweep["seeks_attractors"], true);
    EXPECT_EQ(sweep["is_branch"], false);
    EXPECT_EQ(chain["is_followed"], true);
    RunReport report;
    report.name = "chain";
    const auto ends = summary_of(report, file()).ends;
    ASSERT_EQ(chain["ends"].size(), ends.size());
    for (std::size_t i = 0; i < ends.size(); ++i) {
        EXPECT_EQ(chain["ends"][i][0], ends[i].first + " in omega");
        EXPECT_NE(chain["ends"][i][1].get<std::string>().find(ends[i].second), std::string::npos);
    }
    EXPECT_EQ(chain["ends"][1][1].get<std::string>().rfind("bound omega = ", 0), 0U) << chain["ends"];
    EXPECT_EQ(chain["labels"], nlohmann::json(summary_of(report, file()).labels));
    EXPECT_FALSE(chain["ends"].empty());
    EXPECT_EQ(chain["parts"].size(), 2U);
}

TEST_F(RunsJson, TellsWhichRunsOfAStudyAreMissing) {
    Study longer = study();
    longer.runs.push_back(longer.runs.front());
    longer.runs.back().name = "another";
    const nlohmann::json runs = runs_json(file(), &longer);
    EXPECT_EQ(runs.size(), longer.runs.size());
    const nlohmann::json another = run_named(runs, "another");
    EXPECT_EQ(another["status"], "missing");
    EXPECT_EQ(another["points"], 0);
    EXPECT_EQ(another["planned"], points_of(longer.runs.back()));
    EXPECT_EQ(another["revision"], "");
    longer.runs.clear();
    EXPECT_EQ(runs_json(file(), &longer).size(), file().runs().size());
}

TEST_F(RunsJson, SaysOfAnAtlasWhatItIs) {
    const Study study = parse_study("name = \"s\"\nmodel = \"impact-oscillator\"\n[runs.map]\nkind = \"atlas\"\n"
                                    "vary = { omega = [2.7, 2.8] }\n",
                                    "s.toml");
    const nlohmann::json map = run_named(runs_json(file(), &study), "map");
    EXPECT_EQ(map["kind"], "atlas");
    EXPECT_EQ(map["kind_words"], "an atlas of attractors and branches");
    EXPECT_EQ(map["seeks_attractors"], true);
    EXPECT_EQ(map["planned"], 4); // up and down
}

/// Files with a run whose texts somebody else has chosen.
class HostileRuns : public ::testing::Test {
protected:
    testing::TemporaryFolder folder_;
    const std::string path_ = folder_ / "results.sqlite";
    ResultFile file_{path_, ResultFile::Access::write};
    const Model model_ = load_model("impact-oscillator");
};

TEST_F(HostileRuns, HaveARevisionThatChangesWithTheirRows) {
    const RunRecord run = testing::run_of(model_, "motion", "simulate");
    file_.begin_run(run);
    const std::string empty = run_revision(file_, *file_.find_run("motion"));
    PointRecord point;
    point.coordinates = model_.parameter_values();
    point.result.state = model_.initial_state();
    file_.add_point("motion", point);
    file_.flush();
    const std::string with_point = run_revision(file_, *file_.find_run("motion"));
    EXPECT_NE(with_point, empty);
    EXPECT_EQ(run_revision(file_, *file_.find_run("motion")), with_point);
    file_.complete_run("motion");
    EXPECT_NE(run_revision(file_, *file_.find_run("motion")), with_point);
    EXPECT_EQ(runs_json(file_, nullptr)[0]["labels"], nlohmann::json::parse(R"([["unsettled", 1]])"));
}

TEST_F(HostileRuns, AreReadAgainOnlyAfterAChange) {
    file_.begin_run(testing::run_of(model_, "motion", "simulate"));
    file_.flush();
    RunsMemory memory;
    const nlohmann::json first = runs_json(file_, nullptr, &memory);
    EXPECT_EQ(first, runs_json(file_, nullptr));
    // Nobody changes a model that way: it shows that the rows were not read again.
    testing::change(path_, "UPDATE runs SET model = 'nothing'");
    EXPECT_EQ(runs_json(file_, nullptr, &memory), first);
    file_.complete_run("motion");
    EXPECT_NE(runs_json(file_, nullptr, &memory)[0]["failure"], "");
    EXPECT_NE(runs_json(file_, nullptr, &memory)[0]["failure"], ""); // an error may go away
}

TEST_F(HostileRuns, AreKeptAsAListWhereAllCouldBeRead) {
    file_.begin_run(testing::run_of(model_, "motion", "simulate"));
    file_.flush();
    const auto study = std::make_shared<const Study>(), other = std::make_shared<const Study>();
    RunsMemory memory;
    nlohmann::json list = runs_json(file_, nullptr, &memory);
    memory.keep_all("1", study, list);
    EXPECT_EQ(memory.find_all("1", study), list);
    EXPECT_TRUE(memory.find_all("2", study).is_null());
    EXPECT_TRUE(memory.find_all("1", other).is_null());
    testing::change(path_, "UPDATE runs SET model = 'nothing'");
    RunsMemory with_error;
    list = runs_json(file_, nullptr, &with_error);
    ASSERT_NE(list[0]["failure"], "");
    with_error.keep_all("1", study, list);
    EXPECT_TRUE(with_error.find_all("1", study).is_null()) << "an error may go away";
}

TEST_F(HostileRuns, HideNoOtherRunWhenTheirModelCannotBeRead) {
    file_.begin_run(testing::run_of(model_, "good", "simulate"));
    file_.begin_run(testing::run_of(model_, "bad", "simulate"));
    file_.flush();
    testing::change(path_, "UPDATE runs SET model = CAST(x'ff3c7363726970743e' AS TEXT) WHERE name = 'bad'");
    const nlohmann::json runs = runs_json(file_, nullptr);
    ASSERT_EQ(runs.size(), 2U);
    EXPECT_EQ(run_named(runs, "good")["failure"], "");
    EXPECT_NE(run_named(runs, "bad")["failure"], "");
    EXPECT_TRUE(nlohmann::json::accept(json_text(runs)));
}

TEST_F(RunsJson, NamesThePicturesOfAStudy) {
    const nlohmann::json pictures = pictures_json(study());
    ASSERT_EQ(pictures.size(), study().pictures.size());
    EXPECT_EQ(run_named(pictures, "portrait")["kind"], "portrait");
    EXPECT_EQ(run_named(pictures, "diagram")["runs"], nlohmann::json::parse(R"(["sweep"])"));
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        EXPECT_EQ(pictures[i]["x"], study().pictures[i].x);
        EXPECT_EQ(pictures[i]["y"], study().pictures[i].y);
    }
}

} // namespace
} // namespace graze
