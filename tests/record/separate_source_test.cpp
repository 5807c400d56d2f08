#include "record/separate_source.hpp"

#include "base/message_of.hpp"
#include "base/sanitized.hpp"
#include "base/temporary_folder.hpp"
#include "graze/record/record_file.hpp"
#include "graze/record/record_writer.hpp"
#include "mutated.hpp"
#include "record/waves.hpp"

#include <gmock/gmock.h>

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <thread>

namespace graze::testing::separate_source_test {

using ::testing::HasSubstr;

/// A source that runs a given function when it is read.
class ActingSource : public SampleSource {
public:
    explicit ActingSource(std::function<bool(Samples&)> act) : act_(std::move(act)) {}
    const RecordHeader& header() const override { return header_; }
    bool read(Samples& samples) override { return act_(samples); }

private:
    RecordHeader header_{{"t", "s"}, {{"x", "mm"}}};
    std::function<bool(Samples&)> act_;
};

std::string refusal_of(const std::function<bool(Samples&)>& act, const ReadingLimits& limits = {}) {
    return message_of([&] {
        SeparateSource source(
            "r.h5", [&] { return std::make_unique<ActingSource>(act); }, limits);
        Samples samples;
        while (source.read(samples))
            ;
    });
}

TEST(SeparateSource, PassesOnSamplesOfTheOtherProcess) {
    int part = 0;
    SeparateSource source("r.h5", [&] {
        return std::make_unique<ActingSource>([&](Samples& samples) {
            samples.clear(1);
            for (int i = 0; i < 50'000 && part < 3; ++i) {
                samples.times.push_back(part + i * 1e-5);
                samples.values[0].push_back(std::sin(i));
            }
            return part++ < 3;
        });
    });
    EXPECT_EQ(source.header().channels.at(0).unit, "mm");
    const Samples all = read_all(source, 1'000'000);
    ASSERT_EQ(all.rows(), 150'000U);
    EXPECT_EQ(all.times[50'001], 1 + 1e-5);
    EXPECT_EQ(all.values[0][149'999], std::sin(49'999));
    EXPECT_EQ(part, 0); // in this process
    Samples more;
    EXPECT_FALSE(source.read(more));
}

TEST(SeparateSource, CrashesBecomeErrors) {
    for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGKILL})
        EXPECT_THAT(refusal_of([signal](Samples&) { return std::raise(signal) != 0; }),
                    HasSubstr("r.h5: this file cannot be read; it is damaged"));
    EXPECT_THAT(refusal_of([](Samples&) -> bool { _exit(0); }), HasSubstr("this file cannot be read"));
}

TEST(SeparateSource, ErrorsKeepPlaceAndRemedy) {
    EXPECT_EQ(refusal_of([](Samples&) -> bool {
                  throw InputError(Place{"other.h5", 7, 3}, "a problem", "a remedy");
              }),
              "other.h5:7:3: a problem; a remedy");
    EXPECT_THAT(refusal_of([](Samples&) -> bool { throw std::runtime_error("odd"); }), HasSubstr("r.h5: it cannot"));
}

TEST(SeparateSource, TimeAndMemoryAreLimited) {
    EXPECT_THAT(refusal_of(
                    [](Samples&) {
                        for (volatile int i = 0;;) {
                            const int next = i + 1;
                            i = next;
                        }
                        return true;
                    },
                    {.work = 0.2, .silence = 20}),
                HasSubstr("takes more than 0.2 s"));
    EXPECT_THAT(refusal_of([](Samples&) { return pause() != 0; }, {.work = 5, .silence = 0.2}),
                HasSubstr("takes more than 0.2 s"));
    if (sanitized)
        return; // then no limit is set
    EXPECT_THAT(refusal_of([](Samples& samples) {
                    samples.times.resize(std::size_t{1} << 30);
                    return true;
                }),
                HasSubstr("more than 768 MiB"));
}

/// A compromised library could try to write files or use open ones.
TEST(SeparateSource, TheReaderCannotWriteFiles) {
    const TemporaryFolder folder;
    const int first = open((folder / "open").c_str(), O_WRONLY | O_CREAT, 0600);
    const int open_here = fcntl(first, F_DUPFD, 20); // a number that the other process does not use itself
    close(first);
    const std::string made = folder / "made";
    refusal_of([&](Samples&) {
        if (write(open_here, "x", 1) > 0)
            std::raise(SIGSTOP);
        const int file = open(made.c_str(), O_WRONLY | O_CREAT, 0600);
        return file >= 0 && write(file, "x", 1) > 0;
    });
    close(open_here);
    EXPECT_EQ(std::filesystem::file_size(folder / "open"), 0U);
    EXPECT_TRUE(!std::filesystem::exists(made) || std::filesystem::file_size(made) == 0);
}

TEST(SeparateSource, CanBeDestroyedBeforeTheEndOfTheFile) {
    const auto begun = std::chrono::steady_clock::now();
    {
        SeparateSource source("r.h5", [] {
            return std::make_unique<ActingSource>([](Samples& samples) {
                samples.times.assign(16'384, 1);
                samples.values.assign(1, samples.times);
                return true; // never ends
            });
        });
        Samples samples;
        EXPECT_TRUE(source.read(samples));
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(10));
}

TEST(SeparateSource, ManyThreadsReadAtOnce) {
    if (sanitized)
        GTEST_SKIP() << "the sanitizers' own allocator keeps the locks of other threads in a process that is forked";
    const TemporaryFolder folder;
    const std::string path = folder / "r.h5";
    {
        RecordWriter writer(path, {{"t", "s"}, {{"x", "mm"}}});
        writer.write(sampled(1, 20'000, {[](double t) { return t * t; }}));
        writer.close();
    }
    std::vector<std::thread> threads;
    std::atomic<int> whole = 0;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            for (int k = 0; k < 5; ++k)
                whole += read_all(*open_record(path), 100'000).rows() == 20'000 ? 1 : 0;
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(whole, 20);
}

/// GRAZE_MUTATIONS sets their number.
TEST(SeparateSource, MutatedRecordsAreReadOrRefused) {
    const TemporaryFolder folder;
    const std::string path = folder / "r.h5";
    RecordWriter writer(path, {{"t", "s"}, {{"x", "mm"}, {"y", ""}}});
    writer.write({{0, 1, 2, 3}, {{1, 2, 3, 4}, {0, 0, 1, 1}}});
    writer.close();
    const std::string whole = contents(path);
    const char* asked = std::getenv("GRAZE_MUTATIONS");
    const int count = asked != nullptr ? std::atoi(asked) : 150;
    std::mt19937 random(asked != nullptr ? static_cast<unsigned>(count) : 1);
    int refused = 0;
    double longest = 0;
    for (int i = 0; i < count; ++i) {
        const auto begun = std::chrono::steady_clock::now();
        try {
            read_all(*open_record(folder.write("m.h5", mutated_bytes(whole, random))), 1'000'000);
        } catch (const InputError& error) {
            EXPECT_NE(error.remedy(), "") << error.what();
            ++refused;
        }
        longest = std::max(longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
    }
    EXPECT_GT(refused, count / 20);
    EXPECT_LT(longest, 30); // allows for a loaded machine
    RecordProperty("refused", refused);
    RecordProperty("longest", std::to_string(longest));
}

} // namespace graze::testing::separate_source_test
