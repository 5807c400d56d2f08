#include "graze/acquire/record_folder.hpp"

#include "acquire/bench_experiment.hpp"
#include "base/message_of.hpp"

#include <gmock/gmock.h>

namespace graze::testing::record_folder_test {

using ::testing::HasSubstr;

const RecordHeader header{{"t", "s"}, {{"x", ""}}};
const Experiment experiment = parse_experiment(experiment_text(), "e.toml");

/// Writes a record without committing it.
void write(RecordFolder& records, const Level& level) {
    const auto writer = records.begin(level, header);
    writer->write({{0, 1}, {{2, static_cast<double>(level.number)}}});
    writer->close();
}

void commit(RecordFolder& records, const Level& level) {
    write(records, level);
    records.commit({.level = level, .samples = 2});
}

std::string message(const std::string& path) {
    return message_of([&] { RecordFolder(path, experiment, 0); });
}

TEST(RecordFolder, ListsCommittedRecords) {
    const TemporaryFolder folder;
    {
        RecordFolder records(folder / "a/b", experiment, 0);
        commit(records, experiment.levels[0]);
        write(records, experiment.levels[1]); // it is never committed
    }
    RecordFolder records(folder / "a/b", experiment, 0);
    EXPECT_TRUE(records.has(experiment.levels[0]));
    EXPECT_FALSE(records.has(experiment.levels[1]));
    EXPECT_EQ(files_of(folder / "a/b").size(), 3U) << "what was begun is gone";
    EXPECT_EQ(contents(records.path_of(experiment.levels[0])), "t [s], x\n0,2\n1,1\n");
    EXPECT_EQ(records.entries().at(1).bytes, 17U);
}

TEST(RecordFolder, RenamesACompleteRecordThatIsListed) {
    const TemporaryFolder folder;
    const std::string name = experiment.record_name(experiment.levels[0]);
    {
        RecordFolder records(folder / "r", experiment, 0);
        commit(records, experiment.levels[0]);
        commit(records, experiment.levels[1]);
    }
    // The state after a power failure between list and rename.
    std::filesystem::rename(folder / ("r/" + name), folder / ("r/.part." + name));
    { EXPECT_TRUE(RecordFolder(folder / "r", experiment, 0).has(experiment.levels[0])); }
    EXPECT_EQ(contents(folder / ("r/" + name)), "t [s], x\n0,2\n1,1\n");
    // A truncated record is dropped.
    std::filesystem::resize_file(folder / ("r/" + name), 5);
    EXPECT_THAT(message(folder / "r"), "");
    { EXPECT_FALSE(RecordFolder(folder / "r", experiment, 0).has(experiment.levels[0])); }
    EXPECT_THAT(contents(folder / "r/manifest.txt"), HasSubstr("\n2,0002"));
}

/// A copy of the process, which also holds the lock, completes the rename when the process is killed after writing the
/// list.
TEST(RecordFolder, CanBeFinishedByACopyOfItsProcess) {
    const TemporaryFolder folder;
    const std::string name = experiment.record_name(experiment.levels[0]);
    RecordFolder copy(folder / "r", experiment, 0);
    {
        std::filesystem::create_directory(folder / "other");
        RecordFolder killed(folder / "other/r", experiment, 0);
        commit(killed, experiment.levels[0]);
        write(killed, experiment.levels[1]);
        for (const char* file : {"manifest.txt", ".part."})
            for (const auto& entry : std::filesystem::directory_iterator(folder / "other/r"))
                if (entry.path().filename().string().starts_with(file))
                    std::filesystem::copy(entry.path(), folder / ("r/" + entry.path().filename().string()));
        std::filesystem::copy(killed.path_of(experiment.levels[0]), folder / ("r/.part." + name));
    }
    EXPECT_EQ(files_of(folder / "other/r").size(), 3U) << "what was begun goes with the object";
    EXPECT_FALSE(copy.has(experiment.levels[0]));
    copy.finish();
    EXPECT_TRUE(copy.has(experiment.levels[0]));
    EXPECT_EQ(contents(folder / ("r/" + name)), "t [s], x\n0,2\n1,1\n");
    EXPECT_EQ(files_of(folder / "r").size(), 3U) << "list, settings and the record";
}

TEST(RecordFolder, BelongsToOneExperimentAndOneProcess) {
    const TemporaryFolder folder;
    RecordFolder records(folder / "r", experiment, 0);
    EXPECT_THAT(message(folder / "r"), HasSubstr("another experiment is recorded into this folder"));
    const Experiment other = parse_experiment(replaced(experiment_text(), "= 500", "= 250"), "e.toml");
    RecordFolder(folder / "other", other, 0);
    EXPECT_THAT(message(folder / "other"),
                HasSubstr("the folder has records of other settings: 'rate 250' there, 'rate 500' here"));
    EXPECT_NE(records.identity(), RecordFolder(folder / "third", experiment, 0).identity());
}

TEST(RecordFolder, FollowsNoLinksAndReplacesNoFiles) {
    const TemporaryFolder folder;
    std::ofstream(folder / "mine") << "mine";
    std::filesystem::create_directory(folder / "r");
    const std::string name = experiment.record_name(experiment.levels[0]);
    for (const std::string& link : {".part." + name, std::string(".part.manifest.txt")})
        std::filesystem::create_symlink(folder / "mine", folder / ("r/" + link));
    RecordFolder records(folder / "r", experiment, 0);
    commit(records, experiment.levels[0]);
    EXPECT_EQ(contents(folder / "mine"), "mine");
    std::ofstream(records.path_of(experiment.levels[1])) << "somebody's";
    EXPECT_THROW(records.begin(experiment.levels[1], header), InputError);
    EXPECT_EQ(contents(records.path_of(experiment.levels[1])), "somebody's");
}

TEST(RecordFolder, RefusesAnInvalidList) {
    const TemporaryFolder folder;
    { RecordFolder records(folder / "r", experiment, 0); }
    for (const char* line :
         {"x", "1,../../x,1,1,1,1,1,1,1,1", "99,0099_f6100mHz_a9400mV_up.csv,1,1,1,1,1,1,1,1", ",,,,,,,,,"}) {
        std::ofstream(folder / "r/manifest.txt") << "heading\n" << line << "\n";
        EXPECT_THAT(message(folder / "r"), HasSubstr("manifest.txt:2:1: this is not a line of a list")) << line;
    }
    EXPECT_THAT(message("/dev/null/x"), HasSubstr("it cannot be opened as a folder"));
}

} // namespace graze::testing::record_folder_test
