#include "graze/acquire/instrument_address.hpp"

#include "base/letter_case.hpp"
#include "base/read_whole.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace graze {

namespace {

bool are_digits(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool read_port(std::string_view text, unsigned short& port) {
    return read_whole(text, port) && port > 0;
}

/// Splits a name at double colons, except within brackets, which hold an IPv6 address.
std::vector<std::string_view> visa_parts(std::string_view text) {
    std::vector<std::string_view> parts;
    std::size_t begin = 0;
    bool bracketed = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        bracketed = text[i] == '[' || (bracketed && text[i] != ']');
        if (bracketed || text.substr(i, 2) != "::")
            continue;
        parts.push_back(text.substr(begin, i - begin));
        begin = ++i + 1;
    }
    parts.push_back(text.substr(begin));
    return parts;
}

std::string_view without_brackets(std::string_view host) {
    const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
    return bracketed ? host.substr(1, host.size() - 2) : host;
}

[[noreturn]] void refuse_address(const std::string& text, const Place& place, const char* problem, const char* remedy) {
    throw InputError(place, fmt::format("'{}' {}", text, problem), remedy);
}

InstrumentAddress visa_address(const std::string& text, const Place& place) {
    const std::vector<std::string_view> parts = visa_parts(text);
    InstrumentAddress address;
    constexpr std::size_t kind_of_serial = 4, kind_of_tcp = 5; // lengths of ASRL and TCPIP
    if (in_capitals(text).starts_with("ASRL")) {
        const std::string_view path = parts[0].substr(kind_of_serial);
        if (are_digits(path))
            refuse_address(text, place, "names a serial line by a number, which is not supported",
                           "give its path, as ASRL/dev/ttyUSB0::INSTR");
        if (parts.size() > 2 || (parts.size() == 2 && in_capitals(parts[1]) != "INSTR"))
            refuse_address(text, place, "is not a VISA name of a serial line", "write it as ASRL/dev/ttyUSB0::INSTR");
        address.name = path;
        return address;
    }
    address.is_tcp = true;
    constexpr std::size_t of_socket = 4;
    if (parts.size() != of_socket || in_capitals(parts[3]) != "SOCKET" || !are_digits(parts[0].substr(kind_of_tcp)) ||
        without_brackets(parts[1]).empty() || !read_port(parts[2], address.port))
        refuse_address(text, place, "is not a VISA name of a TCP socket",
                       "give the port at which it takes SCPI, as TCPIP0::192.168.1.5::5025::SOCKET; VXI-11 and HiSLIP "
                       "(TCPIP0::HOST::INSTR) are not supported");
    address.name = without_brackets(parts[1]);
    return address;
}

} // namespace

bool is_visa_name(const std::string& text) {
    return text.find("::") != std::string::npos &&
           (in_capitals(text).starts_with("ASRL") || in_capitals(text).starts_with("TCPIP"));
}

InstrumentAddress device_address(const std::string& text, const Place& place) {
    if (is_visa_name(text))
        return visa_address(text, place);
    InstrumentAddress address;
    const std::size_t first = text.find(':'), last = text.rfind(':');
    const std::string kind = text.substr(0, first);
    if (kind == "serial" && first != std::string::npos && first + 1 < text.size()) {
        address.name = text.substr(first + 1);
        return address;
    }
    const bool bracketed = text.find('[') == first + 1 && text.find(']') + 1 == last; // an IPv6 address
    const bool one_name = bracketed || text.find(':', first + 1) == last;
    if (kind == "tcp" && last != first && last > first + 1 && one_name) {
        address.is_tcp = true;
        address.name = without_brackets(std::string_view(text).substr(first + 1, last - first - 1));
        if (read_port(std::string_view(text).substr(last + 1), address.port))
            return address;
    }
    throw InputError(place, fmt::format("'{}' is not an address of a device that takes samples", text),
                     "give \"tcp:HOST:PORT\", \"serial:PATH\", or a VISA name such as TCPIP0::HOST::PORT::SOCKET");
}

InstrumentAddress generator_address(const std::string& text, const Place& place) {
    const bool named = is_visa_name(text) || text.starts_with("tcp:") || text.starts_with("serial:");
    return named ? device_address(text, place) : InstrumentAddress{false, text, 0};
}

} // namespace graze
