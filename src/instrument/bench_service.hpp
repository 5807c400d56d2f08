#pragma once

#include "instrument/scpi_bench.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace graze {

/// Options of `BenchService`; some of them simulate faulty connections.
struct ServiceSettings {
    std::string port{};     ///< name of the generator's serial line: a link to a pseudo-terminal
    std::uint16_t tcp = 0;  ///< port on the loopback interface for samples; 0: any free one
    double speed = 1;       ///< simulated seconds per second
    bool on_demand = false; ///< simulated time passes only as samples are read, as fast as they can be computed
    double drop = 0;        ///< probability that a character on the serial line is lost
    double delay = 0;       ///< delay of the generator's answers, in s
    std::size_t lines = 0;  ///< lines on the serial line until it breaks; 0: never
    double broken = 1;      ///< time until it is back, in s
    std::size_t rows = 0;   ///< sample rows until their connection breaks, each time anew; 0: never
    std::uint64_t seed = 1; ///< seed of the lost characters
    /// @throws InputError naming the setting that is out of range
    void validate() const;
};

/// Gives a virtual bench the connections of a real one: a serial line (a pseudo-terminal under a chosen name), and a
/// TCP port for samples on the loopback interface.
class BenchService {
public:
    /// @param bench must outlive this object
    /// @throws InputError for settings out of range, and when the port's name is taken or a connection cannot be opened
    BenchService(ScpiBench& bench, const ServiceSettings& settings);
    /// Removes the name.
    ~BenchService();
    BenchService(const BenchService&) = delete;
    BenchService& operator=(const BenchService&) = delete;

    std::uint16_t tcp_port() const;
    /// Serves until `stop` returns true, which it is asked every 50 ms at least.
    void run(const std::function<bool()>& stop);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace graze
