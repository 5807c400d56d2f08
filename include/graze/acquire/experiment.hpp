#pragma once

#include "graze/acquire/generator_client.hpp"
#include "graze/acquire/instrument_address.hpp"
#include "graze/acquire/serial_line.hpp"
#include "graze/base/input_error.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// What the generator is set to for one record.
struct Level {
    std::size_t number = 0; ///< of the record, from 1
    double frequency = 0;   ///< in Hz
    double amplitude = 0;   ///< in V from peak to peak
    int direction = 0;      ///< +1 on the way up, -1 on the way down, 0 where nothing is stepped
    std::size_t leg = 0;    ///< counts the frequencies
};

/// How long the system is waited for after a level has been set.
struct SettlingOptions {
    double time = 0; ///< s, in any case
    double most = 0; ///< s, with what follows; where sections do not repeat until then, it is recorded nevertheless
    std::string reference{}; ///< channel whose periods count; empty: only the time does
    double phase = 0;        ///< part of the period
    struct Tolerance {
        std::string channel;
        double size = 0; ///< by which sections may differ, which is what noise does
    };
    std::vector<Tolerance> tolerances{};
    std::size_t repeats = 5; ///< sections that repeat, one after the other
    std::size_t period = 8;  ///< up to so many periods long a motion may be
};

/// An experiment: levels of a generator, one after the other, with a record at each (docs/experiment.md).
struct Experiment {
    std::string name, text, file;
    SerialSettings serial; ///< of the generator; its port may also be a name of VISA, see generator_address
    GeneratorOptions generator;
    double safe = 0; ///< amplitude, in V from peak to peak, before, after, and whenever anything goes wrong
    double offset = 0;
    std::string device;            ///< see device_address
    unsigned sample_baud = 115200; ///< of a serial line; it has one stop bit, no parity and no flow control
    double sample_timeout = 5;
    double sample_patience = 10;         ///< how many times as long as samples last they may take to come
    double rate = 0;                     ///< samples in a second
    std::size_t samples = 0;             ///< of a record
    std::vector<std::string> channels{}; ///< that are kept; none: all
    bool hdf5 = false;
    SettlingOptions settling;
    /// s at each level before, when the experiment goes on with a device that cannot return; none: as long as if each
    /// were recorded again.
    std::optional<double> walk{};
    std::vector<Level> levels;

    /// Name of a record's file, such as "0012_f6100mHz_a5510mV_up.csv".
    std::string record_name(const Level& level) const;
    /// What records depend on, a line each: those of another one must not come into the same folder.
    std::string settings() const;
};

/// Reads an experiment. All that it will send is within its limits.
/// @param file the name to use in messages
/// @throws InputError with place and remedy for whatever is wrong, InputErrors for several things
Experiment parse_experiment(std::string_view text, const std::string& file);
Experiment read_experiment(const std::string& path);

} // namespace graze
