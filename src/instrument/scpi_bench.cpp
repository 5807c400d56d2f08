#include "instrument/scpi_bench.hpp"

namespace graze {

ScpiBench::ScpiBench(const BenchSettings& settings, const GeneratorSettings& generator)
    : VirtualBench(settings), generator_({settings.offset.has_value(), generator.clip, generator.left_as}) {}

std::string ScpiBench::command(std::string_view line) {
    std::string answer = generator_.execute(line);
    drive(generator_.output());
    return answer;
}

} // namespace graze
