#pragma once

#include "graze/base/input_error.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// The text of a model file, for finding places in it. Columns count characters, not bytes.
class SourceText {
public:
    SourceText(std::string_view text, std::string file);

    const std::string& file() const { return file_; }
    /// Returns the index of the byte at this line and column.
    std::size_t position(const Place& place) const;
    /// Returns the place of the byte with this index.
    Place place(std::size_t position) const;
    /// Returns the place of one byte of the value of the string literal that begins (with its quote) at `begin`; takes
    /// account of escapes and multi-line strings.
    Place inside_string(const Place& begin, std::size_t offset) const;

private:
    std::string text_;
    std::string file_;
    std::vector<std::size_t> line_starts_;
};

/// Where the parts of a model were written. A part is named by its path, such as "modes.flight.rates.x".
class Places {
public:
    /// @param file   the file, or the name of a model that was built from C++
    /// @param source its text; none for a model built from C++
    explicit Places(std::string file, const SourceText* source = nullptr) : file_(std::move(file)), source_(source) {}

    void set(const std::string& path, const Place& place) { origins_[path] = {place, ""}; }
    /// Records the place of a string, whose value is `text`.
    void set_string(const std::string& path, const Place& place, std::string text);

    /// Returns the place of the part, or of the smallest known part that contains it, or just the file.
    Place of(std::string_view path) const;
    /// Returns the place of a name inside the expression at `path`.
    Place of_name(std::string_view path, std::string_view name) const;

private:
    struct Origin {
        Place place;
        std::string text;
    };
    const Origin* find(std::string_view path) const;

    std::string file_;
    const SourceText* source_;
    std::map<std::string, Origin, std::less<>> origins_;
};

} // namespace graze
