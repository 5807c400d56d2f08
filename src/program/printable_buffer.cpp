#include "program/printable_buffer.hpp"

#include "graze/base/printable.hpp"

#include <algorithm>

namespace graze {

namespace {

/// True for printable ASCII and line feeds: the fast path, since nearly all output consists of them.
bool is_harmless(char c) {
    return (c >= ' ' && c <= '~') || c == '\n' || c == '\t';
}

} // namespace

PrintableBuffer::~PrintableBuffer() {
    *target_ << printable(begun_);
}

PrintableBuffer::int_type PrintableBuffer::overflow(int_type letter) {
    if (traits_type::eq_int_type(letter, traits_type::eof()))
        return traits_type::not_eof(letter);
    const char c = traits_type::to_char_type(letter);
    return pass_on({&c, 1}) ? letter : traits_type::eof();
}

std::streamsize PrintableBuffer::xsputn(const char* text, std::streamsize count) {
    return pass_on({text, static_cast<std::size_t>(count)}) ? count : 0;
}

int PrintableBuffer::sync() {
    target_->flush();
    return target_->good() ? 0 : -1;
}

bool PrintableBuffer::pass_on(std::string_view text) {
    if (begun_.empty() && std::all_of(text.begin(), text.end(), is_harmless)) {
        target_->write(text.data(), static_cast<std::streamsize>(text.size()));
    } else {
        begun_ += text;
        const std::size_t whole = begun_.size() - unfinished_character(begun_);
        *target_ << printable(std::string_view(begun_).substr(0, whole));
        begun_.erase(0, whole);
    }
    return target_->good();
}

} // namespace graze
