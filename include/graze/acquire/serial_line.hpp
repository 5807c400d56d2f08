#pragma once

#include "graze/acquire/instrument_line.hpp"

#include <memory>
#include <string>

namespace graze {

enum class Parity { none, odd, even };
enum class StopBits { one, one_and_a_half, two };
enum class FlowControl { none, software, hardware };

/// Settings of a serial line; the defaults are those of the HP 33120A in B. E. Wilcox's dissertation.
struct SerialSettings {
    std::string port{}; ///< such as /dev/ttyUSB0, or a VISA name
    unsigned baud = 9600, data_bits = 8;
    Parity parity = Parity::none;
    StopBits stop_bits = StopBits::two;
    FlowControl flow = FlowControl::software;
};

/// Opens a serial line or a pseudo-terminal. Sent lines end with a line feed; received ones with a carriage return, a
/// line feed, or both.
/// @throws InstrumentError when it cannot be opened, or does not accept the settings
std::unique_ptr<InstrumentLine> open_serial_line(const SerialSettings& settings);

/// Opens a connection to a TCP port. @param host a name or address; @param timeout longest wait for the connection, in
/// s
/// @throws InstrumentError when it fails
std::unique_ptr<InstrumentLine> open_tcp_line(const std::string& host, unsigned short port, double timeout = 5);

/// Opens the line that the settings' port names: a serial line, or a TCP connection. @throws InputError for a VISA name
/// that cannot be used; InstrumentError
std::unique_ptr<InstrumentLine> open_generator_line(const SerialSettings& settings);

} // namespace graze
