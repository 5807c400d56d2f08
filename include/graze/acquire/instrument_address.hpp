#pragma once

#include "graze/base/input_error.hpp"

#include <string>

namespace graze {

/// Where an instrument is.
struct InstrumentAddress {
    bool is_tcp = false;
    std::string name; ///< of a host, or path of a serial line
    unsigned short port = 0;
};

/// Whether a text is a name of VISA, such as "ASRL/dev/ttyUSB0::INSTR" or "TCPIP0::192.168.1.5::5025::SOCKET".
bool is_visa_name(const std::string& text);

/// Of a device of samples. @throws InputError with the place unless it is "tcp:HOST:PORT", "serial:PATH" or a name of
/// VISA for a serial line or a TCP socket
InstrumentAddress device_address(const std::string& text, const Place& place);
/// Of a generator: the same, or the path of its serial line alone.
InstrumentAddress generator_address(const std::string& text, const Place& place);

} // namespace graze
