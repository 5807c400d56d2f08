#pragma once

#include "graze/base/input_error.hpp"
#include "graze/record/samples.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace graze {

/// Called at the end of a record with a description of what was left out: rows with missing values, with their number;
/// a last line that was cut off.
using RecordRemark = std::function<void(const std::string&)>;

/// What a record's file may not say about its columns.
struct RecordLayout {
    /// Names and units of the columns of a text without a header, the time first: "t [s], V [V], I [A]". The file must
    /// not have a header then, unless it is skipped. Empty: the header names them, or the file has the five columns
    /// time, V, I, q and dq/dt of B. E. Wilcox's dissertation, which are named t, V, I, q, v.
    std::string columns{};
    /// HDF5: the group whose datasets are the channels.
    std::string group = "/";
    std::size_t skip = 0; ///< text: number of lines to skip at the beginning
    /// Text: line with the names of columns, counted from 1; rows begin after it. 0: found automatically.
    std::size_t names_line = 0;
    std::size_t units_line = 0; ///< text: line with the units of columns, likewise
    /// Called with remarks on what was left out.
    RecordRemark remark{};
};

/// Opens a record: a table of channels against time (docs/records.md).
///
/// Text: columns separated by commas, semicolons, tabs or blanks; lines that begin with # or % are skipped; the first
/// column is the time. Names stand in the line before the first row of numbers, or before a line of units there; lines
/// before them are skipped. Measurement files of LabVIEW and files of oscilloscopes are understood. Numbers have a
/// decimal point, or a comma if another separator is used. Rows with missing values are left out. HDF5: one dataset of
/// numbers for each channel, all of one length, with its unit in the attribute `units`; the time is `t` or `time`. The
/// format is recognised by the first bytes of the file. It is read in parts, in memory that does not depend on its
/// length.
/// @throws InputError with file, line and column for anything that is not a record; `read` throws it where it meets an
/// error: too few or too many columns, text instead of a number, times that do not increase, lines of more than a MiB
std::unique_ptr<SampleSource> open_record(const std::string& path, const RecordLayout& layout = {});

/// Parses names and units from a header line such as "t [s], V [V]" or "t (s); V". The separator is the first of comma,
/// semicolon, tab and blank that occurs outside brackets.
/// @throws InputError for empty or repeated names
RecordHeader parse_record_header(const std::string& line, const Place& place);

} // namespace graze
