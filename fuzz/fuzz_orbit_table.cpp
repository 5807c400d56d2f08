// For any bytes, a table of an orbit, or a signature, is read or refused by an InputError. The first line may be a
// signature.

#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/orbit/orbit_file.hpp"
#include "graze/orbit/signature.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const graze::Model model = graze::load_model("impact-oscillator");
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::string_view line = text.substr(0, std::min(text.find('\n'), text.size()));
    try {
        graze::parse_signature(model, line, {"fuzz", 1, 1});
    } catch (const graze::InputError&) { // the table has no signature
    }
    for (const bool with_signature : {false, true})
        try {
            graze::parse_orbit_table(model, with_signature ? text.substr(std::min(line.size() + 1, size)) : text,
                                     with_signature ? line : "", "fuzz.csv");
        } catch (const graze::InputError&) {
            continue;
        }
    return 0;
}
