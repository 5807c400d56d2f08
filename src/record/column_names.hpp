#pragma once

#include "graze/record/record_file.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A column of a line of names.
struct NameField {
    std::string_view text;
    std::size_t begin = 0; ///< in the line
};

/// The first of semicolon, comma, tab and blank that a line has outside of brackets and quotes; a comma where it has
/// none.
char separator_of_names(std::string_view line);
/// Fields of a line of names, without empty ones at its end. Units may stand behind a blank even where blanks separate.
std::vector<NameField> name_fields(std::string_view line, char separator);
/// A name with its unit: in brackets, as in "t / s" or "CH1 in V", or in quotes, as in "Time, s". @param line where it
/// stands. @throws InputError for what is no name
Channel named_channel(const NameField& field, const Place& line);
/// The time and channels. @throws InputError for fewer than two columns, or a name that is there twice
RecordHeader header_of(const std::vector<NameField>& fields, const Place& line);
/// Of a bracket that is never closed all that follows would be the unit. @throws InputError for one
void require_closed_brackets(std::string_view line, const Place& place);
/// Of a record's time. @throws InputError for one that is none, as mS, which is a conductance
void require_unit_of_time(const RecordHeader& header, const std::string& path);
/// Of a line that says in what times are, for which instruments write "S" as well.
std::string unit_of_time_word(std::string_view word);
/// "Second" is s and "Volts" V; other units stay as they are. Brackets around them go.
std::string unit_of_word(std::string_view word);
/// Whether it is a unit that instruments write in a line of its own, as "Second", "V" or "(ms)".
bool is_unit_word(std::string_view word);

} // namespace graze
