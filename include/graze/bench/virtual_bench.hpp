#pragma once

#include "graze/bench/bench_settings.hpp"
#include "graze/bench/generator_output.hpp"
#include "graze/record/samples.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace graze {

/// A simulated experiment: a generator drives a model, and channels measure its motion, which goes on for as long as
/// the bench exists. Settings of the generator act at once, with continuous phase. The bench uses no clock: time passes
/// only in calls of `sample` and `pass`, so that the same calls give the same samples, bit for bit.
class VirtualBench {
public:
    /// @throws InputError for settings out of range, and for a model that cannot be simulated
    explicit VirtualBench(const BenchSettings& settings);
    ~VirtualBench();
    VirtualBench(const VirtualBench&) = delete;
    VirtualBench& operator=(const VirtualBench&) = delete;

    /// Sets the generator.
    void drive(const GeneratorOutput& output);

    const RecordHeader& header() const;
    double rate() const; ///< samples per second
    /// @throws InputError unless the rate is from 1e-3 to 1e7, and more than twice the corner of the filter
    void set_rate(double rate);
    double time() const; ///< seconds since the bench was created
    /// Takes the next samples, the first of them now; times count from the creation of the bench. Afterwards time has
    /// advanced by `count` steps. Fewer samples are returned when the motion ends: see `ended`.
    void sample(std::size_t count, Samples& samples);
    /// Lets time pass without samples. The filters then start in their steady state.
    void pass(double seconds);
    /// Why the motion has ended, in one line; empty while it goes on.
    const std::string& ended() const;

    /// Stores the state of everything but the generator under a number; the last four are kept.
    void mark(std::uint64_t number);
    /// Restores a stored state. @return false when none is stored under that number
    bool return_to(std::uint64_t number);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace graze
