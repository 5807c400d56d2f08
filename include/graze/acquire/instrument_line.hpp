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
    complete,    ///< all records exist
    interrupted, ///< ended by the caller
    line_lost,   ///< a connection was closed
    no_answer,   ///< an instrument did not answer in time
    garbled,     ///< an answer was not understood
    foreign,     ///< another instrument is connected to the generator's line
    refused,     ///< the generator refused a setting
    clipped,     ///< the generator reports another setting than it was given
    samples,     ///< the device that takes samples failed
};
/// Stable name for tables and files, such as "line-lost".
std::string_view name_of(AcquisitionEnding ending);

/// What helps after such an ending.
std::string remedy_of(AcquisitionEnding ending);

/// Thrown when an instrument fails.
class InstrumentError : public Error {
public:
    InstrumentError(AcquisitionEnding ending, const std::string& problem)
        : Error(ErrorKind::instrument, {}, problem, remedy_of(ending)), ending_(ending) {}
    AcquisitionEnding ending() const { return ending_; }

private:
    AcquisitionEnding ending_;
};

/// A connection to an instrument that exchanges lines of text.
class InstrumentLine {
public:
    InstrumentLine() = default;
    virtual ~InstrumentLine() = default;
    InstrumentLine(const InstrumentLine&) = delete;
    InstrumentLine& operator=(const InstrumentLine&) = delete;

    /// Sends a line and its terminator. @throws InstrumentError when the connection is closed, or accepts nothing
    virtual void send(std::string_view line) = 0;
    /// Returns the next line without its terminator. @param wait seconds @return nothing when no complete line has
    /// arrived by then
    /// @throws InstrumentError when the connection is closed, or a line is longer than `longest_line`
    virtual std::optional<std::string> receive(double wait) = 0;
    /// Discards lines that have arrived. @throws InstrumentError when the connection is closed
    virtual void discard() = 0;
    /// Opens the connection again. @throws InstrumentError when that fails
    virtual void reopen() = 0;

    static constexpr std::size_t longest_line = 65536;
};

/// Waits for the next line. @param timeout seconds; @param interrupted called some twenty times a second; may be empty
/// @param who sender, for messages, such as "the generator"; @param question what it was asked, for messages; may be
/// empty
/// @throws InstrumentError when none arrives in time, or when interrupted; InputError for a timeout that is not finite
std::string awaited_line(InstrumentLine& line, double timeout, const std::function<bool()>& interrupted,
                         std::string_view who, std::string_view question = {});

} // namespace graze
