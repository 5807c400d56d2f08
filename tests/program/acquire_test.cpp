#include "graze/acquire/serial_line.hpp"
#include "run_graze.hpp"
#include "started_process.hpp"

#include <chrono>
#include <gmock/gmock.h>
#include <random>
#include <sys/file.h>
#include <thread>

namespace graze::testing::acquire_test {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A simulated bench of the testbed, in another process, and an experiment file that uses it.
class Experiment {
public:
    explicit Experiment(const std::string& options = "", const std::string& steps = "0.1")
        : bench_(words_of("bench electromagnetic-testbed --port " + port() +
                          " --on-demand --channel V=voltage:V --channel v --noise v=0.002 --range v=1" + options),
                 folder_ / "bench.txt") {
        for (int i = 0; i < 1000 && bench_.printed().find("samples ") == std::string::npos; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        const std::string said = bench_.printed();
        const std::size_t at = said.find("samples ") + 8;
        std::ofstream(folder_ / "sweep.toml")
            << "name = \"sweep\"\n[generator]\nport = \"" << port()
            << "\"\ntimeout = 0.5\nidentity = \"33120A\"\n[limits]\namplitude = 10\nsafe = 0.1\n[samples]\ndevice = \""
            << said.substr(at, said.find('\n', at) - at)
            << "\"\nrate = 1000\n[sweep]\nfrequency = 6.1\namplitude = { from = 9.5, to = 10, step = " << steps
            << ", back = true }\n[settle]\ntime = 0.1\n[record]\ntime = 2\n";
    }
    std::string port() const { return folder_ / "generator"; }
    std::string path(const std::string& name) const { return folder_ / name; }
    std::string command(const std::string& records) const {
        return "acquire " + path("sweep.toml") + " --output " + path(records);
    }
    /// The generator's amplitude in V, read when no process has the records locked any more.
    double amplitude(const std::string& records) const {
        if (const int lock = open(path(records).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); lock >= 0) {
            flock(lock, LOCK_EX);
            close(lock);
        }
        SerialSettings settings;
        settings.port = port();
        const auto line = open_serial_line(settings);
        line->discard();
        line->send("VOLT?");
        return std::strtod(line->receive(2).value_or("99").c_str(), nullptr);
    }

private:
    Folder folder_;
    StartedProcess bench_;
};

/// Carries out the whole experiment. @return the time that it took
std::chrono::microseconds carried_out(const Experiment& experiment, const std::string& records) {
    const auto begin = std::chrono::steady_clock::now();
    StartedProcess whole(words_of(experiment.command(records)), experiment.path("said.txt"));
    EXPECT_EQ(whole.wait(), 0) << whole.printed();
    return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin);
}

/// Kills the program at random times until it finishes. The times are fractions of the duration of the whole
/// experiment, so small that it cannot finish before the last kill. @param at_most number of kills. @return number of
/// kills
int killed(const Experiment& experiment, const std::string& records, unsigned seed, std::chrono::microseconds whole,
           int at_most) {
    const auto longest = static_cast<unsigned>(whole.count() / at_most);
    std::mt19937 random(seed);
    for (int times = 0;; ++times) {
        StartedProcess process(words_of(experiment.command(records)), experiment.path("said.txt"));
        const int signal = times % 2 == 0 ? SIGKILL : SIGTERM;
        if (times < at_most) {
            std::this_thread::sleep_for(std::chrono::microseconds(random() % longest));
            process.signal(signal);
        }
        const int code = process.wait();
        EXPECT_LE(experiment.amplitude(records), 0.1) << process.printed();
        if (code == 0)
            return times;
        if (times >= at_most) {
            ADD_FAILURE() << code << process.printed();
            return times;
        }
        EXPECT_TRUE(code == -signal || code == 128 + signal) << code << process.printed();
    }
}

TEST(Acquire, RecordsAllLevelsOnceAndNothingTheSecondTime) {
    const Experiment experiment;
    StartedProcess first(words_of(experiment.command("records")), experiment.path("said.txt"));
    EXPECT_EQ(first.wait(), 0);
    EXPECT_EQ(first.printed(), experiment.path("records") + ": 12 of 12 records\n");
    EXPECT_EQ(files_of(experiment.path("records")).size(), 14U);
    EXPECT_EQ(experiment.amplitude("records"), 0.1);
    done(experiment.command("records"));
    const std::string sections = done("record " + experiment.path("records/0003_f6100mHz_a9700mV_up.csv") +
                                      " --what sections --reference V --channel v --format csv");
    EXPECT_EQ(Csv(sections).rows.size(), 11U); // 2 s at 6.1 Hz
}

TEST(Acquire, ContinuesAfterKillsWithTheSameRecords) {
    const Experiment experiment;
    const auto whole = carried_out(experiment, "whole");
    const Experiment another;
    EXPECT_GT(killed(another, "parts", 3, whole, 6), 2);
    EXPECT_THAT(different_files(experiment.path("whole"), another.path("parts")), IsEmpty());
}

TEST(AcquireSlow, ContinuesAfterFiftyKillsWithTheSameRecords) {
    const std::string fine = "0.005"; // about two hundred records
    const Experiment experiment("", fine);
    const auto whole = carried_out(experiment, "whole");
    for (const unsigned seed : {1U, 2U}) {
        const Experiment another("", fine);
        EXPECT_EQ(killed(another, "parts", seed, whole, 50), 50) << "it was done before";
        EXPECT_THAT(different_files(experiment.path("whole"), another.path("parts")), IsEmpty());
    }
}

TEST(Acquire, ContinuesAfterTheDiskWasFull) {
    const Experiment experiment;
    // The size limit is below the size of a record, but above that of the list of records.
    StartedProcess full(words_of(experiment.command("records")), experiment.path("said.txt"), 60'000);
    EXPECT_EQ(full.wait(), 2);
    EXPECT_EQ(experiment.amplitude("records"), 0.1);
    EXPECT_EQ(files_of(experiment.path("records")).count("0001_f6100mHz_a9500mV_up.csv"), 0U);
    const std::string said = contents(experiment.path("said.txt"));
    EXPECT_THAT(said, HasSubstr("the record cannot be written; look at the permissions of the folder and the room"));
    StartedProcess roomy(words_of(experiment.command("records")), experiment.path("said.txt"));
    EXPECT_EQ(roomy.wait(), 0) << roomy.printed();
    EXPECT_EQ(files_of(experiment.path("records")).size(), 14U);
}

TEST(Acquire, ReportsAGeneratorThatClips) {
    const Experiment experiment(" --clip 9.7");
    const Printed clipped = run_graze(experiment.command("records"));
    EXPECT_EQ(clipped.code, 3);
    EXPECT_THAT(clipped.err, HasSubstr("clipped: the generator gives an amplitude of 9.7 V instead of 9.8 V"));
    EXPECT_EQ(clipped.out, experiment.path("records") + ": 3 of 12 records\n");
    EXPECT_EQ(experiment.amplitude("records"), 0.1);
}

TEST(Acquire, ReportsMissingInstrumentsAndFiles) {
    const Folder folder;
    std::ofstream(folder / "e.toml") << "name = \"e\"\n[generator]\n[limits]\namplitude = 1\nsafe = 0.1\n[samples]\n"
                                        "rate = 10\n[sweep]\nfrequency = 1\namplitude = 0.5\n[record]\ntime = 1\n";
    const std::string start = "acquire " + (folder / "e.toml") + " --output " + (folder / "records");
    EXPECT_THAT(run_graze(start).err, HasSubstr("nothing says where the generator is"));
    EXPECT_EQ(run_graze(start + " --port /nowhere").code, 2);
    const Printed nowhere = run_graze(start + " --port /nowhere --device tcp:127.0.0.1:1");
    EXPECT_EQ(nowhere.code, 3);
    EXPECT_THAT(nowhere.err, HasSubstr("line-lost: serial line '/nowhere' cannot be opened"));
    done(start + " --dry-run");
    EXPECT_EQ(run_graze(start + " --port x --device nothing").code, 2);
    EXPECT_THAT(run_graze(start + " --phase 0.5").err, HasSubstr("--phase"));
    EXPECT_EQ(run_graze("acquire /nowhere.toml").code, 2);
    std::ofstream(folder / "e.toml", std::ios::app) << "format = \"h5\"\n";
    EXPECT_THAT(run_graze(start + " --port /nowhere --device tcp:127.0.0.1:1").err,
                HasSubstr("the folder has records of other settings: 'format csv' there, 'format h5' here"));
}

TEST(Bench, RefusesWrongOptions) {
    const Folder folder;
    const std::string port = " --port " + (folder / "port");
    for (const auto& [options, message] : std::vector<std::pair<std::string, std::string>>{
             {"impact-oscillator" + port, "--amplitude: there is no parameter 'V0'"},
             {"electromagnetic-testbed", "the serial line has no name; give one by --port PATH"},
             {"electromagnetic-testbed" + port + " --noise w=1", "--noise: there is no channel 'w'"},
             {"electromagnetic-testbed" + port + " --noise v", "--noise: 'v' gives no value"},
             {"electromagnetic-testbed" + port + " --channel x=nothing", "unknown name 'nothing'"},
             {"electromagnetic-testbed" + port + " --drop 2", "--drop"},
             {"electromagnetic-testbed" + port + " --on-demand --speed 2", "--speed"},
             {"electromagnetic-testbed" + port + " --bits 12", "--bits"},
             {"electromagnetic-testbed --port /nowhere/port", "no serial line can be made"},
         }) {
        expect_refusal("bench " + options, message);
    }
    EXPECT_EQ(folder.files(), 0U);
}

} // namespace graze::testing::acquire_test
