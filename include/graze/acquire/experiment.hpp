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

/// Setting of the generator for one record.
struct Level {
    std::size_t number = 0; ///< number of the record, from 1
    double frequency = 0;   ///< in Hz
    double amplitude = 0;   ///< V, peak to peak
    int direction = 0;      ///< +1 if the level was reached from below, -1 from above, 0 if nothing is stepped
    std::size_t leg = 0;    ///< index of the amplitude sweep that the level belongs to
};

/// How long to wait after a level has been set. By default only `time` passes; with a reference channel, until
/// stroboscopic sections repeat.
struct SettlingOptions {
    double time = 0;         ///< shortest wait, in s
    double most = 0;         ///< longest wait, in s; then the record is taken even if sections do not repeat
    std::string reference{}; ///< channel whose periods define the sections; empty: wait for `time` only
    double phase = 0;        ///< phase of the section, as a part of the period
    struct Tolerance {
        std::string channel;
        double size = 0; ///< largest difference of repeating sections: the noise of the channel
    };
    std::vector<Tolerance> tolerances{};
    std::size_t repeats = 5; ///< number of consecutive repetitions required
    std::size_t period = 8;  ///< longest period of the motion, in periods of the reference
};

/// An experiment: a sequence of generator levels, with a record at each (docs/experiment.md).
struct Experiment {
    std::string name, text, file;
    SerialSettings serial; ///< generator's line; its port may also be a VISA name, see generator_address
    GeneratorOptions generator;
    double safe = 0; ///< safe amplitude, in V peak to peak: set before, after, and on any error
    double offset = 0;
    std::string device;            ///< address of the device that takes samples, see device_address
    unsigned sample_baud = 115200; ///< baud rate of the device's serial line (one stop bit, no parity, no flow control)
    double sample_timeout = 5;
    double sample_patience = 10;         ///< samples may take this many times their duration to arrive
    double rate = 0;                     ///< samples per second
    std::size_t samples = 0;             ///< samples of a record
    std::vector<std::string> channels{}; ///< recorded channels; empty: all
    bool hdf5 = false;
    SettlingOptions settling;
    /// Time in s at each earlier level when resuming with a device that cannot return to a stored state; empty: as long
    /// as when it was recorded.
    std::optional<double> walk{};
    std::vector<Level> levels;

    /// Returns the name of a record's file, such as "0012_f6100mHz_a5510mV_up.csv".
    std::string record_name(const Level& level) const;
    /// Returns the settings that records depend on, one per line: records of other settings must not be added to the
    /// same folder.
    std::string settings() const;
};

/// Reads an experiment, and checks that all its levels are within its limits.
/// @param file the name to use in messages
/// @throws InputError with place and remedy for an error, InputErrors for several
Experiment parse_experiment(std::string_view text, const std::string& file);
Experiment read_experiment(const std::string& path);

} // namespace graze
