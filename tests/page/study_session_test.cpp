#include "page/study_session.hpp"

#include "base/message_of.hpp"
#include "base/temporary_folder.hpp"
#include "graze/base/input_errors.hpp"
#include "page/error_answer.hpp"
#include "page/short_files.hpp"
#include "page/study_job.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

const std::string first_text =
    "name = \"first\"\nmodel = \"bouncing-ball\"\n\n[runs.one]\nkind = \"simulate\"\ntime = 0.2\n";
const std::string second_run = "[runs.two]\nkind = \"simulate\"\ntime = 0.1\n";

class StudySessionOfFile : public ::testing::Test {
protected:
    testing::TemporaryFolder folder_;
    std::string path_ = folder_.write("first.toml", first_text);
    StudySession session_{page_subject(path_), folder_ / "out"};
};

TEST_F(StudySessionOfFile, BeginsWithItsText) {
    const StudyText text = session_.text();
    EXPECT_EQ(text.text, first_text);
    EXPECT_EQ(text.file, "first.toml");
    EXPECT_TRUE(text.saved);
    EXPECT_EQ(session_.study()->runs.size(), 1U);
    EXPECT_EQ(session_.results_path(), folder_ / "out/results.sqlite");
    EXPECT_FALSE(session_.results());
    EXPECT_TRUE(session_.can_compute());
}

TEST_F(StudySessionOfFile, KeepsATextWithMistakesAndTheStudyBeforeThem) {
    const StudyText text = session_.keep(first_text + "[runs.bad]\nkind = \"no\"\n", 1, {});
    EXPECT_EQ(text.revision, 2U);
    EXPECT_FALSE(text.saved);
    ASSERT_EQ(text.errors.size(), 1U);
    EXPECT_EQ(text.errors[0].place().line, 8);
    EXPECT_EQ(session_.study()->runs.size(), 1U);
    EXPECT_THROW(session_.append(second_run), InputError);
    EXPECT_EQ(session_.keep(first_text, 2, {}).errors.size(), 0U);
    EXPECT_TRUE(session_.text().saved);
}

TEST_F(StudySessionOfFile, RefusesChangesOfAnOlderText) {
    session_.keep(first_text + "# a\n", 1, {});
    EXPECT_THROW(session_.keep(first_text + "# b\n", 1, {}), RefusedRequest);
    EXPECT_EQ(session_.keep(first_text + "# a\n", 2, {}).revision, 2U) << "the same text is no change";
}

TEST_F(StudySessionOfFile, SavesIntoItsFile) {
    session_.keep(first_text + "# a\n", 1, {.save = true});
    EXPECT_EQ(testing::contents(path_), first_text + "# a\n");
    EXPECT_TRUE(session_.text().saved);
    folder_.write("first.toml", first_text + "# elsewhere\n");
    EXPECT_THROW(session_.keep(first_text + "# b\n", 2, {.save = true}), RefusedRequest);
    EXPECT_EQ(session_.text().text, first_text + "# a\n") << "nothing changes";
}

TEST_F(StudySessionOfFile, TakesOverChangesOfItsFile) {
    EXPECT_FALSE(session_.look());
    folder_.write("first.toml", first_text + second_run);
    EXPECT_TRUE(session_.look());
    EXPECT_EQ(session_.study()->runs.size(), 2U);
    EXPECT_EQ(session_.text().revision, 2U);
    session_.keep(first_text + "# mine\n", 2, {});
    folder_.write("first.toml", first_text);
    EXPECT_FALSE(session_.look()) << "what is not saved stays";
    EXPECT_EQ(session_.text().text, first_text + "# mine\n");
}

TEST_F(StudySessionOfFile, AppendsRunsAndTellsMistakesByTheLinesOfTheAddition) {
    EXPECT_EQ(session_.append(second_run), std::vector<std::string>{"two"});
    EXPECT_EQ(session_.text().text, first_text + "\n" + second_run);
    try {
        session_.append("[runs.three]\nkind = \"simulate\"\ntimes = 1\ntim = 2\n");
        FAIL();
    } catch (const InputErrors& errors) {
        EXPECT_EQ(errors.all()[0].place().line, 3);
        EXPECT_EQ(errors.all()[1].place().line, 4);
    }
    EXPECT_EQ(session_.text().revision, 2U);
}

TEST_F(StudySessionOfFile, AppendsNothingThatCouldChangeOtherRuns) {
    const auto expect_refused = [&](const std::string& addition, const std::string& problem) {
        EXPECT_NE(testing::message_of([&] { session_.append(addition); }).find(problem), std::string::npos) << addition;
    };
    // It would belong to the run before it.
    expect_refused("set = { e = 0.3 }\n" + second_run, "'set' is neither a run nor a picture");
    expect_refused("[set]\ne = 0.3\n" + second_run, "'set' is neither");
    expect_refused("[runs.one.set]\ne = 0.3\n" + second_run, "there is a run 'one' already");
    expect_refused("runs.two = { kind = \"simulate\", time = 0.1 }\n", "a key outside of tables");
    EXPECT_EQ(session_.text().text, first_text);
    EXPECT_EQ(session_.append(second_run + "[pictures.p]\nrun = \"two\"\n"), std::vector<std::string>{"two"});
    expect_refused("[runs.three]\nkind = \"simulate\"\ntime = 1\n[pictures.p]\nrun = \"three\"\n",
                   "there is a picture 'p' already");
}

TEST_F(StudySessionOfFile, RefusesAZeroByte) {
    EXPECT_THROW(session_.keep(first_text + '\0', 1, {.save = true}), InputError);
    EXPECT_EQ(testing::contents(path_), first_text);
}

TEST_F(StudySessionOfFile, TellsHowManyPointsAreKeptWhenTheDiskIsFull) {
    session_.append("[runs.many]\nkind = \"simulate\"\nvary = { e = { from = 0.1, to = 0.9, points = 2000 } }\n"
                    "time = 0.2\n");
    std::size_t told = 0;
    const JobControl control{[] { return false; }, [&](const auto&, std::size_t done, const auto&) { told = done; }};
    {
        const testing::ShortFiles limit(400'000);
        EXPECT_NE(testing::message_of([&] { compute_runs(session_, {"many"}, control, 1); }), "");
    }
    EXPECT_LT(told, 2000U);
    EXPECT_EQ(told, session_.results()->point_count("many"));
}

/// A study whose model is in a file of its own.
class StudySessionOfModelFile : public ::testing::Test {
protected:
    StudySessionOfModelFile() { compute_runs(session_, {"one"}, control_, 1); }
    void write_model(const std::string& text) const { folder_.write("ball.toml", text); }
    std::set<std::string> outdated() const { return session_.outdated(*session_.results()); }

    testing::TemporaryFolder folder_;
    const std::string model_ = page_subject("bouncing-ball").text;
    const std::string model_path_ = folder_.write("ball.toml", model_);
    const std::string path_ = folder_.write("first.toml", "name = \"first\"\nmodel = \"ball.toml\"\n[runs.one]\n"
                                                          "kind = \"simulate\"\ntime = 0.2\n");
    StudySession session_{page_subject(path_), folder_ / "out"};
    JobControl control_{[] { return false; }, [](const auto&...) {}};
};

TEST_F(StudySessionOfModelFile, ReadsItAgainWhenTheModelChanges) {
    EXPECT_FALSE(session_.look());
    EXPECT_EQ(outdated(), std::set<std::string>());
    write_model(model_ + "\n# no other model\n");
    EXPECT_TRUE(session_.look());
    EXPECT_FALSE(session_.look());
    EXPECT_EQ(session_.text().revision, 2U);
    EXPECT_EQ(outdated(), std::set<std::string>());
    std::string other = model_;
    other.replace(other.find("value = 9.81"), 12, "value = 9.8125");
    write_model(other);
    EXPECT_TRUE(session_.look());
    EXPECT_EQ(outdated(), std::set<std::string>{"one"});
    compute_runs(session_, {"one"}, control_, 1);
    EXPECT_EQ(outdated(), std::set<std::string>());
}

TEST_F(StudySessionOfModelFile, TellsMistakesOfTheModelWithItsFile) {
    write_model(model_ + "[unknown]\n");
    EXPECT_TRUE(session_.look());
    ASSERT_EQ(session_.text().errors.size(), 1U);
    EXPECT_EQ(std::filesystem::path(session_.text().errors[0].place().file).filename(), "ball.toml");
    EXPECT_THROW(session_.faultless_study(), InputError);
    EXPECT_THROW(compute_runs(session_, {"one"}, control_, 1), InputError);
    std::filesystem::remove(model_path_);
    EXPECT_TRUE(session_.look());
    EXPECT_EQ(session_.text().errors.size(), 1U);
    write_model(model_);
    EXPECT_TRUE(session_.look());
    EXPECT_EQ(session_.text().errors.size(), 0U);
}

TEST_F(StudySessionOfModelFile, KeepsATextThatIsNotSavedWhenTheModelChanges) {
    const std::string text = session_.keep(session_.text().text + "# mine\n", 1, {}).text;
    write_model(model_ + "\n");
    EXPECT_TRUE(session_.look());
    EXPECT_EQ(session_.text().text, text);
}

TEST_F(StudySessionOfModelFile, NoticesThatAModelNamedInAWrongTextIsMended) {
    folder_.write("other.toml", model_ + "[unknown]\n");
    session_.keep("name = \"first\"\nmodel = \"other.toml\"\n[runs.one]\nkind = \"simulate\"\ntime = 0.2\n", 1, {});
    EXPECT_FALSE(session_.look());
    folder_.write("other.toml", model_);
    EXPECT_TRUE(session_.look());
    EXPECT_EQ(session_.text().errors.size(), 0U);
}

TEST_F(StudySessionOfFile, ComputesRunsUnlessSomebodyElseWrites) {
    JobControl control;
    std::vector<std::string> told;
    control.interrupted = [] { return false; };
    control.progress = [&](const std::string& run, std::size_t, std::optional<std::size_t>) { told.push_back(run); };
    EXPECT_EQ(compute_runs(session_, {"one"}, control, 1).failure, "");
    EXPECT_EQ(told, std::vector<std::string>{"one"});
    EXPECT_EQ(session_.results()->point_count("one"), 1U);
    EXPECT_THROW(compute_runs(session_, {"none"}, control, 1), InputError);
    {
        const ResultFile other(session_.results_path(), ResultFile::Access::write);
        EXPECT_THROW(compute_runs(session_, {"one"}, control, 1), InputError);
        EXPECT_TRUE(session_.results()) << "it is read all the same";
    }
    control.interrupted = [] { return true; };
    session_.append(second_run);
    EXPECT_TRUE(compute_runs(session_, {"two"}, control, 1).interrupted);
}

TEST(StudySession, OfAModelNamesTheModelByItsPath) {
    const testing::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "models");
    const std::string path = folder.write("models/my ball.toml", page_subject("bouncing-ball").text);
    EXPECT_NE(StudySession(page_subject(path), folder / "out").text().text.find("model = \"/"), std::string::npos)
        << "the folder is not there yet";
    std::filesystem::create_directories(folder / "out");
    StudySession session(page_subject(path), folder / "out");
    EXPECT_EQ(session.text().text, "name = \"study\"\nmodel = \"../models/my ball.toml\"\n");
    EXPECT_EQ(session.append(second_run), std::vector<std::string>{"two"});
    EXPECT_FALSE(session.text().has_file);
}

TEST(StudySession, OfAModelGoesOnWithTheStudyThatWasSaved) {
    const testing::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "out");
    const std::string path = folder.write("ball.toml", page_subject("bouncing-ball").text);
    {
        StudySession session(page_subject(path), folder / "out");
        session.append(second_run);
        session.keep(session.text().text, 2, {.save = true, .file = session.text().file});
    }
    {
        StudySession again(page_subject(path), folder / "out");
        EXPECT_EQ(again.text().file, "ball-study.toml");
        EXPECT_TRUE(again.text().saved);
        ASSERT_EQ(again.study()->runs.size(), 1U);
        EXPECT_EQ(again.study()->runs[0].name, "two");
        again.keep(again.text().text + "[[", 1, {.save = true});
    }
    const StudySession mistaken(page_subject(path), folder / "out");
    EXPECT_EQ(mistaken.text().errors.size(), 1U);
    EXPECT_TRUE(mistaken.text().saved);
    std::filesystem::create_directories(folder / "other");
    const std::string other = folder.write("other/ball.toml", page_subject("bouncing-ball").text);
    folder.write("out/ball-study.toml", "name = \"ball\"\nmodel = \"../ball.toml\"\n");
    const StudySession of_other(page_subject(other), folder / "out");
    EXPECT_NE(of_other.text().text.find("../other/ball.toml"), std::string::npos) << "that study has another model";
    EXPECT_EQ(of_other.text().file, "ball-study-2.toml");
}

TEST(StudySession, OfAModelGoesOnFromItsResults) {
    const testing::TemporaryFolder folder;
    const JobControl control{[] { return false; }, [](const auto&...) {}};
    {
        StudySession session(page_subject("bouncing-ball", true), folder / "out");
        session.append(second_run);
        EXPECT_EQ(compute_runs(session, {"two"}, control, 1).failure, "");
    }
    StudySession again(page_subject("bouncing-ball", true), folder / "out");
    EXPECT_EQ(again.text().text,
              "# Runs that go on from those of results.sqlite\nname = \"bouncing-ball\"\nmodel = \"bouncing-ball\"\n");
    EXPECT_EQ(again.text().file, "bouncing-ball-further.toml");
    EXPECT_NE(again.study()->find_run("two"), nullptr);
    EXPECT_EQ(again.append("[runs.on]\nkind = \"simulate\"\nstart = { run = \"two\" }\ntime = 0.1\n"),
              std::vector<std::string>{"on"});
    EXPECT_EQ(compute_runs(again, {"on"}, control, 1).failure, "");
    again.look_at_results();
    EXPECT_EQ(again.text().errors.size(), 0U);
}

TEST(StudySession, OfAShippedStudyProposesAFileThatIsNotThere) {
    const testing::TemporaryFolder folder;
    EXPECT_EQ(StudySession(page_subject("mems-switch"), folder / "").text().file, "mems-switch.toml");
    folder.write("mems-switch.toml", "");
    StudySession session(page_subject("mems-switch"), folder / "");
    EXPECT_EQ(session.text().file, "mems-switch-2.toml");
    EXPECT_TRUE(session.keep(session.text().text, 1, {.save = true, .file = session.text().file}).saved);
}

TEST_F(StudySessionOfFile, PointsToThePageOnStudies) {
    const StudyText text = session_.keep(first_text + "x =\n", 1, {});
    ASSERT_EQ(text.errors.size(), 1U);
    EXPECT_EQ(text.errors[0].remedy(), "docs/study-format.md shows how a study is written");
}

TEST(StudySession, OfResultsKeepsTheirPicturesAndValues) {
    const testing::TemporaryFolder folder;
    JobControl control{[] { return false; }, [](const auto&...) {}};
    const std::string path = folder.write("first.toml", first_text + "[pictures.shown]\nrun = \"one\"\n");
    {
        const StudySession session(page_subject(path), folder / "out");
        compute_runs(session, {"one"}, control, 1);
    }
    StudySession session(page_subject(folder / "out"));
    EXPECT_EQ(session.study()->pictures.size(), 1U);
    EXPECT_EQ(session.append(second_run), std::vector<std::string>{"two"});
    EXPECT_EQ(session.study()->pictures.size(), 1U);
    EXPECT_EQ(compute_runs(session, {"two"}, control, 1).failure, "");
    session.look_at_results();
    EXPECT_EQ(session.text().errors.size(), 0U) << "the run of the text is not one to go on from";
    EXPECT_EQ(session.outdated(*session.results()), std::set<std::string>());
    StudySaving saving{.save = true, .file = "on.toml"};
    session.keep(session.text().text, session.text().revision, saving);
    EXPECT_TRUE(std::filesystem::exists(folder / "out/on.toml")) << "beside the results";
    const StudySession again(page_subject(folder / "out"));
    EXPECT_EQ(again.study()->runs.size(), 2U);
    EXPECT_EQ(again.study()->pictures.size(), 1U) << "they are stored again with the further run";
}

TEST(StudySession, OfResultsGoesOnFromWhatOthersAdd) {
    const testing::TemporaryFolder folder;
    JobControl control{[] { return false; }, [](const auto&...) {}};
    const std::string path = folder.write("first.toml", first_text + second_run);
    const StudySession study(page_subject(path), folder / "out");
    compute_runs(study, {"one"}, control, 1);
    StudySession session(page_subject(folder / "out"));
    folder.write("first.toml", first_text + "\n" + second_run + "\n[runs.new]\nkind = \"simulate\"\ntime = 0.1\n");
    compute_runs(StudySession(page_subject(path), folder / "out"), {"new"}, control, 1);
    session.look_at_results();
    EXPECT_NE(session.study()->find_run("new"), nullptr);
    EXPECT_EQ(session.append("[runs.on]\nkind = \"simulate\"\nstart = { run = \"new\" }\ntime = 0.1\n"),
              std::vector<std::string>{"on"});
}

TEST(StudySession, OfResultsHasTheTextOfThoseThatReplaceThem) {
    const testing::TemporaryFolder folder;
    const JobControl control{[] { return false; }, [](const auto&...) {}};
    const auto compute = [&](const std::string& name, const std::string& text, const std::string& run) {
        const StudySession study(page_subject(folder.write(name + ".toml", text)), folder / name);
        compute_runs(study, {run}, control, 1);
    };
    compute("first", first_text, "one");
    compute("other", "name = \"other\"\nmodel = \"impact-oscillator\"\n" + second_run, "two");
    StudySession session(page_subject(folder / "first"));
    EXPECT_NE(session.text().text.find("name = \"first\""), std::string::npos);
    std::filesystem::rename(folder / "other/results.sqlite", folder / "first/results.sqlite");
    session.look_at_results();
    EXPECT_EQ(session.title(), "other");
    EXPECT_NE(session.text().text.find("name = \"other\"\nmodel = \"impact-oscillator\""), std::string::npos);
    EXPECT_EQ(session.text().revision, 2U);
}

} // namespace
} // namespace graze
