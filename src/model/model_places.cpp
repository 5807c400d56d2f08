#include "model/model_places.hpp"

#include "symbolic/lexer.hpp"

#include <algorithm>

namespace graze {

namespace {

bool continues_character(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// Lengths of the escape at `position`, in the file and in the string's value (UTF-8).
struct Escape {
    std::size_t length, value_length;
};

Escape escape_at(std::string_view text, std::size_t position) {
    const char kind = position + 1 < text.size() ? text[position + 1] : '\0';
    if (kind == 'u' || kind == 'U') {
        const std::size_t digits = kind == 'u' ? 4 : 8;
        unsigned long code = 0;
        for (std::size_t i = position + 2; i < std::min(position + 2 + digits, text.size()); ++i) {
            const char c = text[i];
            code = code * 16 + static_cast<unsigned long>(c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10);
        }
        return {2 + digits, code < 0x80 ? 1U : code < 0x800 ? 2U : code < 0x10000 ? 3U : 4U};
    }
    if (kind == ' ' || kind == '\t' || kind == '\r' || kind == '\n') {
        // A backslash at the end of a line removes all white space after it.
        const std::size_t end = text.find_first_not_of(" \t\r\n", position + 1);
        return {(end == std::string_view::npos ? text.size() : end) - position, 0};
    }
    return {2, 1};
}

} // namespace

SourceText::SourceText(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {
    line_starts_.push_back(text_.starts_with("\xef\xbb\xbf") ? 3 : 0); // byte order mark
    for (std::size_t i = 0; i < text_.size(); ++i)
        if (text_[i] == '\n')
            line_starts_.push_back(i + 1);
}

std::size_t SourceText::position(const Place& place) const {
    if (place.line < 1 || static_cast<std::size_t>(place.line) > line_starts_.size())
        return text_.size();
    std::size_t at = line_starts_[static_cast<std::size_t>(place.line) - 1];
    for (int column = 1; column < place.column && at < text_.size(); ++column)
        do
            ++at;
        while (at < text_.size() && continues_character(text_[at]));
    return at;
}

Place SourceText::place(std::size_t position) const {
    position = std::max(position, line_starts_.front());
    const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), position);
    const std::size_t start = *(after - 1);
    const std::string_view before = std::string_view(text_).substr(start, position - start);
    const auto characters = std::count_if(before.begin(), before.end(), [](char c) { return !continues_character(c); });
    return {file_, static_cast<int>(after - line_starts_.begin()), static_cast<int>(characters) + 1};
}

Place SourceText::inside_string(const Place& begin, std::size_t offset) const {
    std::size_t at = position(begin);
    if (at >= text_.size() || (text_[at] != '"' && text_[at] != '\''))
        return begin;
    const char quote = text_[at];
    const std::string_view text = text_;
    if (text.substr(at, 3) == std::string(3, quote)) {
        at += 3;
        // A line break right after the opening quotes is not part of the value.
        if (text.substr(at, 2) == "\r\n")
            at += 2;
        else if (text.substr(at, 1) == "\n")
            at += 1;
    } else {
        at += 1;
    }
    for (std::size_t value = 0; at < text.size();) {
        const bool escaped = quote == '"' && text[at] == '\\';
        const bool line_end = text.substr(at, 2) == "\r\n"; // counts as one character
        const Escape piece = escaped ? escape_at(text, at) : Escape{line_end ? 2U : 1U, 1};
        if (value + piece.value_length > offset)
            break;
        value += piece.value_length;
        at += piece.length;
    }
    return place(std::min(at, text.size()));
}

void Places::set_string(const std::string& path, const Place& place, std::string text) {
    origins_[path] = {place, std::move(text)};
}

const Places::Origin* Places::find(std::string_view path) const {
    const auto found = origins_.find(path);
    return found == origins_.end() ? nullptr : &found->second;
}

Place Places::of(std::string_view path) const {
    while (!path.empty()) {
        if (const Origin* origin = find(path))
            return origin->place;
        const std::size_t dot = path.rfind('.');
        path = dot == std::string_view::npos ? std::string_view() : path.substr(0, dot);
    }
    return {file_, 0, 0};
}

Place Places::of_name(std::string_view path, std::string_view name) const {
    const Origin* origin = find(path);
    if (origin == nullptr || source_ == nullptr)
        return of(path);
    const std::string& text = origin->text;
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
        const std::size_t end = at + name.size();
        if ((at == 0 || !is_name_character(text[at - 1])) && (end == text.size() || !is_name_character(text[end])))
            return source_->inside_string(origin->place, at);
    }
    return origin->place;
}

} // namespace graze
