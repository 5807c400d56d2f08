#pragma once

#include "graze/record/record_file.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A column of a line of names.
struct NameField {
    std::string_view text;
    std::size_t begin = 0; ///< index in the line
};

/// Returns the first of semicolon, comma, tab and blank that a line has outside brackets and quotes; a comma if it has
/// none of them.
char separator_of_names(std::string_view line);
/// Splits a line of names, and drops empty fields at its end. A unit may follow its name after a blank even if blanks
/// separate columns.
std::vector<NameField> name_fields(std::string_view line, char separator);
/// Parses a name with its unit, which may be in brackets, or as in "t / s" or "CH1 in V", or in quotes, as in "Time,
/// s". @param line place of the line. @throws InputError for an invalid name
Channel named_channel(const NameField& field, const Place& line);
/// Makes a header of names: the time and the channels. @throws InputError for fewer than two columns, or repeated names
RecordHeader header_of(const std::vector<NameField>& fields, const Place& line);
/// Refuses a bracket that is not closed: the rest of the line would be taken for the unit. @throws InputError
void require_closed_brackets(std::string_view line, const Place& place);
/// Checks the unit of a record's time. @throws InputError for one that is not a time, such as mS, which is a
/// conductance
void require_unit_of_time(const RecordHeader& header, const std::string& path);
/// Returns the unit of time that a word names; instruments also write "S" for seconds.
std::string unit_of_time_word(std::string_view word);
/// Returns the unit that a word names: "Second" is s and "Volts" V; other units are returned unchanged, without
/// brackets.
std::string unit_of_word(std::string_view word);
/// Whether a word is a unit as instruments write them in a line of units, such as "Second", "V" or "(ms)".
bool is_unit_word(std::string_view word);

} // namespace graze
