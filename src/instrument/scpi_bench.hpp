#pragma once

#include "graze/bench/virtual_bench.hpp"
#include "instrument/function_generator.hpp"

#include <string>
#include <string_view>

namespace graze {

/// A virtual bench whose generator is controlled by SCPI lines.
class ScpiBench : public VirtualBench {
public:
    /// @param generator its `takes_offset` is ignored: it takes offsets if the bench has a parameter for them
    /// @throws InputError for settings out of range, and for a model that cannot be simulated
    explicit ScpiBench(const BenchSettings& settings, const GeneratorSettings& generator = {})
        : VirtualBench(settings), generator_({settings.offset.has_value(), generator.clip, generator.left_as}) {}

    /// Executes a line on the generator; see FunctionGenerator::execute.
    std::string command(std::string_view line) {
        std::string answer = generator_.execute(line);
        drive(generator_.output());
        return answer;
    }
    const FunctionGenerator& generator() const { return generator_; }
    FunctionGenerator& generator() { return generator_; }

private:
    FunctionGenerator generator_;
};

} // namespace graze
