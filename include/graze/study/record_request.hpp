#pragma once

#include "graze/base/input_error.hpp"
#include "graze/bench/bench_settings.hpp"
#include "graze/record/processed_record.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A file with a record.
struct RecordInput {
    std::string name;          ///< as the study has it: relative to the study
    std::string path;          ///< where that is; empty: not known any more, as of studies from a result file
    std::uint64_t bytes = 0;   ///< its length
    std::string hash;          ///< of what is in it
    std::size_t direction = 0; ///< index in RecordRequest::directions
};

/// What is taken from records.
struct RecordSampling {
    enum class Kind {
        record,       ///< all rows
        section,      ///< values at a part of each period
        maxima,       ///< values where a channel is greatest in each period
        minima,       ///< and where it is least
        peak_to_peak, ///< greatest less least of each value in each period
        amplitude,    ///< of each value in each period, at the period's frequency
        impacts,      ///< values just before jumps of a channel; just after, in a sampling of its own: NAME_after
    };
    std::string name;
    Kind kind = Kind::record;
    double phase = 0;                 ///< of sections
    std::vector<std::string> negated; ///< of sections: values whose signs change, for the image half a period later
    std::string channel;              ///< of maxima, minima and impacts
    std::string displacement;         ///< of impacts; empty: none
    std::size_t window = 12, transition = 0;
    double least_jump = 0;

    /// Whether it needs periods of a reference.
    bool is_periodic() const { return kind != Kind::record && kind != Kind::impacts; }
};

/// Records made by a virtual bench in this process, instead of files: one for each level of a parameter.
struct RecordBench {
    Model model;
    std::string parameter;                 ///< that is stepped
    std::vector<double> levels;            ///< in the order in which they are gone through
    std::vector<std::size_t> directions;   ///< of the levels: index in RecordRequest::directions
    std::size_t repeats = 1;               ///< records at each level; more than one only of levels that begin anew
    bool carry = true;                     ///< the motion goes on from level to level
    double settle = 0, time = 0, rate = 0; ///< s before each record, s of it, samples in a second
    double time_unit = 1;                  ///< seconds that a unit of the model's time lasts
    std::vector<BenchChannel> channels;
    int bits = 16;
    double anti_alias = 0;
    std::uint64_t seed = 1;
};

/// What runs of kind record ask for.
struct RecordRequest {
    std::vector<RecordInput> inputs;
    std::optional<RecordBench> bench; ///< in place of files
    std::vector<std::string> directions{""};
    RecordProcessing processing;
    struct Kept {
        std::string name, channel; ///< what the run calls it, and what the record does
    };
    std::vector<Kept> channels; ///< that are there for values; each is a state of the run's model
    std::string reference;      ///< one of them, whose rising crossings begin periods; empty: there are none
    double level = 0, hysteresis = 0;
    std::string coordinate; ///< how the averaged amplitude of the reference is called; empty: there is none
    std::vector<RecordSampling> samplings;
    std::size_t keep = 1'000'000; ///< rows of a record that are kept; of longer ones none are

    /// How many records there are.
    std::size_t records() const { return bench ? bench->levels.size() * bench->repeats : inputs.size(); }
    /// In the order of the results, what follows impacts included.
    std::vector<std::string> sampling_names() const;
};

} // namespace graze
