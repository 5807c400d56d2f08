#pragma once

#include "graze/acquire/experiment.hpp"
#include "graze/acquire/instrument_line.hpp"
#include "graze/record/samples.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

namespace graze {

/// A device that takes the samples of an experiment: a converter with its sensors. As a source it returns those that it
/// was asked for, with times counted from the first one. All functions throw InstrumentError when the device fails.
class SampleDevice : public SampleSource {
public:
    /// @param rate samples per second
    virtual void set_rate(double rate) = 0;
    /// Begins to take samples, from now on and without gaps.
    /// @param block samples per read; a device whose time stands still while nobody reads takes no more before the next
    /// read. 0: no limit
    virtual void begin(std::size_t count, std::size_t block = 0) = 0;
    /// Stops taking samples early.
    virtual void stop() = 0;
    /// Stores, or restores, the state of the whole experiment under a number, which only a simulated one can do.
    /// @return false if it is not possible
    virtual bool mark(std::uint64_t) { return false; }
    virtual bool return_to(std::uint64_t) { return false; }
};

/// Opens the line to the device of an experiment. @param place of its address, for messages
/// @throws InputError for an address that is none, InstrumentError when the device cannot be reached
std::unique_ptr<InstrumentLine> open_sample_line(const Experiment& experiment, const Place& place);

/// A device with the text protocol of docs/experiment.md, over any line.
class TextSampleDevice : public SampleDevice {
public:
    /// Stops any acquisition that another client has begun, and asks for the channels.
    /// @param line is shared; @param timeout longest wait in s for each answer, and for each row in
    /// addition to its time
    /// @param interrupted called while waiting; returning true ends the wait
    /// @param patience samples may take this many times their duration, plus `timeout`, to arrive
    /// @throws InstrumentError when it does not answer by the protocol
    TextSampleDevice(std::shared_ptr<InstrumentLine> line, double timeout, std::function<bool()> interrupted,
                     double patience = 10);

    const RecordHeader& header() const override { return header_; }
    void set_rate(double rate) override;
    void begin(std::size_t count, std::size_t block = 0) override;
    bool read(Samples& samples) override;
    void stop() override;
    bool mark(std::uint64_t number) override;
    bool return_to(std::uint64_t number) override;

private:
    std::string asked(std::string_view question);
    void parse(const std::string& row, Samples& samples);
    [[noreturn]] void refuse(const std::string& line, const char* wanted) const;
    void drain();
    void require_time() const;

    std::shared_ptr<InstrumentLine> line_;
    double timeout_, patience_;
    std::function<bool()> interrupted_;
    RecordHeader header_;
    double rate_ = 0;
    std::size_t wanted_ = 0, given_ = 0, block_ = 0;
    double last_time_ = -std::numeric_limits<double>::infinity();
    bool running_ = false;
    std::chrono::steady_clock::time_point latest_; ///< deadline for all requested samples
};

} // namespace graze
