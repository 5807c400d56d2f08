// What the interface answers about studies whose files other programs change.

#include "base/temporary_folder.hpp"
#include "page/page_client.hpp"
#include "page/page_subject.hpp"

#include <gtest/gtest.h>

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

} // namespace
} // namespace graze
