#pragma once

#include "graze/bench/bench_settings.hpp"
#include "graze/model/catalogue.hpp"

#include <initializer_list>

namespace graze::testing {

/// Settings of a bench with the electromagnetic testbed and these channels.
inline BenchSettings testbed(std::initializer_list<const char*> channels) {
    BenchSettings settings;
    settings.model = load_model("electromagnetic-testbed");
    settings.amplitude = driven_input(settings.model, "V0", "--amplitude");
    settings.frequency = driven_input(settings.model, "f", "--frequency");
    for (const char* channel : channels)
        settings.channels.push_back(bench_channel(settings.model, channel, "--channel"));
    return settings;
}

} // namespace graze::testing
