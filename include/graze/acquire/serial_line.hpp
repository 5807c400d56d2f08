#pragma once

#include "graze/acquire/instrument_line.hpp"

#include <memory>
#include <string>

namespace graze {

enum class Parity { none, odd, even };
enum class StopBits { one, one_and_a_half, two };
enum class FlowControl { none, software, hardware };

/// How a serial line is set; at first as of the HP 33120A in B. E. Wilcox's dissertation.
struct SerialSettings {
    std::string port; ///< such as /dev/ttyUSB0, or a name of VISA
    unsigned baud = 9600, data_bits = 8;
    Parity parity = Parity::none;
    StopBits stop_bits = StopBits::two;
    FlowControl flow = FlowControl::software;
};

/// Opens a serial line, or a pseudo-terminal. Lines that are sent end with a line feed; those received with a carriage
/// return, a line feed, or both.
/// @throws InstrumentError when it cannot be opened, or set so
std::unique_ptr<InstrumentLine> open_serial_line(const SerialSettings& settings);

/// Opens a connection to a TCP port. @param host a name or address; @param timeout s, for the connection
/// @throws InstrumentError when there is none
std::unique_ptr<InstrumentLine> open_tcp_line(const std::string& host, unsigned short port, double timeout = 5);

/// Opens what the settings' port names: a serial line, or a TCP connection. @throws InputError for a name of VISA that
/// cannot be used; InstrumentError
std::unique_ptr<InstrumentLine> open_generator_line(const SerialSettings& settings);

} // namespace graze
