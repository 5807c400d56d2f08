// For any bytes, reading a design either succeeds or throws an InputError.

#include "graze/base/input_error.hpp"
#include "graze/design/design.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        graze::parse_design({reinterpret_cast<const char*>(data), size}, "/nowhere/fuzz.toml");
    } catch (const graze::InputError&) {
        return 0;
    }
    return 0;
}
