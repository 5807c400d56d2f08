#include "graze/page/page_server.hpp"

#include "base/temporary_folder.hpp"
#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "page/page_client.hpp"
#include "page/page_html.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace graze {
namespace {

using testing::Answered;
using testing::EventClient;
using testing::PageClient;
using testing::raw_answer;
using testing::status_of;

constexpr const char* short_study = R"(name = "short"
model = "impact-oscillator"

[runs.one]
kind = "simulate"
set = { omega = 2.8 }
periods = 2
values = ["x", "v"]
)";

std::string runs_to(const std::string& name, const std::string& keys) {
    return "[runs." + name + "]\n" + keys + "\n";
}

/// A server of a study in a folder of its own.
class ServedStudy : public ::testing::Test {
protected:
    void SetUp() override {
        std::ofstream(folder_ / "short.toml") << short_study;
        PageOptions options;
        options.opened = folder_ / "short.toml";
        options.folder = folder_ / "out";
        options.work = work_;
        server_ = std::make_unique<PageServer>(options);
        server_->start();
        client_ = std::make_unique<PageClient>(*server_);
    }
    const PageClient& page() const { return *client_; }

    /// A picture of the study's run whose query does not end.
    static nlohmann::json endless_picture() {
        return {{"picture",
                 {{"runs", {"one"}},
                  {"kind", "scatter"},
                  {"x", "time"},
                  {"y", {"(WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c) SELECT max(n) FROM c)"}}}}};
    }
    void compute() const {
        EventClient events(page());
        ASSERT_EQ(page().post("/api/jobs", {{"runs", {"one"}}}).status, 200);
        EXPECT_FALSE(events.wait_for_job("complete").is_null());
    }
    /// Sends a request without waiting for its answer.
    void begin(const testing::RawClient& client, const std::string& path, const nlohmann::json& body) const {
        const std::string text = body.dump();
        client.send(page().head("POST", path) + "Content-Type: application/json\r\nContent-Length: " +
                    std::to_string(text.size()) + "\r\n\r\n" + text);
    }

    std::chrono::milliseconds work_ = std::chrono::seconds(30);
    testing::TemporaryFolder folder_;
    std::unique_ptr<PageServer> server_;
    std::unique_ptr<PageClient> client_;
};

class HastyServer : public ServedStudy {
protected:
    HastyServer() { work_ = std::chrono::milliseconds(500); }
};

TEST_F(HastyServer, SaysThatAQueryTakesTooLong) {
    compute();
    const Answered late = page().post("/api/figure", endless_picture());
    EXPECT_EQ(late.status, 400);
    EXPECT_EQ(late.problem(), "the answer takes more than 0.5 seconds of work");
}

std::size_t threads_of_this_process() {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return static_cast<std::size_t>(std::distance(begin(tasks), end(tasks)));
}

TEST_F(ServedStudy, EndsTheQueryOfAClientThatLeaves) {
    compute();
    const std::size_t before = threads_of_this_process();
    const auto wait_for = [](const auto& holds) {
        for (int i = 0; i < 2000 && !holds(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return holds();
    };
    {
        const testing::RawClient client(server_->port());
        begin(client, "/api/figure", endless_picture());
        ASSERT_TRUE(wait_for([&] { return threads_of_this_process() > before; }));
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        EXPECT_GT(threads_of_this_process(), before);
    }
    EXPECT_TRUE(wait_for([&] { return threads_of_this_process() <= before; })) << "the query takes 30 s";
}

TEST_F(ServedStudy, SaysThatItEndsToThoseWhoWait) {
    compute();
    testing::RawClient client(server_->port());
    begin(client, "/api/figure", endless_picture());
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    server_->stop();
    const std::string answer = client.read_all();
    EXPECT_EQ(status_of(answer), 503) << answer;
    EXPECT_NE(answer.find("the server ends"), std::string::npos) << answer;
}

TEST_F(ServedStudy, RefusesAPartOfAnAddressThatIsGivenTwice) {
    EXPECT_EQ(page().get("/api/model?run=one&run=two").problem(), "the address has 'run' twice");
}

TEST_F(ServedStudy, TellsWhatIsOpened) {
    const Answered session = page().get("/api/session");
    ASSERT_EQ(session.status, 200) << session.text;
    EXPECT_EQ(session.json["opened"]["kind"], "study");
    EXPECT_EQ(session.json["title"], "short");
    EXPECT_EQ(session.json["can_compute"], true);
    EXPECT_TRUE(session.json["results"].is_null());
    const Answered runs = page().get("/api/runs");
    ASSERT_EQ(runs.json.size(), 1U) << runs.text;
    EXPECT_EQ(runs.json[0]["status"], "missing");
    EXPECT_EQ(page().get("/api/pictures").json, nlohmann::json::array());
    EXPECT_EQ(page().post("/api/figure", {{"picture", {{"runs", {"one"}}}}}).problem(),
              "nothing has been computed yet");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << "looking writes nothing";
}

TEST_F(ServedStudy, RefusesEveryoneElse) {
    const std::string port = std::to_string(server_->port()), token = server_->token();
    const auto status = [&](const std::string& request) {
        return status_of(raw_answer(server_->port(), request + "\r\n"));
    };
    const std::string host = "Host: 127.0.0.1:" + port + "\r\n", bearer = "Authorization: Bearer " + token + "\r\n";
    const std::string session = "GET /api/session HTTP/1.1\r\n";
    EXPECT_EQ(status(session + host + bearer), 200);
    EXPECT_EQ(status(session + "Host: localhost:" + port + "\r\nOrigin: http://localhost:" + port + "\r\n" + bearer),
              200);
    EXPECT_EQ(status(session + host), 401);
    EXPECT_EQ(status(session + host + "Authorization: Bearer 0" + token.substr(1) + "x\r\n"), 401);
    EXPECT_EQ(status(session + host + bearer + bearer), 401);
    EXPECT_EQ(status("GET /api/session?token=" + token + " HTTP/1.1\r\n" + host), 401);
    EXPECT_EQ(status(session + bearer), 403);
    EXPECT_EQ(status(session + "Host: evil.example\r\n" + bearer), 403);
    EXPECT_EQ(status(session + host + bearer + "Origin: http://evil.example\r\n"), 403);
    EXPECT_EQ(status(session + host + bearer + "Origin: null\r\n"), 403);
    EXPECT_EQ(status(session + host + bearer + "Origin: http://127.0.0.1:" + port +
                     "\r\nOrigin: http://127.0.0.1:" + port + "\r\n"),
              403);
    // The page has no data, and takes the token out of its address: it is loaded again without.
    EXPECT_EQ(status("GET / HTTP/1.1\r\n" + host), has_page() ? 200 : 404);
    EXPECT_EQ(status("GET / HTTP/1.1\r\n" + host + "Origin: http://evil.example\r\n"), 403);
    EXPECT_EQ(status("GET /?token=00 HTTP/1.1\r\n" + host), 401);
    EXPECT_EQ(status("GET /?token=" + token + " HTTP/1.1\r\nHost: evil.example\r\n"), 403);
}

TEST_F(ServedStudy, GivesThePageToWhoKnowsTheToken) {
    const std::string answer =
        raw_answer(server_->port(), "GET /?token=" + server_->token() +
                                        " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server_->port()) + "\r\n\r\n");
    EXPECT_EQ(status_of(answer), has_page() ? 200 : 404);
    EXPECT_NE(answer.find("X-Content-Type-Options: nosniff\r\n"), std::string::npos);
    EXPECT_NE(answer.find("Referrer-Policy: no-referrer\r\n"), std::string::npos);
    EXPECT_NE(answer.find("Cache-Control: no-store\r\n"), std::string::npos);
    if (has_page()) {
        EXPECT_NE(answer.find("Content-Security-Policy: default-src 'none'; script-src 'sha256-"), std::string::npos);
        EXPECT_NE(answer.find("; frame-ancestors 'none'\r\n"), std::string::npos);
    }
    EXPECT_EQ(server_->address(),
              "http://127.0.0.1:" + std::to_string(server_->port()) + "/?token=" + server_->token());
}

TEST_F(ServedStudy, HasNoOtherAddresses) {
    for (const char* path :
         {"/api/", "/api", "/api/nothing", "/api/session/", "/api/jobs/", "/api/jobs/x", "/api/jobs/-1",
          "/api/jobs/1/2", "/api/jobs/9999999999", "/session", "/favicon.ico", "/../../etc/passwd",
          "/api/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/api/session%00", "//", "/api/session;x"})
        EXPECT_EQ(page().get(path).status, 404) << path;
    const Answered wrong = page().ask("DELETE", "/api/study");
    EXPECT_EQ(wrong.status, 405);
    EXPECT_NE(wrong.text.find("Allow: GET, PUT\r\n"), std::string::npos) << wrong.text;
    for (const char* method : {"HEAD", "OPTIONS", "PATCH", "TRACE", "CONNECT"})
        EXPECT_EQ(page().ask(method, "/api/session").status, 405) << method;
}

TEST_F(ServedStudy, ExplainsWrongRequests) {
    EXPECT_EQ(page().send("POST", "/api/figure", "{").status, 400);
    EXPECT_EQ(page().send("POST", "/api/figure", "[]").status, 400);
    EXPECT_EQ(page().send("POST", "/api/figure", std::string(100'000, '[')).status, 400);
    EXPECT_EQ(page().send("POST", "/api/check", "{\"kind\": \"study\", \"text\": \"\xff\"}").status, 400);
    EXPECT_EQ(page().get("/api/points").problem(), "the address has no 'run'");
    EXPECT_EQ(page().get("/api/model").status, 400);
    EXPECT_EQ(page().get("/api/table?run=one&samples=x").problem(), "'samples' of the address is neither 0 nor 1");
    EXPECT_EQ(page().get("/api/runs?run=one").problem(), "the request has an unknown part of the address 'run'");
    EXPECT_EQ(page().post("/api/jobs", {{"runs", {"one"}}, {"run", "one"}}).problem(),
              "the request has an unknown member 'run'");
    EXPECT_EQ(page().post("/api/trip", {{"run", "one"}, {"number", 0}, {"options", {{"nonsense", 1}}}}).problem(),
              "the request has an unknown member 'nonsense'");
    EXPECT_EQ(page().post("/api/simulate", {{"run", 1}, {"text", "x"}}).problem(), "'run' of the request is no text");
    EXPECT_EQ(page().post("/api/simulate", {{"run", "one"}, {"text", "x"}}).problem(),
              "the request has both a run and the text of a model");
    EXPECT_EQ(page().get("/api/model?run=no").problem(), "there is no run 'no'");
    EXPECT_EQ(page().post("/api/jobs", nlohmann::json::object()).status, 400);
    EXPECT_EQ(page().post("/api/jobs", {{"runs", {"no"}}}).problem(), "the study has no run 'no'");
    EXPECT_EQ(page().ask("DELETE", "/api/jobs/7").status, 404);
    const Answered check =
        page().post("/api/check", {{"kind", "study"}, {"text", "name = \"a\"\n[runs.b]\nkind = \"x\"\n"}});
    ASSERT_EQ(check.status, 200) << check.text;
    ASSERT_GE(check.json["errors"].size(), 1U);
    EXPECT_GE(check.json["errors"][0]["line"], 2);
    EXPECT_EQ(page().post("/api/check", {{"kind", "model"}, {"text", "x"}}).json["errors"].size(), 1U);
    EXPECT_EQ(page().get("/api/session").status, 200);
}

TEST_F(ServedStudy, ComputesARunAndTellsOfIt) {
    EventClient events(page());
    const Answered job = page().post("/api/jobs", {{"runs", {"one"}}});
    ASSERT_EQ(job.status, 200) << job.text;
    EXPECT_EQ(job.json["runs"], nlohmann::json({"one"}));
    EXPECT_EQ(events.wait_for_job("complete")["id"], job.json["id"]);
    // It may have been told of before the end of the job.
    const auto is_complete = [](const nlohmann::json& all) {
        return !all.is_null() && !all["runs"].empty() && all["runs"][0]["status"] == "complete";
    };
    nlohmann::json told = events.passed("runs");
    if (!is_complete(told))
        told = events.wait_for("runs", is_complete);
    ASSERT_FALSE(told.is_null());
    EXPECT_EQ(told["runs"][0]["name"], "one");
    const Answered runs = page().get("/api/runs");
    EXPECT_EQ(runs.json[0]["status"], "complete");
    EXPECT_EQ(runs.json[0]["revision"], told["runs"][0]["revision"]);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out/results.sqlite"));
    EXPECT_EQ(page().post("/api/figure", {{"picture", {{"runs", {"one"}}}}}).json["figure"]["panels"].size(), 2U);
    EXPECT_EQ(
        page()
            .post("/api/figure", {{"picture", {{"runs", {"one"}}, {"kind", "portrait"}, {"x", "x"}, {"y", {"v"}}}}})
            .json["figure"]["panels"][0]["x"]["label"],
        "x");
    const Answered point = page().get("/api/point?run=one&number=0");
    EXPECT_EQ(point.json["kind"], "motion") << point.text;
    EXPECT_GT(point.json["actions"].size(), 0U);
    EXPECT_EQ(page().get("/api/point?run=one&number=x").status, 400);
    const Answered table = page().get("/api/table?run=one&samples=1");
    EXPECT_NE(table.text.find("Content-Type: text/csv"), std::string::npos);
    EXPECT_EQ(page().get("/api/model?run=one").json["name"], "impact-oscillator");
    EXPECT_EQ(page().get("/api/jobs").json[0]["state"], "complete");
}

TEST_F(ServedStudy, TellsWhenItsResultsAreNoFile) {
    EXPECT_EQ(page().get("/api/runs").json[0]["status"], "missing");
    std::filesystem::create_directories(folder_ / "out");
    std::filesystem::create_symlink("/dev/zero", folder_ / "out/results.sqlite");
    const Answered refused = page().get("/api/runs");
    EXPECT_EQ(refused.status, 400);
    EXPECT_NE(refused.text.find("results.sqlite"), std::string::npos) << refused.text;
}

TEST_F(ServedStudy, AddsRunsToTheStudyAndKeepsItsFile) {
    EventClient events(page());
    const std::string more = runs_to("two", "kind = \"simulate\"\nperiods = 1\nvalues = [\"x\"]");
    const Answered wrong = page().post("/api/jobs", {{"text", runs_to("two", "kind = \"simulate\"\nperiod = 1")}});
    EXPECT_EQ(wrong.status, 400);
    EXPECT_EQ(page().post("/api/jobs", {{"text", "# nothing"}}).problem(), "the text adds no run to the study");
    EXPECT_EQ(page().get("/api/study").json["revision"], 1);
    const Answered job = page().post("/api/jobs", {{"text", more}});
    ASSERT_EQ(job.status, 200) << job.text;
    EXPECT_EQ(job.json["runs"], nlohmann::json({"two"}));
    EXPECT_EQ(events.wait_for("study", [](const auto&) { return true; })["revision"], 2);
    EXPECT_FALSE(events.wait_for_job("complete").is_null());
    const Answered study = page().get("/api/study");
    EXPECT_EQ(study.json["text"], std::string(short_study) + "\n" + more);
    EXPECT_EQ(study.json["saved"], false);
    EXPECT_EQ(study.json["name"], "short.toml");
    const Answered saved = page().put("/api/study", {{"text", study.json["text"]}, {"revision", 2}, {"save", true}});
    ASSERT_EQ(saved.status, 200) << saved.text;
    EXPECT_EQ(saved.json["saved"], true);
    EXPECT_EQ(saved.json["revision"], 2);
    EXPECT_EQ(page().put("/api/study", {{"text", "x"}, {"revision", 1}}).status, 409);
    EXPECT_EQ(page().post("/api/jobs", {{"text", more}}).status, 400) << "the run is there already";
}

TEST_F(ServedStudy, DrawsOneValueOfEachPoint) {
    compute();
    const auto refusal = [&](const std::string& y) {
        return page()
            .post("/api/figure", {{"picture", {{"runs", {"one"}}, {"kind", "scatter"}, {"x", "time"}, {"y", {y}}}}})
            .problem();
    };
    EXPECT_EQ(refusal("abs(time)"), "");
    EXPECT_EQ(refusal("max(time, 0)"), "");
    EXPECT_EQ(refusal("(SELECT max(number) FROM points_one)"), "");
    EXPECT_EQ(refusal("sum(time) OVER ()"), "");
    for (const std::string aggregate :
         {"sum(time)", "count(*)", "1 + MAX (time)", "total(time) FILTER (WHERE time > 0)"})
        EXPECT_EQ(refusal(aggregate), "'" + aggregate + "' makes one value of all points");
    for (const std::string parameter : {"?1", ":v", "@v", "$v"})
        EXPECT_EQ(refusal(parameter), "'" + parameter + "' has a value that is not given");
    EXPECT_EQ(refusal(" "), "' ' is no expression");
    EXPECT_EQ(refusal("time, number"), "'time, number' is more than one expression");
}

TEST_F(ServedStudy, RefusesKeysOutsideOfTables) {
    const nlohmann::json job{{"text", "\n# a comment\nruns.two = { kind = \"simulate\", time = 1 }\n"}};
    EXPECT_EQ(page().post("/api/jobs", job).problem(), "the text begins with a key outside of tables");
}

TEST_F(ServedStudy, TellsThatItsFileIsGone) {
    EXPECT_EQ(page().get("/api/study").json["saved"], true);
    std::filesystem::rename(folder_ / "short.toml", folder_ / "kept");
    EXPECT_EQ(page().get("/api/study").json["saved"], false);
    std::filesystem::rename(folder_ / "kept", folder_ / "short.toml");
    EXPECT_EQ(page().get("/api/study").json["saved"], true);
}

TEST_F(ServedStudy, SaysWhereTheKindOfAProposedRunComesFrom) {
    const Answered refused =
        page().post("/api/propose", {{"run", "one"}, {"action", "sweep"}, {"options", {{"kind", "basin"}}}});
    EXPECT_EQ(refused.problem(), "'sweep' makes a run of kind sweep: the action decides the kind");
}

TEST_F(ServedStudy, StopsAJobAndGoesOn) {
    EventClient events(page());
    const Answered job = page().post(
        "/api/jobs",
        {{"text", runs_to("long", "kind = \"sweep\"\nvary = { omega = { from = 2.6, to = 2.9, points = 3000 } }")}});
    ASSERT_EQ(job.status, 200) << job.text;
    const auto progress = events.wait_for("job", [](const nlohmann::json& one) { return one["done"] > 0; });
    EXPECT_EQ(progress["points"], 3000);
    EXPECT_EQ(page().ask("DELETE", "/api/jobs/" + job.json["id"].dump()).status, 200);
    const auto stopped = events.wait_for_job("stopped");
    EXPECT_EQ(stopped["id"], job.json["id"]);
    const auto run = page().get("/api/runs").json[1];
    EXPECT_EQ(run["status"], "unfinished");
    const std::size_t points = run["points"];
    EXPECT_GT(points, 0U);
    EXPECT_EQ(page().post("/api/jobs", {{"runs", {"long"}}}).status, 200);
    const auto further =
        events.wait_for("job", [&](const nlohmann::json& one) { return one["id"] == 2 && one["done"] > points; });
    EXPECT_GT(further["done"], points) << "it begins where it stopped";
    const auto begun = std::chrono::steady_clock::now();
    server_->stop();
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(5));
    EXPECT_TRUE(events.read_to_end().ends_with("event: end\ndata: {}\n\n\r\n0\r\n\r\n"));
}

TEST_F(ServedStudy, ProposesARunFromAPoint) {
    EventClient events(page());
    page().post("/api/jobs", {{"runs", {"one"}}});
    events.wait_for_job("complete");
    const auto action = page().get("/api/point?run=one&number=0").json["actions"][0];
    const Answered proposed =
        page().post("/api/propose", {{"run", "one"}, {"number", 0}, {"action", action["name"]}, {"along", nullptr}});
    ASSERT_EQ(proposed.status, 200) << proposed.text;
    const std::string text = proposed.json["text"], name = proposed.json["name"];
    EXPECT_NE(text.find("[runs." + name + "]"), std::string::npos) << text;
    EXPECT_EQ(page().post("/api/propose", {{"run", "one"}, {"number", 0}, {"action", "dance"}}).status, 400);
    EXPECT_EQ(
        page().post("/api/propose", {{"run", "one"}, {"number", 0}, {"action", action["name"]}, {"along", 3}}).status,
        400);
}

TEST_F(ServedStudy, SurvivesRequestsAtOnce) {
    std::vector<std::thread> threads;
    std::atomic<int> right = 0;
    for (int t = 0; t < 8; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < 10; ++i)
                right += page().get("/api/study").status == 200;
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(right, 80);
}

TEST(PageServer, BeginsWithAModel) {
    const testing::TemporaryFolder folder;
    PageOptions options;
    options.opened = "bouncing-ball";
    options.folder = folder / "new";
    PageServer server(options);
    server.start();
    const PageClient page(server);
    EXPECT_EQ(page.get("/api/session").json["opened"]["kind"], "model");
    EXPECT_EQ(page.get("/api/runs").json, nlohmann::json::array());
    const Answered model = page.get("/api/model");
    EXPECT_EQ(model.json["name"], "bouncing-ball");
    EXPECT_TRUE(model.json["actions"].is_array());
    const Answered motion = page.post("/api/simulate", {{"run", nullptr},
                                                        {"text", nullptr},
                                                        {"parameters", nlohmann::json::object()},
                                                        {"initial", nlohmann::json::object()},
                                                        {"duration", 0.5},
                                                        {"names", nlohmann::json::array()}});
    EXPECT_EQ(motion.status, 200) << motion.text;
    EXPECT_GT(motion.json["values"].size(), 0U);
    EXPECT_EQ(page.post("/api/simulate", {{"parameters", {{"g", "x"}}}}).status, 400);
    EXPECT_EQ(page.post("/api/simulate", {{"text", model.json["text"]}, {"duration", 0.1}}).status, 200);
    EventClient events(page);
    ASSERT_EQ(page.post("/api/jobs", {{"text", runs_to("fall", "kind = \"simulate\"\ntime = 0.5")}}).status, 200);
    EXPECT_FALSE(events.wait_for_job("complete").is_null());
    EXPECT_EQ(page.get("/api/runs").json[0]["status"], "complete");
    // A study that has no file gets one, in the folder only, and replaces nothing there.
    const Answered study = page.get("/api/study");
    EXPECT_EQ(study.json["has_file"], false);
    const auto save = [&](const std::string& file) {
        return page.put(
            "/api/study",
            {{"text", study.json["text"]}, {"revision", study.json["revision"]}, {"save", true}, {"file", file}});
    };
    EXPECT_EQ(save("").problem(), "this study has no file yet");
    EXPECT_EQ(save("../out.toml").status, 400);
    EXPECT_EQ(save("a/b.toml").status, 400);
    EXPECT_EQ(save(".hidden.toml").status, 400);
    EXPECT_EQ(save("results.sqlite").status, 400);
    std::ofstream(folder / "new/mine.toml") << "mine";
    EXPECT_EQ(save("mine.toml").status, 409);
    EXPECT_EQ(save("ball.toml").status, 200);
    EXPECT_TRUE(std::filesystem::exists(folder / "new/ball.toml"));
    EXPECT_EQ(page.get("/api/study").json["saved"], true);
}

/// Whether a study takes what is proposed for the model of a run, or for the opened model.
void expect_proposals_fit(const std::string& opened, const std::string& run) {
    PageServer server({.opened = opened, .folder = std::filesystem::path(opened).parent_path() / "out"});
    server.start();
    const PageClient page(server);
    const std::string text = page.get("/api/study").json["text"];
    for (const char* action : {"simulate", "sweep", "orbit"}) {
        const Answered proposed = page.post("/api/propose", {{"run", run}, {"action", action}});
        ASSERT_EQ(proposed.status, 200) << proposed.text;
        const std::string addition = proposed.json["text"];
        const Answered checked = page.post("/api/check", {{"kind", "study"}, {"text", text + "\n" + addition}});
        EXPECT_EQ(checked.json["errors"], nlohmann::json::array()) << addition << checked.text;
    }
}

TEST(PageServer, ProposesRunsOfAModelFileAsTheStudyNamesIt) {
    const testing::TemporaryFolder folder;
    std::string text = find_in_catalogue("bouncing-ball")->text;
    const std::string shipped = "bouncing-ball", own = "duffing"; // of which none is shipped
    text.replace(text.find(shipped), shipped.size(), own);
    const std::string model = folder.write("duffing.toml", text);
    expect_proposals_fit(model, "");
    const std::string run = "[runs.one]\nkind = \"simulate\"\ntime = 0.1\nmodel = \"duffing.toml\"\n";
    expect_proposals_fit(folder.write("own.toml", "name = \"own\"\n" + run), "one");
    expect_proposals_fit(folder.write("two.toml", "name = \"two\"\nmodel = \"impact-oscillator\"\n" + run), "one");
}

TEST(PageServer, GoesOnFromResultsWithoutTheirStudy) {
    const testing::TemporaryFolder folder;
    PageOptions options;
    {
        std::ofstream(folder / "short.toml") << short_study;
        options.opened = folder / "short.toml";
        options.folder = folder / "out";
        PageServer server(options);
        server.start();
        const PageClient page(server);
        EventClient events(page);
        page.post("/api/jobs", {{"runs", {"one"}}});
        events.wait_for_job("complete");
    }
    std::filesystem::remove(folder / "short.toml");
    options.opened = folder / "out";
    PageServer server(options);
    server.start();
    const PageClient page(server);
    EXPECT_EQ(page.get("/api/session").json["opened"]["kind"], "results");
    EXPECT_EQ(page.get("/api/runs").json.size(), 1U);
    EventClient events(page);
    const Answered job = page.post(
        "/api/jobs", {{"text", runs_to("on", "kind = \"simulate\"\nstart = { run = \"one\" }\nperiods = 1")}});
    ASSERT_EQ(job.status, 200) << job.text;
    EXPECT_FALSE(events.wait_for_job("complete").is_null());
    const Answered runs = page.get("/api/runs");
    ASSERT_EQ(runs.json.size(), 2U) << runs.text;
    EXPECT_EQ(runs.json[0]["status"], "complete");
    EXPECT_EQ(runs.json[1]["status"], "complete");
    // After a restart the results have both.
    PageServer again(options);
    again.start();
    EXPECT_EQ(PageClient(again).get("/api/runs").json.size(), 2U);
}

TEST(PageServer, RefusesWhatIsNotThere) {
    const testing::TemporaryFolder folder;
    PageOptions options;
    for (const std::string& opened :
         {std::string("no-such-thing"), folder / "no.toml", folder / "no.sqlite", folder / ""}) {
        options.opened = opened;
        EXPECT_THROW(PageServer{options}, InputError) << opened;
    }
    std::ofstream(folder / "wrong.toml") << "name = \"wrong\"\n[runs.a]\nkind = \"no\"\n";
    options.opened = folder / "wrong.toml";
    EXPECT_THROW(PageServer{options}, InputError);
}

} // namespace
} // namespace graze
