#pragma once

#include "graze/record/record_file.hpp"
#include "record/text_lines.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A line that was read before its meaning was known.
struct KeptLine {
    std::string text;
    int number = 0;
    bool is_ended = true;
};

/// Times that are not written in each row: start + step * (the first column, or the number of the row from 0 on).
struct CountedTime {
    double start = 0, step = 1;
    bool by_column = false;
};

/// Properties of a table that are known before its rows are read.
struct TextTable {
    RecordHeader header;
    char separator = ',';        ///< a blank means any number of blanks and tabs
    char decimal = 0;            ///< decimal sign; 0: not known yet
    std::size_t passed_over = 0; ///< leading fields of each row that are skipped
    bool has_comment = false;    ///< text after the last column is a comment
    std::optional<CountedTime> time{};
    std::vector<KeptLine> first{}; ///< rows that have been read already
    bool starts_again = false;     ///< text after the rows begins another table, which is refused with that reason

    std::size_t columns() const { return header.channels.size() + (time && !time->by_column ? 0 : 1); }
};

/// Splits a row into fields. With blanks as separator, several of them count as one. @param separator as in TextTable
std::vector<std::string_view> row_fields(std::string_view line, char separator);

/// Finds the table of a text and its columns: by a line of names, or of names and units, after any other lines, with
/// the separator that gives the names as many columns as the rows; or by the layout; or in the formats of LabVIEW,
/// Tektronix and Rigol.
/// @throws InputError with place and remedy if the columns are not named
TextTable find_table(TextLines& lines, const RecordLayout& layout);

} // namespace graze
