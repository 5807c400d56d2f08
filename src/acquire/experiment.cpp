#include "graze/acquire/experiment.hpp"

#include "acquire/experiment_reader.hpp"
#include "graze/base/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

namespace graze {

std::string Experiment::record_name(const Level& level) const {
    constexpr double thousandths = 1000;
    return fmt::format("{:04d}_f{:.0f}mHz_a{:.0f}mV_{}.{}", level.number, level.frequency * thousandths,
                       level.amplitude * thousandths,
                       level.direction > 0   ? "up"
                       : level.direction < 0 ? "down"
                                             : "only",
                       hdf5 ? "h5" : "csv");
}

std::string Experiment::settings() const {
    std::string lines = fmt::format("experiment {}\noffset {}\nrate {}\nsamples {}\nformat {}\nchannels {}\n", name,
                                    offset, rate, samples, hdf5 ? "h5" : "csv", fmt::join(channels, ","));
    lines += fmt::format("settle {} {} {} {} {} {}\n", settling.time, settling.most, settling.reference, settling.phase,
                         settling.repeats, settling.period);
    if (generator.load != GeneratorOptions().load) // older folders have no such line
        lines += fmt::format("load {}\n", generator.load);
    for (const SettlingOptions::Tolerance& tolerance : settling.tolerances)
        lines += fmt::format("tolerance {} {}\n", tolerance.channel, tolerance.size);
    for (const Level& level : levels)
        fmt::format_to(std::back_inserter(lines), "level {} {} {} {}\n", level.number, level.frequency, level.amplitude,
                       level.direction);
    return lines;
}

Experiment parse_experiment(std::string_view text, const std::string& file) {
    const toml::table root = parse_toml(text, file, "docs/experiment.md shows how an experiment is written");
    return ExperimentReader(file).read(root);
}

Experiment read_experiment(const std::string& path) {
    return parse_experiment(read_text_file(path, "experiment", longest_model), path);
}

} // namespace graze
