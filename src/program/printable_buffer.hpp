#pragma once

#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace graze {

/// A stream buffer that passes its text on to another stream and replaces control characters, which would act on a
/// terminal, by their codes (graze/base/printable.hpp). All output goes through it, since names come from files.
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
    std::string begun_; ///< the first bytes of a UTF-8 character that is not complete yet
};

} // namespace graze
