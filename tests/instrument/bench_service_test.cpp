#include "instrument/bench_service.hpp"

#include "base/temporary_folder.hpp"
#include "bench/testbed.hpp"

#include <arpa/inet.h>
#include <array>
#include <atomic>
#include <chrono>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

namespace graze::bench_service_test {

/// A bench service in a thread of its own, with clients of its connections.
class Served {
public:
    explicit Served(ServiceSettings settings = {}) {
        settings.port = port();
        settings.on_demand = true;
        service_.emplace(bench_, settings);
        thread_ = std::thread([this] { service_->run([this] { return stop_.load(); }); });
        serial = open(port().c_str(), O_RDWR | O_NOCTTY);
        connection = connected();
    }
    ~Served() {
        stop_ = true;
        thread_.join();
        close(serial);
        close(connection);
        service_.reset();
        EXPECT_FALSE(std::filesystem::is_symlink(port()));
    }
    std::string port() const { return folder_ / "generator"; }
    /// Whether a connection to an address is accepted.
    bool is_reached(in_addr_t where, int file) const {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(service_->tcp_port());
        address.sin_addr.s_addr = htonl(where);
        return connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    }
    int connected() const {
        const int file = socket(AF_INET, SOCK_STREAM, 0);
        EXPECT_TRUE(is_reached(INADDR_LOOPBACK, file));
        return file;
    }
    static void say(int file, const std::string& text) {
        EXPECT_EQ(write(file, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    }
    /// Returns the text received until it ends with `end`, or for two seconds.
    static std::string heard(int file, const std::string& end) {
        std::string text;
        std::array<char, 4096> buffer{};
        pollfd waiting{file, POLLIN, 0};
        while (!text.ends_with(end) && poll(&waiting, 1, 2000) > 0) {
            const ssize_t count = read(file, buffer.data(), buffer.size());
            if (count <= 0)
                break;
            text.append(buffer.data(), static_cast<std::size_t>(count));
        }
        return text;
    }

    int serial = -1, connection = -1;

private:
    testing::TemporaryFolder folder_;
    ScpiBench bench_{testing::testbed({"I"})};
    std::optional<BenchService> service_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

TEST(BenchService, ServesTheGeneratorOnALineAndSamplesOnAPort) {
    Served served;
    Served::say(served.serial, "SYST:REM\nAPPL:SIN 6.1, 2, 0\r\nVOLT?\n");
    EXPECT_EQ(Served::heard(served.serial, "\n"), "+2.000000E+00\r\n");
    Served::say(served.connection, "CHANNELS\nRATE 500\nREAD 2\nWHAT\n");
    const std::string answers = Served::heard(served.connection, "stood\n");
    EXPECT_TRUE(answers.starts_with("t [s], I [A]\nOK 500\n0,0\n0.002,0.00"));
    EXPECT_TRUE(answers.ends_with("\nEND 2\nERROR 'WHAT' is not understood\n"));
    const int other = served.connected();
    EXPECT_EQ(Served::heard(other, "\n"), "ERROR somebody else is connected\n");
    close(other);
    Served::say(served.connection, "READ 100000000\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    Served::say(served.connection, "STOP\nMARK 1\nRETURN 1\nRETURN 2\n");
    const std::string rows = Served::heard(served.connection, "by 2\n");
    EXPECT_NE(rows.find("END "), std::string::npos);
    EXPECT_TRUE(rows.ends_with("OK\nOK\nERROR nothing is marked by 2\n"));
}

TEST(BenchService, SurvivesAnyInput) {
    Served served;
    std::string noise;
    for (int i = 0; i < 2000; ++i)
        noise += static_cast<char>(i * 37 + i / 11);
    Served::say(served.serial, noise + "\nSYST:REM;*CLS\n*IDN?\n");
    EXPECT_NE(Served::heard(served.serial, "-2.0\r\n").find("33120A"), std::string::npos);
    Served::say(served.connection, noise + std::string(5000, 'x'));
    Served::heard(served.connection, "never"); // until it closes the connection
    const int other = served.connected();
    Served::say(other, "RATE 1000\n");
    EXPECT_EQ(Served::heard(other, "\n"), "OK 1000\n");
    close(other);
}

TEST(BenchService, BreaksOnRequest) {
    Served served({.lines = 3, .broken = 0.05, .rows = 5});
    Served::say(served.serial, "*IDN?\n*IDN?\n*IDN?\n*IDN?\n");
    Served::heard(served.serial, "never");
    for (int i = 0; i < 100 && !std::filesystem::is_symlink(served.port()); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const int again = open(served.port().c_str(), O_RDWR | O_NOCTTY);
    Served::say(again, "*IDN?\n");
    EXPECT_NE(Served::heard(again, "\n"), "");
    close(again);
    Served::say(served.connection, "READ 10\n");
    EXPECT_EQ(Served::heard(served.connection, "never").find("END"), std::string::npos);
}

/// A service on all interfaces would be reachable at this address.
TEST(BenchService, IsReachedFromThisMachineAlone) {
    const Served served;
    const int file = socket(AF_INET, SOCK_STREAM, 0);
    EXPECT_FALSE(served.is_reached(INADDR_LOOPBACK + 1, file));
    close(file);
}

TEST(BenchService, ReplacesOnlyStaleLinks) {
    const testing::TemporaryFolder folder;
    const std::string file = folder.write("taken", "mine");
    ScpiBench bench(testing::testbed({"I"}));
    for (const ServiceSettings& wrong :
         {ServiceSettings{.port = file}, {.port = "/nowhere/at/all"}, {.port = folder / "free", .speed = 0}})
        EXPECT_THROW(BenchService service(bench, wrong), InputError);
    std::filesystem::remove(file);
    std::filesystem::create_symlink("/dev/pts/123456", file); // left by a process that was killed
    const ServiceSettings settings{.port = file};
    {
        const BenchService service(bench, settings);
        EXPECT_THROW(BenchService another(bench, settings), InputError) << "it is in use";
        EXPECT_TRUE(std::filesystem::is_symlink(file));
    }
    EXPECT_FALSE(std::filesystem::is_symlink(file));
}

} // namespace graze::bench_service_test
