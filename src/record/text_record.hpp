#pragma once

#include "graze/record/record_file.hpp"
#include "record/text_lines.hpp"
#include "record/text_number.hpp"
#include "record/text_table.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A record in a text file.
class TextRecord : public SampleSource {
public:
    TextRecord(const std::string& path, const RecordLayout& layout);
    const RecordHeader& header() const override { return table_.header; }
    bool read(Samples& samples) override;

private:
    /// Finds the next line that is neither empty nor a comment. @return false at the end of the file
    bool next_line(std::string_view& line);
    void parse(std::string_view line, Samples& samples);
    /// Reads the numbers of a line into `row_`. @return false if one is missing
    bool read_row(std::string_view line);
    /// Reports what was left out, once, at the end.
    void tell();
    [[noreturn]] void refuse(std::string_view line, const char* at, const std::string& problem,
                             const std::string& remedy) const;
    [[noreturn]] void refuse_field(std::string_view line, std::string_view field) const;
    [[noreturn]] void refuse_rest(std::string_view line, const char* at) const;

    TextLines lines_;
    TextTable table_;
    NumberReader numbers_;
    RecordRemark remark_;
    std::size_t kept_ = 0; ///< number of the table's first lines that were used
    int line_ = 0;
    bool is_ended_ = true;
    double last_time_;
    std::vector<double> row_;
    std::size_t rows_ = 0, missing_ = 0; ///< rows, and rows with missing values
    int first_missing_ = 0, cut_ = 0;    ///< line numbers; 0: none
    bool told_ = false;
};

} // namespace graze
