#include "graze/acquire/experiment.hpp"

#include "graze/base/file_name.hpp"
#include "graze/base/input_errors.hpp"
#include "graze/base/rounded.hpp"
#include "graze/base/text_file.hpp"
#include "graze/base/trimmed.hpp"
#include "model/model_file_toml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <map>

namespace graze {

namespace {

constexpr std::size_t most_levels = 10'000;
constexpr double longest_time = 1e6; // s
constexpr double most_volts = 1000;  // V; the generator's own range is given by `limits`
constexpr double most_hertz = 1e9;
constexpr double most_rate = 1e7;
constexpr double most_rows = 1e9;

template <class Work>
void with(const std::map<std::string, TomlEntry>& keys, const char* name, const Work& work) {
    if (const auto found = keys.find(name); found != keys.end())
        work(found->second);
}

/// A table that lacks one of its keys.
[[noreturn]] void fail_missing(const TomlEntry& entry, std::string_view key, const std::string& remedy) {
    throw InputError(entry.place, fmt::format("{} has no {}", entry.path, key), remedy);
}

/// Reads an experiment from TOML; after an error in one table the others are still read.
class ExperimentReader {
public:
    explicit ExperimentReader(const std::string& file) : toml_(file) { experiment_.file = file; }

    Experiment read(const toml::table& root) {
        for (const TomlEntry& entry : toml_.entries(root, "")) {
            tables_.emplace(entry.name, entry);
            mistakes_.attempt([&] {
                toml_.require_known(
                    entry, "",
                    {"name", "text", "generator", "limits", "samples", "sweep", "settle", "record", "resume"});
            });
        }
        const Place top{experiment_.file, 1, 1};
        const auto part = [&](const char* name, void (ExperimentReader::*work)(const TomlEntry&), const char* remedy) {
            mistakes_.attempt([&] {
                const auto found = tables_.find(name);
                if (found != tables_.end())
                    (this->*work)(found->second);
                else if (*remedy != '\0')
                    throw InputError(top, fmt::format("the experiment has no {}", name), remedy);
            });
        };
        mistakes_.attempt([&] {
            if (!tables_.contains("name"))
                throw InputError(top, "the experiment has no name", "give name = \"...\" in its first line");
            experiment_.name = toml_.string(tables_.at("name"));
            require_file_name(experiment_.name, "name of an experiment", toml_.place(*tables_.at("name").node));
            with(tables_, "text", [&](const TomlEntry& e) { experiment_.text = toml_.string(e); });
        });
        part("generator", &ExperimentReader::read_generator, "add a table [generator] with port = \"/dev/ttyUSB0\"");
        part("limits", &ExperimentReader::read_limits,
             "add a table [limits] with the largest amplitude that does no harm, and a safe one");
        part("samples", &ExperimentReader::read_samples, "add a table [samples] with device and rate");
        part("sweep", &ExperimentReader::read_sweep, "add a table [sweep] with frequency and amplitude");
        part("settle", &ExperimentReader::read_settle, "");
        part("record", &ExperimentReader::read_record, "add a table [record] with time = SECONDS");
        part("resume", &ExperimentReader::read_resume, "");
        mistakes_.throw_noted();
        mistakes_.attempt([&] { check(); });
        mistakes_.throw_noted();
        return std::move(experiment_);
    }

private:
    using Keys = std::map<std::string, TomlEntry>;
    /// A value of a sweep, with the direction from which it is reached.
    struct Stepped {
        double value = 0;
        int direction = 0;
    };

    void fail(const TomlEntry& entry, const std::string& problem, const std::string& remedy) const {
        throw InputError(toml_.place(*entry.node), problem, remedy);
    }

    Keys keys_of(const TomlEntry& entry, const std::vector<std::string>& known) const {
        Keys keys;
        for (const TomlEntry& one : toml_.entries(toml_.table(entry), entry.path, known))
            keys.emplace(one.name, one);
        return keys;
    }

    double number(const TomlEntry& entry, double least, double most) const {
        const std::optional<double> value = entry.node->value<double>();
        if (!entry.node->is_number() || !value)
            toml_.fail_type(entry, "a number");
        if (!(*value >= least && *value <= most))
            fail(entry, fmt::format("{} is {}", entry.path, *value), fmt::format("give from {} to {}", least, most));
        return *value;
    }

    std::size_t count(const TomlEntry& entry, std::size_t least, std::size_t most) const {
        const std::optional<std::int64_t> value = entry.node->value_exact<std::int64_t>();
        if (const auto broken = entry.node->value_exact<double>())
            fail(entry, fmt::format("{} is {}", entry.path, *broken),
                 fmt::format("give a whole number from {} to {}", least, most));
        if (!value)
            toml_.fail_type(entry, "a whole number");
        if (*value < static_cast<std::int64_t>(least) || *value > static_cast<std::int64_t>(most))
            fail(entry, fmt::format("{} is {}", entry.path, *value), fmt::format("give from {} to {}", least, most));
        return static_cast<std::size_t>(*value);
    }

    std::size_t choice(const TomlEntry& entry, std::initializer_list<std::string_view> words) const {
        const std::string word = toml_.line(entry);
        const auto* found = std::find(words.begin(), words.end(), word);
        if (found == words.end())
            fail(entry, fmt::format("{} is '{}'", entry.path, word),
                 fmt::format("give one of {}", fmt::join(words, ", ")));
        return static_cast<std::size_t>(found - words.begin());
    }

    std::vector<std::string> names(const TomlEntry& entry) const {
        std::vector<std::string> result;
        for (const TomlEntry& one : toml_.elements(entry)) {
            result.push_back(toml_.line(one));
            if (result.back().find_first_of(",;\t") != std::string::npos || trimmed(result.back()).empty())
                fail(one, fmt::format("'{}' is not a name of a channel", result.back()),
                     "give names one by one, as [\"V\", \"I\"]");
            if (std::count(result.begin(), result.end(), result.back()) > 1)
                fail(one, fmt::format("'{}' occurs twice", result.back()), "name it once");
        }
        return result;
    }

    std::vector<Stepped> values(const TomlEntry& entry, double least, double most) const {
        std::vector<Stepped> result;
        if (entry.node->is_number())
            return {{number(entry, least, most), 0}};
        if (entry.node->is_array()) {
            for (const TomlEntry& one : toml_.elements(entry)) {
                const double value = number(one, least, most);
                const int direction = result.empty() ? 0 : value > result.back().value ? 1 : -1;
                result.push_back({value, direction});
            }
            if (result.empty() || result.size() > most_levels)
                fail(entry, fmt::format("{} has {} values", entry.path, result.size()),
                     fmt::format("give from 1 to {}", most_levels));
            if (result.size() > 1)
                result.front().direction = result[1].direction;
            return result;
        }
        const Keys keys = keys_of(entry, {"from", "to", "step", "back"});
        for (const char* name : {"from", "to", "step"})
            if (!keys.contains(name))
                fail(entry, fmt::format("{} has no {}", entry.path, name),
                     "give a number, a list of them, or { from = A, to = B, step = S, back = true }");
        const double from = number(keys.at("from"), least, most), to = number(keys.at("to"), least, most);
        const double step = number(keys.at("step"), 0, most), steps = std::round(std::abs(to - from) / step);
        if (!(steps >= 1 && steps < most_levels))
            fail(keys.at("step"), fmt::format("{} makes {} steps", keys.at("step").path, steps),
                 fmt::format("give one that makes from 1 to {}", most_levels - 1));
        constexpr double close = 1e-6; // of a step
        if (std::abs(std::abs(to - from) - steps * step) > close * step)
            fail(keys.at("step"), fmt::format("steps from {} do not reach {} with a step of {}", from, to, step),
                 "give a step that divides the range");
        const int direction = to > from ? 1 : -1;
        const auto last = static_cast<std::size_t>(steps);
        for (std::size_t i = 0; i <= last; ++i)
            // Sums of steps differ from the intended value in the last bits.
            result.push_back(
                {i == last ? to : rounded(from + direction * static_cast<double>(i) * step, 12), direction});
        bool back = false;
        with(keys, "back", [&](const TomlEntry& e) { back = toml_.boolean(e); });
        for (std::size_t i = 0; back && i <= last; ++i)
            result.push_back({result[last - i].value, -direction});
        return result;
    }

    void read_generator(const TomlEntry& entry) {
        const Keys keys = keys_of(entry, {"port", "baud", "parity", "stop_bits", "data_bits", "flow", "timeout",
                                          "attempts", "tolerance", "identity", "load"});
        SerialSettings& serial = experiment_.serial;
        GeneratorOptions& generator = experiment_.generator;
        with(keys, "port", [&](const TomlEntry& e) {
            serial.port = toml_.line(e);
            generator_address(serial.port, toml_.place(*e.node));
        });
        with(keys, "load", [&](const TomlEntry& e) {
            if (e.node->is_string()) {
                choice(e, {"infinite"});
                generator.load = std::numeric_limits<double>::infinity();
            } else {
                generator.load = number(e, 1, 1e6);
            }
        });
        with(keys, "baud", [&](const TomlEntry& e) { serial.baud = static_cast<unsigned>(count(e, 50, 4'000'000)); });
        with(keys, "data_bits", [&](const TomlEntry& e) { serial.data_bits = static_cast<unsigned>(count(e, 7, 8)); });
        with(keys, "parity", [&](const TomlEntry& e) {
            serial.parity = static_cast<Parity>(choice(e, {"none", "odd", "even"}));
        });
        with(keys, "stop_bits", [&](const TomlEntry& e) {
            const double bits = number(e, 1, 2);
            if (bits != 1 && bits != 1.5 && bits != 2)
                fail(e, fmt::format("there are no {} stop bits", bits), "give 1, 1.5 or 2");
            serial.stop_bits = bits == 1 ? StopBits::one : bits == 2 ? StopBits::two : StopBits::one_and_a_half;
        });
        with(keys, "flow", [&](const TomlEntry& e) {
            serial.flow = static_cast<FlowControl>(choice(e, {"none", "software", "hardware"}));
        });
        with(keys, "timeout", [&](const TomlEntry& e) { generator.timeout = number(e, 0.01, 600); });
        with(keys, "attempts", [&](const TomlEntry& e) { generator.attempts = static_cast<int>(count(e, 1, 100)); });
        with(keys, "tolerance", [&](const TomlEntry& e) { generator.tolerance = number(e, 0, 0.1); });
        with(keys, "identity", [&](const TomlEntry& e) {
            generator.identity = toml_.line(e);
            if (trimmed(generator.identity).empty())
                fail(e, fmt::format("{} is empty", e.path),
                     "give a text that its answer to *IDN? contains, or leave the key out");
        });
    }

    void read_limits(const TomlEntry& entry) {
        const Keys keys = keys_of(entry, {"amplitude", "safe", "offset", "frequency"});
        GeneratorLimits& limits = experiment_.generator.limits;
        for (const char* name : {"amplitude", "safe"})
            if (!keys.contains(name))
                fail_missing(entry, name,
                             name[0] == 's' ? "give the amplitude at which the output may be left, as safe = 0.1"
                                            : "give the largest one that does no harm, as amplitude = 7");
        limits.amplitude = number(keys.at("amplitude"), 0, most_volts);
        experiment_.safe = number(keys.at("safe"), 0, limits.amplitude);
        with(keys, "offset", [&](const TomlEntry& e) { limits.offset = number(e, 0, most_volts); });
        with(keys, "frequency", [&](const TomlEntry& e) {
            const auto both = toml_.elements(e);
            if (both.size() != 2)
                fail(e, fmt::format("{} has {} numbers", e.path, both.size()), "give [LEAST, GREATEST]");
            const double least = number(both[0], 0, most_hertz), greatest = number(both[1], 0, most_hertz);
            if (!(least <= greatest))
                fail(e, fmt::format("{} goes from {} to {}", e.path, least, greatest), "give the smaller one first");
            limits.least_frequency = least;
            limits.greatest_frequency = greatest;
        });
        has_limits_ = true;
    }

    void read_samples(const TomlEntry& entry) {
        const Keys keys = keys_of(entry, {"device", "baud", "rate", "timeout", "patience", "channels"});
        with(keys, "device", [&](const TomlEntry& e) {
            experiment_.device = toml_.line(e);
            device_address(experiment_.device, toml_.place(*e.node));
        });
        with(keys, "baud",
             [&](const TomlEntry& e) { experiment_.sample_baud = static_cast<unsigned>(count(e, 50, 4'000'000)); });
        if (!keys.contains("rate"))
            fail_missing(entry, "rate", "give rate = 1000, in a second");
        experiment_.rate = number(keys.at("rate"), 1e-3, most_rate);
        with(keys, "timeout", [&](const TomlEntry& e) { experiment_.sample_timeout = number(e, 0.01, 3600); });
        with(keys, "patience", [&](const TomlEntry& e) { experiment_.sample_patience = number(e, 1, 1e6); });
        with(keys, "channels", [&](const TomlEntry& e) { experiment_.channels = names(e); });
    }

    void read_sweep(const TomlEntry& entry) {
        const Keys keys = keys_of(entry, {"frequency", "amplitude", "offset"});
        for (const char* name : {"frequency", "amplitude"})
            if (!keys.contains(name))
                fail_missing(entry, name,
                             "give a number, a list of them, or { from = A, to = B, step = S, back = true }");
        const GeneratorLimits& limits = experiment_.generator.limits;
        with(keys, "offset", [&](const TomlEntry& e) { experiment_.offset = number(e, -most_volts, most_volts); });
        const auto frequencies = values(keys.at("frequency"), 1e-6, most_hertz);
        const auto amplitudes = values(keys.at("amplitude"), 0, most_volts);
        if (frequencies.size() * amplitudes.size() > most_levels)
            throw InputError(entry.place, fmt::format("there are {} levels", frequencies.size() * amplitudes.size()),
                             fmt::format("give up to {}", most_levels));
        const auto beyond = [&](const char* name, double value, double least, double most) {
            fail(keys.at(name), fmt::format("the {} {} is beyond the limits, {} to {}", name, value, least, most),
                 "nothing has been sent; change the sweep, or the limits if they may be changed");
        };
        for (const Stepped& frequency : frequencies)
            if (!(frequency.value >= limits.least_frequency && frequency.value <= limits.greatest_frequency))
                beyond("frequency", frequency.value, limits.least_frequency, limits.greatest_frequency);
        for (const Stepped& amplitude : amplitudes)
            if (has_limits_ && !(amplitude.value <= limits.amplitude))
                beyond("amplitude", amplitude.value, 0, limits.amplitude);
        if (has_limits_ && std::abs(experiment_.offset) > limits.offset)
            beyond("offset", experiment_.offset, -limits.offset, limits.offset);
        std::size_t leg = 0;
        for (const Stepped& frequency : frequencies) {
            for (const Stepped& amplitude : amplitudes)
                experiment_.levels.push_back({experiment_.levels.size() + 1, frequency.value, amplitude.value,
                                              amplitudes.size() > 1 ? amplitude.direction : frequency.direction, leg});
            leg += amplitudes.size() > 1 ? 1 : 0; // a sweep of frequencies alone is one leg
        }
    }

    void read_settle(const TomlEntry& entry) {
        const Keys keys = keys_of(entry, {"time", "most", "reference", "phase", "tolerance", "repeats", "period"});
        SettlingOptions& settling = experiment_.settling;
        with(keys, "time", [&](const TomlEntry& e) { settling.time = number(e, 0, longest_time); });
        settling.most = settling.time;
        with(keys, "reference", [&](const TomlEntry& e) { settling.reference = toml_.line(e); });
        for (const char* name : {"most", "phase", "tolerance", "repeats", "period"})
            if (settling.reference.empty() && keys.contains(name))
                fail(keys.at(name), fmt::format("{} applies to sections, which need a reference channel", name),
                     "add reference = \"CHANNEL\", or leave it out");
        with(keys, "phase", [&](const TomlEntry& e) { settling.phase = number(e, 0, 1); });
        with(keys, "repeats", [&](const TomlEntry& e) { settling.repeats = count(e, 1, 1000); });
        with(keys, "period", [&](const TomlEntry& e) { settling.period = count(e, 1, 100); });
        if (settling.reference.empty())
            return;
        for (const char* name : {"most", "tolerance"})
            if (!keys.contains(name))
                fail_missing(entry, name,
                             name[0] == 'm' ? "give the time after which it is recorded in any case, most = SECONDS"
                                            : "give by how much sections differ by noise, tolerance = { v = 0.002 }");
        settling.most = number(keys.at("most"), settling.time, longest_time);
        const TomlEntry& tolerance = keys.at("tolerance");
        for (const TomlEntry& one : toml_.entries(toml_.table(tolerance), tolerance.path))
            settling.tolerances.push_back({one.name, number(one, 0, 1e300)});
        if (settling.tolerances.empty())
            fail(tolerance, fmt::format("{} names no channel", tolerance.path), "give tolerance = { v = 0.002 }");
    }

    void read_record(const TomlEntry& entry) {
        const Keys keys = keys_of(entry, {"time", "format"});
        if (!keys.contains("time"))
            fail_missing(entry, "time", "give time = SECONDS");
        const double rows = std::round(number(keys.at("time"), 0, longest_time) * experiment_.rate);
        if (!(rows >= 1 && rows <= most_rows) && experiment_.rate > 0)
            fail(keys.at("time"), fmt::format("a record would have {} samples", rows),
                 fmt::format("give a time with from 1 to {}", most_rows));
        experiment_.samples = static_cast<std::size_t>(rows);
        with(keys, "format", [&](const TomlEntry& e) { experiment_.hdf5 = choice(e, {"csv", "h5"}) == 1; });
    }

    void read_resume(const TomlEntry& entry) {
        const Keys keys = keys_of(entry, {"walk"});
        with(keys, "walk", [&](const TomlEntry& e) {
            if (e.node->is_string()) {
                choice(e, {"whole"});
                experiment_.walk.reset();
            } else {
                experiment_.walk = number(e, 0, longest_time);
            }
        });
    }

    /// Checks conditions that involve several tables.
    void check() const {
        const auto kept = [&](const std::string& name) {
            return experiment_.channels.empty() || std::find(experiment_.channels.begin(), experiment_.channels.end(),
                                                             name) != experiment_.channels.end();
        };
        std::vector<std::string> needed;
        for (const SettlingOptions::Tolerance& tolerance : experiment_.settling.tolerances)
            needed.push_back(tolerance.channel);
        if (!experiment_.settling.reference.empty())
            needed.push_back(experiment_.settling.reference);
        for (const std::string& name : needed)
            if (!kept(name))
                throw InputError(tables_.at("settle").place,
                                 fmt::format("channel '{}' decides when the system has settled, and is not kept", name),
                                 "add it to the channels of [samples]");
    }

    TomlReader toml_;
    Experiment experiment_;
    Mistakes mistakes_;
    Keys tables_;
    bool has_limits_ = false; ///< and they could be read
};

} // namespace

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
