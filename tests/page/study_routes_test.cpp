// What the interface answers about studies whose files other programs change.

#include "base/temporary_folder.hpp"
#include "graze/study/stored_study.hpp"
#include "page/page_client.hpp"
#include "page/page_subject.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace graze {
namespace {

using testing::Answered;
using testing::EventClient;
using testing::PageClient;

class ServedModelFile : public ::testing::Test {
protected:
    ServedModelFile() {
        folder_.write("ball.toml", model_);
        PageOptions options;
        options.opened = folder_.write("short.toml", text_);
        options.folder = folder_ / "out";
        server_ = std::make_unique<PageServer>(options);
        server_->start();
        page_ = std::make_unique<PageClient>(*server_);
    }
    void compute() const {
        EventClient events(*page_);
        ASSERT_EQ(page_->post("/api/jobs", {{"runs", {"one"}}}).status, 200);
        EXPECT_FALSE(events.wait_for_job("complete").is_null());
    }
    std::string status() const { return page_->get("/api/runs").json[0]["status"]; }

    testing::TemporaryFolder folder_;
    const std::string model_ = page_subject("bouncing-ball").text;
    const std::string text_ =
        "name = \"short\"\nmodel = \"ball.toml\"\n\n[runs.one]\nkind = \"simulate\"\ntime = 0.2\n";
    std::unique_ptr<PageServer> server_;
    std::unique_ptr<PageClient> page_;
};

TEST_F(ServedModelFile, ComputesAnewWhatAChangedModelMakesOutdated) {
    compute();
    EXPECT_EQ(status(), "complete");
    EventClient events(*page_);
    std::string other = model_;
    other.replace(other.find("value = 9.81"), 12, "value = 9.8125");
    folder_.write("ball.toml", other);
    EXPECT_FALSE(events.wait_for("study", [](const auto&) { return true; }).is_null());
    EXPECT_EQ(status(), "outdated");
    compute();
    EXPECT_EQ(status(), "complete");
    EXPECT_NE(page_->get("/api/model?run=one").text.find("9.8125"), std::string::npos);
}

TEST_F(ServedModelFile, TellsMistakesOfTheModelWithItsFile) {
    folder_.write("ball.toml", model_ + "\n[unknown]\n");
    const Answered job = page_->post("/api/jobs", {{"runs", {"one"}}});
    EXPECT_EQ(job.status, 400) << "a change of a moment ago counts";
    EXPECT_TRUE(job.json["error"]["place"]["file"].get<std::string>().ends_with("ball.toml")) << job.text;
    for (const Answered& answer :
         {page_->get("/api/study"), page_->post("/api/check", {{"kind", "study"}, {"text", text_}})}) {
        ASSERT_EQ(answer.json["errors"].size(), 1U) << answer.text;
        EXPECT_TRUE(answer.json["errors"][0]["file"].get<std::string>().ends_with("ball.toml")) << answer.text;
    }
}

TEST_F(ServedModelFile, TellsMistakesOfATextWithoutAFile) {
    for (const char* kind : {"study", "model"}) {
        const Answered checked = page_->post("/api/check", {{"kind", kind}, {"text", "name = \n"}});
        ASSERT_EQ(checked.json["errors"].size(), 1U) << checked.text;
        EXPECT_EQ(checked.json["errors"][0]["file"], "");
    }
}

TEST_F(ServedModelFile, TellsMistakesOfAStudyWithoutWordsOfModels) {
    const Answered checked = page_->post("/api/check", {{"kind", "study"}, {"text", "name = \"x\"\n[[[\n"}});
    ASSERT_EQ(checked.json["errors"].size(), 1U) << checked.text;
    EXPECT_EQ(checked.text.find("states"), std::string::npos) << checked.text;
}

TEST_F(ServedModelFile, RemovesARunThatNothingNeeds) {
    compute();
    EventClient events(*page_);
    ASSERT_EQ(page_->post("/api/jobs", {{"text", "[runs.two]\nkind = \"simulate\"\ntime = 0.1\n"}}).status, 200);
    EXPECT_EQ(page_->ask("DELETE", "/api/runs/two").status, 409) << "a job may run";
    EXPECT_FALSE(events.wait_for_job("complete").is_null());
    for (int i = 0; i < 100 && page_->get("/api/jobs").json.back()["state"] != "complete"; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_EQ(page_->ask("DELETE", "/api/runs/none").status, 400);
    EXPECT_EQ(page_->ask("DELETE", "/api/runs/").status, 404);
    EXPECT_EQ(page_->ask("DELETE", "/api/runs/two/x").status, 404);
    EXPECT_EQ(page_->ask("DELETE", "/api/runs/two").json["removed"], "two");
    const nlohmann::json runs = page_->get("/api/runs").json;
    EXPECT_EQ(runs[0]["status"], "complete");
    EXPECT_EQ(runs[1]["status"], "missing") << "the text of the study still has it";
    EXPECT_EQ(stored_study(ResultFile(folder_ / "out/results.sqlite", ResultFile::Access::read)).find_run("two"),
              nullptr);
}

TEST(ServedOrbit, IsNotRemovedWhereABranchBeginsFromIt) {
    const testing::TemporaryFolder folder;
    PageOptions options;
    options.opened = folder.write("s.toml", R"(name = "s"
model = "impact-oscillator"
[runs.orbit]
kind = "orbit"
[runs.branch]
kind = "continue"
start = { run = "orbit" }
along = { omega = [2.8, 2.9] }
)");
    options.folder = folder / "out";
    PageServer server(options);
    server.start();
    const PageClient page(server);
    EventClient events(page);
    ASSERT_EQ(page.post("/api/jobs", {{"runs", {"orbit"}}}).status, 200);
    const nlohmann::json ended = events.wait_for(
        "job", [](const nlohmann::json& job) { return job["state"] == "complete" || job["state"] == "failed"; });
    ASSERT_EQ(ended["state"], "complete") << ended;
    const Answered refused = page.ask("DELETE", "/api/runs/orbit");
    EXPECT_EQ(refused.status, 409);
    EXPECT_EQ(refused.problem(), "run 'branch' needs run 'orbit'");
}

/// A model in a file is opened itself.
class OpenedModelFile : public ::testing::Test {
protected:
    OpenedModelFile() {
        PageOptions options;
        options.opened = path_;
        options.folder = folder_ / "out";
        server_ = std::make_unique<PageServer>(options);
        server_->start();
        page_ = std::make_unique<PageClient>(*server_);
    }
    Answered save(const std::string& text, std::size_t revision, bool replace = false) const {
        return page_->put("/api/model", {{"text", text}, {"revision", revision}, {"replace", replace}});
    }
    std::string other(const std::string& value) const {
        std::string text = model_;
        return text.replace(text.find("value = 9.81"), 12, "value = " + value);
    }
    double gravity() const {
        const nlohmann::json model = page_->get("/api/model").json;
        for (const nlohmann::json& one : model["parameters"])
            if (one["name"] == "g")
                return one["value"];
        return 0;
    }

    testing::TemporaryFolder folder_;
    const std::string model_ = page_subject("bouncing-ball").text;
    const std::string path_ = folder_.write("ball.toml", model_);
    std::unique_ptr<PageServer> server_;
    std::unique_ptr<PageClient> page_;
};

TEST_F(OpenedModelFile, IsSavedAndMakesItsRunsOutdated) {
    const nlohmann::json model = page_->get("/api/model").json;
    EXPECT_EQ(model["file"], "ball.toml");
    EXPECT_EQ(model["text"], model_);
    EventClient events(*page_);
    ASSERT_EQ(page_->post("/api/jobs", {{"text", "[runs.fall]\nkind = \"simulate\"\ntime = 0.2\n"}}).status, 200);
    EXPECT_FALSE(events.wait_for_job("complete").is_null());
    const Answered saved = save(other("9.75"), model["revision"]);
    ASSERT_EQ(saved.status, 200) << saved.text;
    EXPECT_EQ(testing::contents(path_), other("9.75"));
    EXPECT_EQ(gravity(), 9.75);
    EXPECT_EQ(page_->get("/api/runs").json[0]["status"], "outdated");
    EXPECT_EQ(save(model_, model["revision"]).status, 409) << "of an older text";
    EXPECT_EQ(save(model_, saved.json["revision"]).status, 200);
}

TEST_F(OpenedModelFile, IsNotSavedOverChangesOfOthersNorWithMistakes) {
    EXPECT_EQ(save(model_ + "[unknown]\n", 1).status, 400);
    folder_.write("ball.toml", other("9.6"));
    EXPECT_EQ(save(other("9.75"), 1).status, 409);
    EXPECT_EQ(testing::contents(path_), other("9.6"));
    EXPECT_EQ(page_->get("/api/model").json["text"], other("9.6")) << "the page takes it over";
    EXPECT_EQ(save(other("9.75"), 1, true).status, 200);
    EXPECT_EQ(testing::contents(path_), other("9.75"));
}

TEST_F(OpenedModelFile, IsDescribedByATextThatNoFileHas) {
    const Answered described = page_->post("/api/model", {{"text", other("1.5")}});
    ASSERT_EQ(described.status, 200) << described.text;
    EXPECT_EQ(described.json["text"], other("1.5"));
    EXPECT_FALSE(described.json.contains("file"));
    EXPECT_EQ(gravity(), 9.81);
    EXPECT_EQ(page_->post("/api/model", {{"text", "nonsense"}}).status, 400);
}

TEST(ShippedModel, HasNoFileToSave) {
    PageOptions options;
    options.opened = "bouncing-ball";
    const testing::TemporaryFolder folder;
    options.folder = folder.path();
    PageServer server(options);
    server.start();
    const PageClient page(server);
    EXPECT_FALSE(page.get("/api/model").json.contains("file"));
    EXPECT_EQ(page.put("/api/model", {{"text", page_subject("bouncing-ball").text}, {"revision", 1}}).status, 400);
}

} // namespace
} // namespace graze
