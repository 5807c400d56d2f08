#pragma once

#include "graze/record/record_file.hpp"
#include "graze/symbolic/text_file.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A record of lines of numbers.
class TextRecord : public SampleSource {
public:
    TextRecord(const std::string& path, const RecordLayout& layout);
    const RecordHeader& header() const override { return header_; }
    bool read(Samples& samples) override;

private:
    /// The next line that is neither empty nor a comment. @return false at the end of the file
    bool next_line(std::string_view& line);
    /// The next line of any kind.
    bool next_raw_line(std::string_view& line);
    void find_header(const RecordLayout& layout);
    void parse(std::string_view line, Samples& samples);
    [[noreturn]] void refuse(std::string_view line, const char* at, const std::string& problem,
                             const std::string& remedy) const;
    [[noreturn]] void refuse_field(std::string_view line, const char* at) const;

    std::string path_;
    PlainFile file_;
    std::vector<char> buffer_;
    std::size_t begin_ = 0, end_ = 0; ///< of what is in the buffer and has not been read
    bool at_end_ = false;             ///< of the file
    int line_ = 0;
    RecordHeader header_;
    char separator_ = ','; ///< a blank stands for any number of blanks and tabs
    std::string first_line_;
    bool has_first_line_ = false;
    double last_time_;
    std::vector<double> row_;
};

} // namespace graze
