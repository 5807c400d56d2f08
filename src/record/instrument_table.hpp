#pragma once

#include "record/text_table.hpp"

#include <optional>
#include <vector>

namespace graze {

/// Whether a file's first line is that of a measurement file of LabVIEW (.lvm).
bool is_labview(std::string_view line);
/// Reads the headings of such a file up to the names of columns. @throws InputError for other files
TextTable labview_table(TextLines& lines);

/// Whether a file's first line is that of older Tektronix oscilloscopes, which write their settings in three columns
/// before the first rows.
bool is_tektronix(std::string_view line);
/// Reads such a file up to its first complete row. @param first the first line
TextTable tektronix_table(TextLines& lines, const KeptLine& first);

/// Reads the heading of Rigol oscilloscopes, which write the start of time and its step in the lines of names and
/// units.
/// @param heading lines before the first row. @return nothing if they do not say that
std::optional<TextTable> rigol_table(const std::vector<KeptLine>& heading, const std::string& path);
/// Whether a line of names contains the time (start and step), so that rows have none.
bool has_time_in_names(std::string_view names);

} // namespace graze
