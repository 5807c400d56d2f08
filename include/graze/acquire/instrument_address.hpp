#pragma once

#include "graze/base/input_error.hpp"

#include <string>

namespace graze {

/// Address of an instrument: a TCP port or a serial line.
struct InstrumentAddress {
    bool is_tcp = false;
    std::string name; ///< name of a host, or path of a serial line
    unsigned short port = 0;
};

/// Whether a text is a VISA resource name, such as "ASRL/dev/ttyUSB0::INSTR" or "TCPIP0::192.168.1.5::5025::SOCKET".
bool is_visa_name(const std::string& text);

/// Parses the address of a device that takes samples. @throws InputError with the place unless it is "tcp:HOST:PORT",
/// "serial:PATH" or a VISA name of a serial line or a TCP socket
InstrumentAddress device_address(const std::string& text, const Place& place);
/// Parses the address of a generator: the same, or just the path of its serial line.
InstrumentAddress generator_address(const std::string& text, const Place& place);

} // namespace graze
