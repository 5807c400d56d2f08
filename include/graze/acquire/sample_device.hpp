#pragma once

#include "graze/acquire/instrument_line.hpp"
#include "graze/record/samples.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>

namespace graze {

/// What takes samples of an experiment: a converter with what measures before it. All of its functions throw
/// InstrumentError when it does not do what it should.
class SampleDevice {
public:
    SampleDevice() = default;
    virtual ~SampleDevice() = default;
    SampleDevice(const SampleDevice&) = delete;
    SampleDevice& operator=(const SampleDevice&) = delete;

    virtual const RecordHeader& header() const = 0;
    /// @param rate samples in a second
    virtual void set_rate(double rate) = 0;
    /// Begins to take so many samples, from now on, without gaps.
    /// @param block so many are read at once; a device whose time stands still while nobody reads takes no more than
    ///              those before the next ones are read. 0: as many as are there
    virtual void begin(std::size_t count, std::size_t block = 0) = 0;
    /// Replaces `samples` by the next ones, with times from the first that was taken.
    /// @return false when all that were asked for have been given
    virtual bool read(Samples& samples) = 0;
    /// Ends before its time what has been begun.
    virtual void stop() = 0;
    /// Keeps the state of the whole experiment under a number, and makes it so again, where that can be done: of a
    /// simulated one. @return false where it cannot
    virtual bool mark(std::uint64_t) { return false; }
    virtual bool return_to(std::uint64_t) { return false; }
};

/// A device that speaks the text protocol of docs/experiment.md, over whatever line.
class TextSampleDevice : public SampleDevice {
public:
    /// Ends what somebody else may have begun, and asks for the channels.
    /// @param line is shared; @param timeout s, for each answer, and for each row besides its time
    /// @param interrupted asked while anything is waited for
    /// @param patience how many times as long as samples last they may take to come; and `timeout`
    /// @throws InstrumentError when it does not answer as the protocol has it
    TextSampleDevice(std::shared_ptr<InstrumentLine> line, double timeout, std::function<bool()> interrupted, double patience = 10);

    const RecordHeader& header() const override { return header_; }
    void set_rate(double rate) override;
    void begin(std::size_t count, std::size_t block = 0) override;
    bool read(Samples& samples) override;
    void stop() override;
    bool mark(std::uint64_t number) override;
    bool return_to(std::uint64_t number) override;

private:
    std::string asked(std::string_view question);
    bool done(const char* word, std::uint64_t number);
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
    std::chrono::steady_clock::time_point latest_; ///< when all of what was begun has to be there
};

} // namespace graze
