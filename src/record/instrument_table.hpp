#pragma once

#include "record/text_table.hpp"

#include <optional>
#include <vector>

namespace graze {

/// Whether a file's first line is that of a measurement file of LabVIEW (.lvm).
bool is_labview(std::string_view line);
/// Reads its headings up to the names of columns. @throws InputError for what is not like that
TextTable labview_table(TextLines& lines);

/// Whether a file's first line is that of older oscilloscopes of Tektronix, which write what they know of a record in
/// three columns in front of the first rows.
bool is_tektronix(std::string_view line);
TextTable tektronix_table(TextLines& lines, const KeptLine& first);

/// Of oscilloscopes of Rigol, which write where the time begins and its step into the lines of names and units.
/// @param heading lines before the first row. @return none where they do not say that
std::optional<TextTable> rigol_table(const std::vector<KeptLine>& heading, const std::string& path);
/// Whether a row below such a line of names has no time.
bool has_time_in_names(std::string_view names);

} // namespace graze
