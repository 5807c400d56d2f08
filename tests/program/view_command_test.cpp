#include "page/raw_client.hpp"
#include "program/program.hpp"
#include "results/run_of_model.hpp"
#include "run_graze.hpp"
#include "started_process.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>

namespace graze::testing {
namespace {

class ViewEndedBy : public ::testing::TestWithParam<int> {};

TEST_P(ViewEndedBy, PrintsItsAddressAndServesUntilTheSignal) {
    const Folder folder;
    StartedProcess child({"view", "bouncing-ball", "--output", folder / "out"}, folder / "messages");
    std::string printed;
    for (int i = 0; i < 20'000 && (printed.find("token=") == std::string::npos || !printed.ends_with('\n')); ++i) {
        usleep(1000);
        printed = child.printed();
    }
    const std::string before = "http://127.0.0.1:";
    const auto begin = printed.find(before);
    ASSERT_NE(begin, std::string::npos) << printed;
    const int port = std::stoi(printed.substr(begin + before.size()));
    const std::string token = printed.substr(printed.find("token=") + 6, 32);
    EXPECT_EQ(status_of(raw_answer(port, "GET /api/session HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
                                             "\r\nAuthorization: Bearer " + token + "\r\n\r\n")),
              200);
    expect_refusal(run_graze({"view", "bouncing-ball", "--port", std::to_string(port)}),
                   "port " + std::to_string(port) + " cannot be taken");
    child.signal(GetParam());
    EXPECT_EQ(child.wait(), 0) << child.printed();
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}
INSTANTIATE_TEST_SUITE_P(View, ViewEndedBy, ::testing::Values(SIGINT, SIGTERM));

/// The token must not stand on a command line, which all users of a machine can read.
TEST(View, OpensABrowserByAFileOfTheUserAlone) {
    const Folder folder;
    const std::string opener = folder.write("xdg-open", "#!/bin/sh\nstat -c %a \"$1\" > " + (folder / "mode") +
                                                            "\ncp \"$1\" " + (folder / "opened.tmp") + "\nmv " +
                                                            (folder / "opened.tmp") + " " + (folder / "opened") + "\n");
    std::filesystem::permissions(opener, std::filesystem::perms::owner_all);
    const std::string path = std::getenv("PATH");
    setenv("PATH", (folder.path() + ":" + path).c_str(), 1);
    StartedProcess child({"view", "bouncing-ball", "--open"}, folder / "messages");
    setenv("PATH", path.c_str(), 1);
    for (int i = 0; i < 20'000 && !std::filesystem::exists(folder / "opened"); ++i)
        usleep(1000);
    const std::string opened = contents(folder / "opened");
    EXPECT_EQ(contents(folder / "mode"), "600\n");
    const auto token = opened.find("token=");
    ASSERT_NE(token, std::string::npos) << opened;
    EXPECT_NE(child.printed().find(opened.substr(token, 38)), std::string::npos) << child.printed();
    child.signal(SIGTERM);
    EXPECT_EQ(child.wait(), 0);
}

TEST(View, EndsWhileAFileTakesLongToOpen) {
    const Folder folder;
    const std::string study = folder.write("a.toml", "name = \"a\"\nmodel = \"bouncing-ball\"\n"
                                                     "[runs.one]\nkind = \"simulate\"\ntime = 0.1\n");
    EXPECT_EQ(run_graze({"run", study, "--output", folder / "out"}).code, 0);
    change(folder / "out/results.sqlite",
           "ALTER TABLE names RENAME TO stored; CREATE VIEW names AS WITH RECURSIVE c(n) AS "
           "(SELECT 1 UNION ALL SELECT n + 1 FROM c) SELECT stored.* FROM stored, c WHERE n < 0");
    StartedProcess child({"view", folder / "out"}, folder / "messages");
    sleep(1); // it waits for the view
    const auto begun = std::chrono::steady_clock::now();
    child.signal(SIGTERM);
    EXPECT_EQ(child.wait(), exit_terminated) << child.printed();
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(10)) << "a query may take 30 s";
}

TEST(View, RefusesWhatItCannotShow) {
    const Folder folder;
    expect_refusal(run_graze("view " + (folder / "none.sqlite")), "none.sqlite");
    expect_refusal(run_graze("view " + folder.path()), "there are no results in this folder");
    expect_refusal(run_graze("view bouncing-bal"), "bouncing-ball");
    expect_refusal(run_graze({"view", "bouncing-ball", "--port", "70000"}), "--port");
}

} // namespace
} // namespace graze::testing
