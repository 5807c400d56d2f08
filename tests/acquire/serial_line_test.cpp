#include "graze/acquire/serial_line.hpp"

#include "acquire/bench_experiment.hpp"
#include "graze/acquire/acquisition.hpp"
#include "graze/record/record_file.hpp"
#include "instrument/bench_lines.hpp"
#include "instrument/bench_service.hpp"

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <mutex>
#include <numbers>
#include <poll.h>
#include <termios.h>
#include <thread>
#include <unistd.h>

namespace graze::testing::serial_line_test {

using ::testing::HasSubstr;

/// The far end of a serial line, controlled by a test.
class FarEnd {
public:
    FarEnd() : master_(posix_openpt(O_RDWR | O_NOCTTY)) {
        grantpt(master_);
        unlockpt(master_);
        settings.port = ptsname(master_);
    }
    ~FarEnd() { hang_up(); }
    FarEnd(const FarEnd&) = delete;
    FarEnd& operator=(const FarEnd&) = delete;
    void say(const std::string& text) const {
        EXPECT_EQ(::write(master_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    }
    std::string heard() const {
        char buffer[4096];
        const ssize_t count = read(master_, buffer, sizeof buffer);
        return {buffer, static_cast<std::size_t>(std::max<ssize_t>(count, 0))};
    }
    termios attributes() const {
        termios result{};
        tcgetattr(master_, &result);
        return result;
    }
    void hang_up() {
        if (master_ >= 0)
            close(master_);
        master_ = -1;
    }
    int descriptor() const { return master_; }
    SerialSettings settings;

private:
    int master_;
};

/// The generator of a bench whose samples another thread takes.
class SharedGenerator : public BenchGeneratorLine {
public:
    SharedGenerator(ScpiBench& bench, std::mutex& one) : BenchGeneratorLine(bench), one_(&one) {}
    void send(std::string_view line) override {
        const std::lock_guard lock(*one_);
        BenchGeneratorLine::send(line);
    }

private:
    std::mutex* one_;
};

/// The sample device of a bench at the end of a serial line, in a thread of its own.
class SerialDevice {
public:
    SerialDevice(ScpiBench& bench, std::mutex& one) : one_(&one), protocol_(bench) {
        settings = end_.settings;
        settings.baud = 115200;
        settings.stop_bits = StopBits::one;
        settings.flow = FlowControl::none;
        fcntl(end_.descriptor(), F_SETFL, O_NONBLOCK);
        thread_ = std::thread([this] {
            while (!stop_)
                serve();
        });
    }
    ~SerialDevice() {
        stop_ = true;
        thread_.join();
    }
    SerialDevice(const SerialDevice&) = delete;
    SerialDevice& operator=(const SerialDevice&) = delete;
    SerialSettings settings;

private:
    void serve() {
        pollfd ready{end_.descriptor(), POLLIN, 0};
        if (poll(&ready, 1, text_.empty() ? 5 : 0) > 0) {
            char buffer[256];
            const ssize_t count = read(end_.descriptor(), buffer, sizeof buffer);
            heard_.append(buffer, static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
        }
        const std::lock_guard lock(*one_);
        for (std::size_t cut = heard_.find('\n'); cut != std::string::npos; cut = heard_.find('\n')) {
            protocol_.receive(heard_.substr(0, cut));
            heard_.erase(0, cut + 1);
        }
        if (text_.empty())
            text_ = protocol_.next(SampleProtocol::rows_at_once);
        const ssize_t sent = ::write(end_.descriptor(), text_.data(), text_.size()); // as much as fits
        text_.erase(0, static_cast<std::size_t>(std::max<ssize_t>(sent, 0)));
    }

    FarEnd end_;
    std::mutex* one_;
    SampleProtocol protocol_;
    std::string heard_, text_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

/// A bench service in a thread of its own.
class Served {
public:
    explicit Served(ServiceSettings service = {}) {
        service.port = port();
        service.on_demand = service.speed == 1;
        service_.emplace(bench_, service);
        thread_ = std::thread([this] { service_->run([this] { return stop_.load(); }); });
    }
    ~Served() { end(); }
    Served(const Served&) = delete;
    Served& operator=(const Served&) = delete;
    void end() {
        stop_ = true;
        if (thread_.joinable())
            thread_.join();
        service_.reset();
    }
    std::string port() const { return folder_ / "generator"; }
    GeneratorOutput output() { // output of a bench whose service has ended
        end();
        return bench_.generator().output();
    }
    /// @param patience for an answer or samples, in seconds; less is what the experiment has
    AcquisitionReport run(const std::string& folder, const AcquisitionOptions& options = {}, double reopen = 5,
                          double patience = 0) {
        Experiment experiment = parse_experiment(
            experiment_text("", port(), "tcp:127.0.0.1:" + std::to_string(service_->tcp_port())), "sweep.toml");
        experiment.generator.reopen = reopen;
        experiment.generator.timeout = std::max(experiment.generator.timeout, patience);
        experiment.sample_timeout = std::max(experiment.sample_timeout, patience);
        const auto line = open_serial_line(experiment.serial);
        const auto samples = open_tcp_line("127.0.0.1", service_->tcp_port());
        TextSampleDevice device(borrowed(*samples), experiment.sample_timeout, options.interrupted);
        RecordFolder records(folder, experiment, 0);
        return acquire(experiment, *line, device, records, options);
    }

private:
    TemporaryFolder folder_;
    ScpiBench bench_{testbed_bench()};
    std::optional<BenchService> service_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

TEST(SerialLine, HasTheRequestedSettings) {
    FarEnd far;
    {
        const auto line = open_serial_line(far.settings);
        const termios set = far.attributes();
        EXPECT_EQ(cfgetospeed(&set), static_cast<speed_t>(B9600));
        EXPECT_NE(set.c_cflag & CSTOPB, 0U);
        EXPECT_EQ(set.c_cflag & PARENB, 0U);
        EXPECT_NE(set.c_iflag & IXON, 0U);
    }
    far.settings.baud = 19200;
    far.settings.stop_bits = StopBits::one;
    far.settings.flow = FlowControl::none;
    const auto line = open_serial_line(far.settings);
    const termios set = far.attributes();
    EXPECT_EQ(cfgetospeed(&set), static_cast<speed_t>(B19200));
    EXPECT_EQ(set.c_cflag & CSTOPB, 0U);
    EXPECT_EQ(set.c_iflag & IXON, 0U);
}

TEST(SerialLine, SplitsInputIntoLines) {
    FarEnd far;
    const auto line = open_serial_line(far.settings);
    line->send("VOLT?");
    EXPECT_EQ(far.heard(), "VOLT?\n");
    far.say("one\r\ntwo\n\r\nthr");
    EXPECT_EQ(line->receive(1), "one");
    EXPECT_EQ(line->receive(1), "two");
    EXPECT_EQ(line->receive(0.02), std::nullopt);
    far.say("ee\r");
    EXPECT_EQ(line->receive(1), "three");
    far.say("stale\nstale\nst");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    line->discard();
    far.say("fresh\n");
    EXPECT_EQ(line->receive(1), "fresh");
}

TEST(SerialLine, ReportsALostConnection) {
    FarEnd far;
    const auto line = open_serial_line(far.settings);
    far.hang_up();
    const auto ending = [&](auto work) {
        try {
            work();
        } catch (const InstrumentError& error) {
            return error.ending();
        }
        return AcquisitionEnding::complete;
    };
    EXPECT_EQ(ending([&] { line->receive(1); }), AcquisitionEnding::line_lost);
    EXPECT_EQ(ending([&] { line->send("x"); }), AcquisitionEnding::line_lost);
    EXPECT_EQ(ending([&] { line->reopen(); }), AcquisitionEnding::line_lost);
    EXPECT_EQ(ending([] { open_serial_line({.port = "/nowhere"}); }), AcquisitionEnding::line_lost);
    EXPECT_EQ(ending([&] { open_tcp_line("127.0.0.1", 1, 1); }), AcquisitionEnding::line_lost);
}

TEST(SerialLine, LimitsLongLinesAndUnreadInput) {
    FarEnd far;
    far.settings.flow = FlowControl::none;
    const auto line = open_serial_line(far.settings);
    std::atomic<bool> stop{false};
    std::thread endless([&] {
        const std::string much(1024, 'x');
        for (int i = 0; i < 1000 && !stop; ++i)
            far.say(much);
    });
    try {
        for (;;)
            line->receive(1);
    } catch (const InstrumentError& error) {
        EXPECT_EQ(error.ending(), AcquisitionEnding::garbled);
        EXPECT_THAT(error.what(), HasSubstr("a line of more than 65536 bytes"));
    }
    stop = true;
    line->discard(); // lets the thread continue
    endless.join();
}

TEST(Acquisition, GivesTheSameRecordsOverAPseudoTerminal) {
    const TemporaryFolder folder;
    Served one, other;
    EXPECT_EQ(one.run(folder / "one").ending, AcquisitionEnding::complete);
    std::size_t recorded = 0;
    const AcquisitionOptions options{.interrupted = [&] { return recorded == 2; },
                                     .recorded = [&](const RecordEntry&) { ++recorded; }};
    EXPECT_EQ(other.run(folder / "other", options).ending, AcquisitionEnding::interrupted);
    const AcquisitionReport report = other.run(folder / "other");
    EXPECT_EQ(report.ending, AcquisitionEnding::complete) << report.detail;
    EXPECT_EQ(report.before, 2U);
    EXPECT_EQ(different_files(folder / "one", folder / "other"), std::vector<std::string>());
    EXPECT_EQ(one.output(), (GeneratorOutput{6.1, 0.1, 0}));
}

/// Samples over a serial line, some sixty thousand characters a record, give the same records.
TEST(Acquisition, TakesSamplesOverASerialLine) {
    const TemporaryFolder folder;
    const Experiment experiment = parse_experiment(experiment_text(), "sweep.toml");
    std::mutex one_at_a_time;
    const auto recorded = [&](ScpiBench& bench, InstrumentLine& samples, const std::string& name) {
        SharedGenerator generator(bench, one_at_a_time);
        TextSampleDevice device(borrowed(samples), 5, {});
        RecordFolder records(folder / name, experiment, 0);
        const AcquisitionReport report = acquire(experiment, generator, device, records, {});
        EXPECT_EQ(report.ending, AcquisitionEnding::complete) << report.detail;
        EXPECT_EQ(report.recorded, 6U);
    };
    ScpiBench one(testbed_bench()), other(testbed_bench());
    BenchSampleLine direct(one);
    recorded(one, direct, "direct");
    SerialDevice serial(other, one_at_a_time);
    const auto line = open_serial_line(serial.settings);
    recorded(other, *line, "serial");
    EXPECT_EQ(different_files(folder / "direct", folder / "serial"), std::vector<std::string>());
}

TEST(Acquisition, RunsAtTheSpeedOfTheClock) {
    const TemporaryFolder folder;
    Served served({.speed = 40});
    const auto begin = std::chrono::steady_clock::now();
    // The bench computes its motion between answers: on a busy machine, or with sanitizers, they come late.
    const AcquisitionReport report = served.run(folder / "records", {}, 5, 60);
    EXPECT_EQ(report.ending, AcquisitionEnding::complete) << report.detail;
    EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(225)) << "six times 1.5 s";
    const auto record = open_record(folder / "records/0003_f6100mHz_a9600mV_up.csv");
    const Samples samples = read_all(*record, 1000);
    ASSERT_EQ(samples.rows(), 500U);
    for (std::size_t i = 2; i < 500; ++i) { // a sine without gaps obeys its recurrence
        const double angle = 2 * std::numbers::pi * 6.1 / 500;
        const std::vector<double>& v = samples.values[0];
        EXPECT_NEAR(v[i], 2 * std::cos(angle) * v[i - 1] - v[i - 2], 1e-8);
    }
}

TEST(Acquisition, CompletesOnALineThatLosesCharacters) {
    const TemporaryFolder folder;
    Served clean;
    EXPECT_EQ(clean.run(folder / "clean").ending, AcquisitionEnding::complete);
    Served served({.drop = 0.004});
    const AcquisitionReport report = served.run(folder / "lossy");
    EXPECT_EQ(report.ending, AcquisitionEnding::complete) << report.detail;
    EXPECT_TRUE(report.safe);
    EXPECT_EQ(different_files(folder / "clean", folder / "lossy"), std::vector<std::string>());
}

TEST(Acquisition, MakesTheOutputSafeAfterALineBreaks) {
    const TemporaryFolder folder;
    Served served({.lines = 30, .broken = 0.3});
    const AcquisitionReport report = served.run(folder / "records");
    EXPECT_EQ(report.ending, AcquisitionEnding::line_lost) << report.detail;
    EXPECT_TRUE(report.safe) << report.unsafe_because;
    const AcquisitionReport rest = served.run(folder / "records");
    EXPECT_EQ(rest.ending, AcquisitionEnding::complete) << rest.detail;
    EXPECT_EQ(rest.before + rest.recorded, 6U);
    EXPECT_EQ(served.output().amplitude, 0.1);
}

TEST(Acquisition, ReportsAGeneratorThatIsOutOfReach) {
    const TemporaryFolder folder;
    Served served({.lines = 30, .broken = 3600});
    const auto begin = std::chrono::steady_clock::now();
    const AcquisitionReport report = served.run(folder / "records", {}, 0.3);
    EXPECT_EQ(report.ending, AcquisitionEnding::line_lost);
    EXPECT_FALSE(report.safe);
    EXPECT_THAT(report.unsafe_because, HasSubstr("cannot be opened"));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(3));
}

TEST(Acquisition, MakesTheOutputSafeAfterSamplesStop) {
    const TemporaryFolder folder;
    Served served({.rows = 1600});
    const AcquisitionReport report = served.run(folder / "records");
    EXPECT_EQ(report.ending, AcquisitionEnding::line_lost) << report.detail;
    EXPECT_TRUE(report.safe);
    EXPECT_EQ(report.recorded, 2U); // 750 rows each
    EXPECT_EQ(served.output().amplitude, 0.1);
}

} // namespace graze::testing::serial_line_test
