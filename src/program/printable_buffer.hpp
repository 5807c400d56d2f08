#pragma once

#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace graze {

/// Of a stream that passes on to another one what is written to it, with everything shown by its code that would act on
/// a terminal (graze/base/printable.hpp). Names and texts of files go through here, wherever they are printed.
class PrintableBuffer : public std::streambuf {
public:
    explicit PrintableBuffer(std::ostream& target) : target_(&target) {}
    ~PrintableBuffer() override;
    PrintableBuffer(const PrintableBuffer&) = delete;
    PrintableBuffer& operator=(const PrintableBuffer&) = delete;

private:
    int_type overflow(int_type letter) override;
    std::streamsize xsputn(const char* text, std::streamsize count) override;
    int sync() override;
    bool pass_on(std::string_view text);

    std::ostream* target_;
    std::string begun_; ///< a character whose last bytes have not come yet
};

} // namespace graze
