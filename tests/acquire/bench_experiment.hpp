#pragma once

#include "base/temporary_folder.hpp"
#include "bench/testbed.hpp"
#include "graze/acquire/experiment.hpp"
#include "instrument/scpi_bench.hpp"

#include <gtest/gtest.h>

#include <string>

namespace graze::testing {

/// Settings of a bench: the testbed with noise and converters.
inline BenchSettings testbed_bench() {
    BenchSettings settings = testbed({"V=voltage:V", "I=I:A", "q=q:m", "v=v:m/s"});
    settings.channels[3].noise = 1e-3;
    settings.channels[3].range = 1;
    return settings;
}

/// An experiment of six levels, up and down.
inline std::string experiment_text(const std::string& more = "", const std::string& port = "none",
                                   const std::string& device = "tcp:127.0.0.1:1") {
    return "name = \"sweep\"\n[generator]\nport = \"" + port +
           "\"\ntimeout = 0.2\nidentity = \"33120A\"\n"
           "[limits]\namplitude = 10\nsafe = 0.1\nfrequency = [1, 20]\n"
           "[samples]\ndevice = \"" +
           device +
           "\"\nrate = 500\ntimeout = 1\n"
           "[sweep]\nfrequency = 6.1\namplitude = { from = 9.4, to = 9.6, step = 0.1, back = true }\n"
           "[settle]\ntime = 0.5\n[record]\ntime = 1\n" +
           more;
}

/// The text with a part replaced.
inline std::string replaced(std::string text, const std::string& part, const std::string& by) {
    const std::size_t at = text.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return at == std::string::npos ? text : text.replace(at, part.size(), by);
}

} // namespace graze::testing
