#pragma once

#include "instrument/scpi_bench.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>

namespace graze {

struct ServiceSettings {
    std::string port;       ///< name for the generator's serial line: a link to a pseudo-terminal
    std::uint16_t tcp = 0;  ///< port on the loopback interface for samples; 0: one that is free
    double speed = 1;       ///< seconds of the bench in a second
    bool on_demand = false; ///< time passes only as samples are read, as fast as they can be computed
    double drop = 0;        ///< probability of each character on the serial line to get lost
    double delay = 0;       ///< s, before the generator's answers
    std::size_t lines = 0;  ///< on the serial line before it breaks; 0: it does not
    double broken = 1;      ///< s, until it is there again
    std::size_t rows = 0;   ///< of samples before their connection breaks, each time anew; 0: it does not
    std::uint64_t seed = 1; ///< of what is lost
    /// @throws InputError naming the setting that is out of range
    void validate() const;
};

/// Gives a virtual bench the connections of a real one: a serial line, as a pseudo-terminal that goes by a name of
/// one's own, and a TCP port for samples that only this machine can reach.
class BenchService {
public:
    /// @param bench must outlive this
    /// @throws InputError for settings out of range, and when the port's name is taken or a connection cannot be made
    BenchService(ScpiBench& bench, const ServiceSettings& settings);
    /// Takes the name away again.
    ~BenchService();
    BenchService(const BenchService&) = delete;
    BenchService& operator=(const BenchService&) = delete;

    std::uint16_t tcp_port() const;
    /// Serves until asked to stop, which may take 50 ms.
    void run(const std::function<bool()>& stop);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace graze
