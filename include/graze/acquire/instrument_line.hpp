#pragma once

#include "graze/base/borrowed.hpp"
#include "graze/base/error.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace graze {

/// How an experiment ended.
enum class AcquisitionEnding {
    complete,    ///< all records are there
    interrupted, ///< by who asked for it
    line_lost,   ///< a connection is closed
    no_answer,   ///< an instrument does not answer in time
    garbled,     ///< it answers what cannot be understood
    foreign,     ///< at the end of the generator's line is another instrument
    refused,     ///< the generator refuses a setting
    clipped,     ///< the generator gives something else than it was told
    samples,     ///< the device of samples does not do what it should
};
/// Stable name for tables and files, such as "line-lost".
std::string_view name_of(AcquisitionEnding ending);

/// What helps where it ended so.
std::string remedy_of(AcquisitionEnding ending);

/// An instrument does not do what it should.
class InstrumentError : public Error {
public:
    InstrumentError(AcquisitionEnding ending, const std::string& problem)
        : Error(ErrorKind::instrument, {}, problem, remedy_of(ending)), ending_(ending) {}
    AcquisitionEnding ending() const { return ending_; }

private:
    AcquisitionEnding ending_;
};

/// A connection to an instrument that speaks in lines of text.
class InstrumentLine {
public:
    InstrumentLine() = default;
    virtual ~InstrumentLine() = default;
    InstrumentLine(const InstrumentLine&) = delete;
    InstrumentLine& operator=(const InstrumentLine&) = delete;

    /// Sends a line; its terminator is added. @throws InstrumentError when the connection is closed, or takes nothing
    virtual void send(std::string_view line) = 0;
    /// The next line without its terminator. @param wait seconds @return nothing when none has come whole until then
    /// @throws InstrumentError when the connection is closed, or a line is longer than `longest_line`
    virtual std::optional<std::string> receive(double wait) = 0;
    /// What has come and was not asked for is passed over. @throws InstrumentError when the connection is closed
    virtual void discard() = 0;
    /// Opens the connection again, as at first. @throws InstrumentError when it cannot be
    virtual void reopen() = 0;

    static constexpr std::size_t longest_line = 65536;
};

/// The next line. @param timeout seconds; @param interrupted asked some twenty times a second; may be empty
/// @param who for messages, as "the generator"; @param question what it was asked, for messages; may be empty
/// @throws InstrumentError when none comes in time, or somebody interrupts; InputError for a timeout that is no number
std::string awaited_line(InstrumentLine& line, double timeout, const std::function<bool()>& interrupted,
                         std::string_view who, std::string_view question = {});

} // namespace graze
