#pragma once

#include "graze/base/input_error.hpp"
#include "graze/bench/bench_settings.hpp"
#include "graze/record/impacts.hpp"
#include "graze/record/processed_record.hpp"
#include "graze/study/motion_request.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A file with a record.
struct RecordInput {
    std::string name;          ///< relative to the study
    std::string path;          ///< of the file; empty: unknown, as in a study that was read from a result file
    std::uint64_t bytes = 0;   ///< length of the file
    std::string hash;          ///< of its contents
    std::size_t direction = 0; ///< index in RecordRequest::directions
};

/// Which samples are taken from a record.
struct RecordSampling {
    enum class Kind {
        record,       ///< all rows
        section,      ///< values at one phase of each period
        maxima,       ///< values where a channel is greatest in each period
        minima,       ///< values where a channel is least in each period
        peak_to_peak, ///< greatest minus least of each value in each period
        amplitude,    ///< of each value in each period, at the period's frequency
        impacts,      ///< values just before each impact; those just after it have a sampling of their own: NAME_after
    };
    std::string name;
    Kind kind = Kind::record;
    double phase = 0;                 ///< of sections: part of a period, 0 ... 1
    std::vector<std::string> negated; ///< of sections: the symmetric image, half a period later, changes these signs
    std::string channel;              ///< of maxima, minima and impacts (whose velocity it is)
    std::string displacement;         ///< of impacts: channel whose corners tell their times; empty: none
    ImpactWindow impacts;

    /// True when the sampling needs a reference channel, which tells the periods.
    bool is_periodic() const { return kind != Kind::record && kind != Kind::impacts; }
};

/// Records that a virtual bench makes in this process, instead of files: one for each level of a parameter.
struct RecordBench {
    Model model;
    std::string parameter;                 ///< the bench steps it
    std::vector<double> levels;            ///< its values, in the order of the records
    std::vector<std::size_t> directions;   ///< of each level: index in RecordRequest::directions
    std::size_t repeats = 1;               ///< records at each level; more than one needs carry = false
    bool carry = true;                     ///< the motion goes on from level to level, instead of beginning anew
    double settle = 0, time = 0, rate = 0; ///< seconds before each record, seconds of it, samples per second
    double time_unit = 1;                  ///< length of the model's unit of time, in seconds
    std::vector<BenchChannel> channels;
    int bits = 16;
    double anti_alias = 0;
    std::uint64_t seed = 1;
};

/// What runs of kind record ask for: records, how they are processed, and which samples are taken from them.
struct RecordRequest {
    VariedValues vary; ///< what a study says that a virtual bench steps; the levels of `bench` follow from it
    std::vector<RecordInput> inputs;
    std::optional<RecordBench> bench; ///< in place of files
    std::vector<std::string> directions{""};
    RecordProcessing processing;
    struct Kept {
        std::string name, channel; ///< its name in the run, and in the record
    };
    std::vector<Kept> channels; ///< that values may use; each is a state of the run's model
    std::string reference;      ///< a kept channel, whose rising crossings begin periods; empty: there are no periods
    double level = 0, hysteresis = 0; ///< of these crossings, see PeriodSettings
    std::string coordinate;           ///< name of the averaged amplitude of the reference; empty: there is no reference
    std::vector<RecordSampling> samplings;
    std::size_t keep = 1'000'000; ///< rows of a record with more rows than this are not kept

    /// Number of records.
    std::size_t records() const { return bench ? bench->levels.size() * bench->repeats : inputs.size(); }
    /// Names in the order of the results; those of what follows impacts included.
    std::vector<std::string> sampling_names() const;
};

} // namespace graze
