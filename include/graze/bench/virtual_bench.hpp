#pragma once

#include "graze/bench/bench_settings.hpp"
#include "graze/bench/generator_output.hpp"
#include "graze/record/samples.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace graze {

/// An experiment without hardware: a generator drives a model, whose motion goes on for as long as the bench lives, and
/// channels measure it. What is set on the generator acts at once, with the phase going on. Nothing here knows of
/// clocks: time passes only when it is told to, so that the same calls give the same samples, bit for bit.
class VirtualBench {
public:
    /// @throws InputError for settings out of range, and for a model that cannot be run
    explicit VirtualBench(const BenchSettings& settings);
    ~VirtualBench();
    VirtualBench(const VirtualBench&) = delete;
    VirtualBench& operator=(const VirtualBench&) = delete;

    /// What the generator gives from now on.
    void drive(const GeneratorOutput& output);

    const RecordHeader& header() const;
    double rate() const; ///< samples in a second
    /// @throws InputError unless it is from 1e-3 to 1e7, and more than twice the corner of the filter
    void set_rate(double rate);
    double time() const; ///< in seconds since the bench was made
    /// The next samples, the first of them now, with times from the bench's beginning. Afterwards it is `count` steps
    /// later. Fewer come when the motion ends: see `ended`.
    void sample(std::size_t count, Samples& samples);
    /// Time passes without samples. Filters are then as after a long time.
    void pass(double seconds);
    /// Why the motion does not go on, in one line; empty while it does.
    const std::string& ended() const;

    /// Keeps how everything but the generator is now under a number; of several, the last four are kept.
    void mark(std::uint64_t number);
    /// Makes it so again. @return false when nothing is kept under that number
    bool return_to(std::uint64_t number);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace graze
