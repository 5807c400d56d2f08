// For any lines sent to it, a simulated function generator stays within its limits and answers in lines.

#include "instrument/function_generator.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    graze::FunctionGenerator generator;
    generator.execute("SYST:REM");
    std::string_view text(reinterpret_cast<const char*>(data), size);
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::string answer = generator.execute(text.substr(0, end));
        const graze::GeneratorOutput& now = generator.output();
        constexpr double roundoff = 1e-9;
        const bool good = now.amplitude >= 0.05 - roundoff && now.amplitude <= 10 + roundoff &&
                          std::abs(now.offset) + now.amplitude / 2 <= 5 + roundoff && now.frequency >= 1e-4 &&
                          now.frequency <= 15e6 && generator.errors().size() <= 20;
        if (!good || answer.find('\n') != std::string::npos)
            std::abort();
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    return 0;
}
