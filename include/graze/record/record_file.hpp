#pragma once

#include "graze/record/samples.hpp"
#include "graze/symbolic/input_error.hpp"

#include <memory>
#include <string>

namespace graze {

/// What cannot be read from a record's file itself.
struct RecordLayout {
    /// Names and units of the columns of a text without a header, the time first: "t [s], V [V], I [A]". With it, a
    /// header in the file is a mistake. Empty: the header says it, or the file has the five columns time, V, I, q and
    /// dq/dt of B. E. Wilcox's dissertation, which bear the names t, V, I, q, v.
    std::string columns;
    /// Of HDF5: the group whose datasets are the channels.
    std::string group = "/";
};

/// Opens a record: a table of channels against time (docs/records.md).
///
/// Text: columns separated by commas, semicolons, tabs or blanks; lines that begin with # or % are passed over; the
/// first column is the time. HDF5: one dataset of numbers for each channel, all of one length, with its unit in the
/// attribute `units`; the time is `t` or `time`. Which of the two it is, the file's first bytes tell. It is read part
/// by part as it is asked for, in memory that does not depend on its length.
/// @throws InputError with file, line and column for anything that is no record; so does `read` where it meets it:
///         lines with too few or too many columns, what is no finite number, times that do not rise, lines of more than
///         a MiB
std::unique_ptr<SampleSource> open_record(const std::string& path, const RecordLayout& layout = {});

/// Names and units from a header line such as "t [s], V [V]" or "t (s); V". The separator is the first of comma,
/// semicolon, tab and blank that the line has outside of brackets.
/// @throws InputError for names that are empty or there twice
RecordHeader parse_record_header(const std::string& line, const Place& place);

} // namespace graze
