#pragma once

#include "graze/base/input_error.hpp"
#include "graze/record/samples.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace graze {

/// Told of what was left out when the end of a record is reached, in words: rows of which a value is missing, and how
/// many; a last line that was cut off.
using RecordRemark = std::function<void(const std::string&)>;

/// What cannot be read from a record's file itself.
struct RecordLayout {
    /// Names and units of the columns of a text without a header, the time first: "t [s], V [V], I [A]". With it, a
    /// header in the file is a mistake, unless it is passed over. Empty: the header says it, or the file has the five
    /// columns time, V, I, q and dq/dt of B. E. Wilcox's dissertation, which bear the names t, V, I, q, v.
    std::string columns;
    /// Of HDF5: the group whose datasets are the channels.
    std::string group = "/";
    std::size_t skip = 0;       ///< so many lines at the beginning of a text are passed over
    std::size_t names_line = 0; ///< line with the names of a text's columns, from 1 on; rows begin behind. 0: found
    std::size_t units_line = 0; ///< likewise, with their units
    RecordRemark remark{};
};

/// Opens a record: a table of channels against time (docs/records.md).
///
/// Text: columns separated by commas, semicolons, tabs or blanks; lines that begin with # or % are passed over; the
/// first column is the time. Names stand in the line before the first row of numbers, or before a line of units there;
/// what stands before them is passed over. Measurement files of LabVIEW and what oscilloscopes write are understood.
/// Numbers have a decimal point, or a comma where columns are separated by something else. Rows of which a value is
/// missing are left out. HDF5: one dataset of numbers for each channel, all of one length, with its unit in the
/// attribute `units`; the time is `t` or `time`. Which of the two it is, the file's first bytes tell. It is read part
/// by part as it is asked for, in memory that does not depend on its length.
/// @throws InputError with file, line and column for anything that is no record; so does `read` where it meets it:
///         lines with too few or too many columns, what is no number, times that do not rise, lines of more than a MiB
std::unique_ptr<SampleSource> open_record(const std::string& path, const RecordLayout& layout = {});

/// Names and units from a header line such as "t [s], V [V]" or "t (s); V". The separator is the first of comma,
/// semicolon, tab and blank that the line has outside of brackets.
/// @throws InputError for names that are empty or there twice
RecordHeader parse_record_header(const std::string& line, const Place& place);

} // namespace graze
