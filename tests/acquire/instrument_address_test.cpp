#include "graze/acquire/instrument_address.hpp"

#include <gtest/gtest.h>

namespace graze::instrument_address_test {

void expect_address(const InstrumentAddress& address, bool is_tcp, const std::string& name, unsigned short port) {
    EXPECT_EQ(address.is_tcp, is_tcp);
    EXPECT_EQ(address.name, name);
    EXPECT_EQ(address.port, port);
}

TEST(InstrumentAddress, IsReadFromVisaNames) {
    for (const char* name : {"ASRL/dev/ttyUSB0::INSTR", "ASRL/dev/ttyUSB0::instr", "asrl/dev/ttyUSB0::INSTR"})
        expect_address(generator_address(name, {}), false, "/dev/ttyUSB0", 0);
    for (const char* name : {"TCPIP0::192.168.1.5::5025::SOCKET", "TCPIP::192.168.1.5::5025::SOCKET",
                             "tcpip1::192.168.1.5::5025::socket"}) {
        expect_address(generator_address(name, {}), true, "192.168.1.5", 5025);
        expect_address(device_address(name, {}), true, "192.168.1.5", 5025);
    }
    expect_address(device_address("TCPIP0::[fe80::1]::5025::SOCKET", {}), true, "fe80::1", 5025);
}

TEST(InstrumentAddress, IsReadFromTcpAndSerialForms) {
    expect_address(generator_address("/dev/ttyUSB0", {}), false, "/dev/ttyUSB0", 0);
    expect_address(generator_address("tcp:localhost:5025", {}), true, "localhost", 5025);
    expect_address(device_address("tcp:[::1]:4711", {}), true, "::1", 4711);
    expect_address(device_address("serial:/dev/ttyS1", {}), false, "/dev/ttyS1", 0);
    EXPECT_THROW(device_address("/dev/ttyS1", {}), InputError);
}

TEST(InstrumentAddress, IsRefusedIfItCannotBeUsed) {
    for (const char* name :
         {"TCPIP0::192.168.1.5::INSTR", "TCPIP0::192.168.1.5::hislip0::INSTR", "TCPIP0::192.168.1.5::0::SOCKET",
          "TCPIP0::192.168.1.5::70000::SOCKET", "TCPIP0::::5025::SOCKET", "TCPIPx::a::5025::SOCKET", "ASRL3::INSTR",
          "ASRL::INSTR", "ASRL/dev/ttyUSB0::SOCKET", "ASRL/dev/ttyUSB0::INSTR::1"})
        EXPECT_THROW(generator_address(name, {}), InputError) << name;
}

} // namespace graze::instrument_address_test
