// For any bytes, reading an experiment either succeeds, and the experiment stays within its own limits, or throws an
// InputError.

#include "graze/acquire/experiment.hpp"
#include "graze/base/input_error.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const graze::Experiment experiment =
            graze::parse_experiment({reinterpret_cast<const char*>(data), size}, "/nowhere/fuzz.toml");
        for (const graze::Level& level : experiment.levels)
            if (!(level.amplitude <= experiment.generator.limits.amplitude) ||
                experiment.record_name(level).find('/') != std::string::npos)
                std::abort();
    } catch (const graze::InputError&) {
        return 0;
    }
    return 0;
}
