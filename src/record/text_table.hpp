#pragma once

#include "graze/record/record_file.hpp"
#include "record/text_lines.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A line that was read before it was known what it is.
struct KeptLine {
    std::string text;
    int number = 0;
    bool is_ended = true;
};

/// Times that a file does not write row by row: start + step * (the first column, or the number of the row from 0 on).
struct CountedTime {
    double start = 0, step = 1;
    bool by_column = false;
};

/// What is known of a table before its rows.
struct TextTable {
    RecordHeader header;
    char separator = ',';        ///< a blank stands for any number of blanks and tabs
    char decimal = 0;            ///< sign of numbers; 0: not known yet
    std::size_t passed_over = 0; ///< fields before those of the table in each row
    bool has_comment = false;    ///< what stands behind the last column is none
    std::optional<CountedTime> time{};
    std::vector<KeptLine> first{}; ///< rows that were read already
    bool starts_again = false;     ///< a line of text behind the rows begins another table, which is told so

    std::size_t columns() const { return header.channels.size() + (time && !time->by_column ? 0 : 1); }
};

/// Fields of a row. Where blanks separate, several of them are one. @param separator as of a table
std::vector<std::string_view> row_fields(std::string_view line, char separator);

/// Finds the table of a text and what its columns are: behind a line of names, or of names and units, whatever stands
/// before these, with the separator by which as many columns come out in the names as in the rows; or as the layout
/// says; or as LabVIEW, Tektronix and Rigol write it.
/// @throws InputError with place and remedy where nothing says what the columns are
TextTable find_table(TextLines& lines, const RecordLayout& layout);

} // namespace graze
