#include "page/result_watch.hpp"

#include "base/temporary_folder.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/stored_study.hpp"
#include "page/study_job.hpp"
#include "results/run_of_model.hpp"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

namespace graze {
namespace {

/// What one listener is told.
class Heard {
public:
    explicit Heard(EventStream& events) : answer_(events.listen()) {}

    /// Waits until a text has been told.
    bool hears(const std::string& wanted) {
        const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (text_.find(wanted) == std::string::npos && std::chrono::steady_clock::now() < until)
            answer_.more(sink_);
        const bool found = text_.find(wanted) != std::string::npos;
        text_.clear();
        return found;
    }

private:
    HttpAnswer answer_;
    std::string text_;
    AnswerSink sink_{[this](std::string_view part) {
                         text_ += part;
                         return true;
                     },
                     [] { return true; }};
};

TEST(ResultWatch, TellsWhatOthersWrite) {
    const testing::TemporaryFolder folder;
    const std::string text = "name = \"a\"\nmodel = \"bouncing-ball\"\n"
                             "[runs.one]\nkind = \"simulate\"\nvary = { e = [0.5, 0.6, 0.7] }\ntime = 0.1\n";
    const std::string path = folder.write("a.toml", text);
    StudySession session(page_subject(path), folder / "out");
    EventStream events;
    Heard heard(events);
    const ResultWatch watch(session, events, std::chrono::milliseconds(5));
    // As another process does, which writes rows one after the other.
    std::filesystem::create_directories(folder / "out");
    ResultFile other(session.results_path(), ResultFile::Access::write);
    RunnerOptions options;
    std::size_t points = 0;
    options.interrupted = [&] { return points > 0; };
    options.progress = [&](const StudyProgress&) { ++points; };
    run_study(*session.study(), other, options);
    EXPECT_TRUE(heard.hears("\"status\":\"unfinished\""));
    EXPECT_EQ(session.results()->point_count("one"), 1U);
    options.interrupted = {};
    run_study(*session.study(), other, options);
    EXPECT_TRUE(heard.hears("\"status\":\"complete\""));
    other.remove_run("one");
    EXPECT_TRUE(heard.hears("event: runs\ndata: {\"runs\":[]}"));
    folder.write("a.toml", text + "# more\n");
    EXPECT_TRUE(heard.hears("event: study\ndata: {\"revision\":2}"));
}

TEST(ResultWatch, TellsThatOpenedResultsAreGoneOrCannotBeRead) {
    const testing::TemporaryFolder folder;
    const std::string path = folder.write("a.toml", "name = \"a\"\nmodel = \"bouncing-ball\"\n"
                                                    "[runs.one]\nkind = \"simulate\"\ntime = 0.1\n");
    {
        const StudySession computing(page_subject(path), folder / "out");
        compute_runs(computing, {"one"}, {[] { return false; }, [](const auto&...) {}}, 1);
    }
    StudySession session(page_subject(folder / "out"));
    const std::string results = session.results_path(), whole = testing::contents(results);
    EventStream events;
    Heard heard(events);
    const ResultWatch watch(session, events, std::chrono::milliseconds(5));
    EXPECT_TRUE(heard.hears("\"status\":\"complete\""));
    std::filesystem::rename(results, folder / "kept");
    EXPECT_TRUE(heard.hears("event: runs\ndata: {\"runs\":[]}"));
    folder.write("out/results.sqlite", std::string(9000, 'g'));
    EXPECT_TRUE(heard.hears("this is no result file of graze"));
    std::filesystem::rename(folder / "kept", results);
    EXPECT_TRUE(heard.hears("\"status\":\"complete\""));
    testing::change(results, "DROP TABLE points_one");
    EXPECT_TRUE(heard.hears("\"error\":{"));
    folder.write("other.sqlite", whole);
    std::filesystem::rename(folder / "other.sqlite", results);
    EXPECT_TRUE(heard.hears("\"status\":\"complete\"")) << "nothing is different from what was told first";
}

TEST(ResultWatch, EndsAtOnceWhereAFileHasAnEndlessQuery) {
    const testing::TemporaryFolder folder;
    const std::string path = folder.write("a.toml", "name = \"a\"\nmodel = \"bouncing-ball\"\n"
                                                    "[runs.one]\nkind = \"simulate\"\ntime = 0.1\n");
    StudySession session(page_subject(path), folder / "out");
    compute_runs(session, {"one"}, {[] { return false; }, [](const auto&...) {}}, 1);
    testing::change(session.results_path(),
                    "ALTER TABLE points_one RENAME TO stored; CREATE VIEW points_one AS WITH RECURSIVE c(n) AS "
                    "(SELECT 1 UNION ALL SELECT n + 1 FROM c) SELECT stored.* FROM stored, c WHERE n < 0");
    EventStream events;
    auto begun = std::chrono::steady_clock::now();
    {
        const ResultWatch watch(session, events, std::chrono::milliseconds(5));
        std::this_thread::sleep_for(std::chrono::milliseconds(300)); // it reads
        begun = std::chrono::steady_clock::now();
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(10)) << "a query may take 30 s";
}

TEST(ResultWatch, TellsThatAChangedModelMakesRunsOutdated) {
    const testing::TemporaryFolder folder;
    std::string model = page_subject("bouncing-ball").text;
    folder.write("ball.toml", model);
    const std::string path = folder.write("a.toml", "name = \"a\"\nmodel = \"ball.toml\"\n"
                                                    "[runs.one]\nkind = \"simulate\"\ntime = 0.1\n");
    StudySession session(page_subject(path), folder / "out");
    compute_runs(session, {"one"}, {[] { return false; }, [](const auto&...) {}}, 1);
    EventStream events;
    Heard heard(events);
    const ResultWatch watch(session, events, std::chrono::milliseconds(5));
    EXPECT_TRUE(heard.hears("\"status\":\"complete\""));
    model.replace(model.find("value = 9.81"), 12, "value = 9.8125");
    folder.write("ball.toml", model);
    EXPECT_TRUE(heard.hears("\"status\":\"outdated\""));
}

} // namespace
} // namespace graze
