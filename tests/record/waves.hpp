#pragma once

#include "graze/record/samples.hpp"

#include <functional>
#include <string>
#include <vector>

namespace graze::testing {

/// A record of functions of time, sampled at a given frequency.
inline Samples sampled(double frequency, std::size_t count, const std::vector<std::function<double(double)>>& functions,
                       double begin = 0) {
    Samples samples;
    samples.clear(functions.size());
    for (std::size_t i = 0; i < count; ++i) {
        const double t = begin + static_cast<double>(i) / frequency;
        samples.times.push_back(t);
        for (std::size_t c = 0; c < functions.size(); ++c)
            samples.values[c].push_back(functions[c](t));
    }
    return samples;
}

inline RecordHeader named(const std::vector<std::string>& names) {
    RecordHeader header{{"t", "s"}, {}};
    for (const std::string& name : names)
        header.channels.push_back({name, ""});
    return header;
}

} // namespace graze::testing
