// For any bytes, reading a study either succeeds or throws an InputError; a study that was read can be written again.

#include "graze/base/input_error.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/stored_study.hpp"
#include "graze/study/study.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const graze::Study study =
            graze::parse_study({reinterpret_cast<const char*>(data), size}, "/nowhere/fuzz.toml");
        for (const graze::StudyRun& run : study.runs)
            graze::settings_of(run);
    } catch (const graze::InputError&) {
        return 0;
    }
    return 0;
}
