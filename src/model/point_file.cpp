#include "model/point_file.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/name_list.hpp"
#include "graze/base/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

namespace graze {

namespace {

/// A field of a line, and the column of its first character, from 1.
struct Field {
    std::string_view text;
    int column;
};

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/// Splits a line at commas or semicolons, or at white space if it has neither.
std::vector<Field> fields_of(std::string_view line) {
    const char separator = line.find(',') != std::string_view::npos   ? ','
                           : line.find(';') != std::string_view::npos ? ';'
                                                                      : ' ';
    std::vector<Field> fields;
    std::size_t at = 0;
    while (at <= line.size()) {
        std::size_t end = at;
        while (end < line.size() && (separator == ' ' ? !is_blank(line[end]) : line[end] != separator))
            ++end;
        std::size_t first = at, last = end;
        while (first < last && is_blank(line[first]))
            ++first;
        while (last > first && is_blank(line[last - 1]))
            --last;
        std::string_view text = line.substr(first, last - first);
        if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
            text = text.substr(1, text.size() - 2);
        if (separator != ' ' || !text.empty())
            fields.push_back({text, static_cast<int>(first) + 1});
        at = end + 1;
    }
    return fields;
}

std::optional<double> number_in(std::string_view text) {
    if (text.starts_with('+'))
        text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty())
        return std::nullopt;
    return value;
}

/// Reads the rows of a file.
class PointReader {
public:
    PointReader(const std::string& path, const std::vector<std::string>& columns) : path_(path), columns_(columns) {}

    void read_line(std::string_view line) {
        ++line_;
        if (line_ == 1 && line.starts_with("\xef\xbb\xbf")) // byte order mark
            line.remove_prefix(3);
        const std::vector<Field> fields = fields_of(line);
        const bool empty = std::ranges::all_of(fields, [](const Field& field) { return field.text.empty(); });
        if (empty || fields.front().text.starts_with('#'))
            return;
        if (!begun_) {
            begun_ = true;
            if (std::ranges::none_of(fields, [](const Field& field) { return number_in(field.text).has_value(); }))
                return read_names(fields);
            if (!columns_.empty())
                throw InputError({path_, line_, fields.front().column}, "the columns have no names in the first row",
                                 "add a row of names, or leave out columns to use the first two");
        }
        read_row(fields);
    }

    std::vector<PieceTable::Point> take() {
        if (points_.size() < 2)
            throw InputError({path_, 0, 0}, fmt::format("the table has {} rows of numbers", points_.size()),
                             "give at least two");
        return std::move(points_);
    }

private:
    void read_names(const std::vector<Field>& fields) {
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            const auto found = std::ranges::find(fields, columns_[k], &Field::text);
            if (found == fields.end()) {
                std::vector<std::string> names;
                for (const Field& field : fields)
                    names.emplace_back(field.text);
                throw InputError({path_, line_, 1}, fmt::format("there is no column '{}'", columns_[k]),
                                 fmt::format("there are {}", name_list(names, columns_[k])));
            }
            places_[k] = static_cast<std::size_t>(found - fields.begin());
        }
    }

    double number(const std::vector<Field>& fields, std::size_t place) const {
        if (place >= fields.size())
            throw InputError({path_, line_, 0},
                             fmt::format("the row has {} of at least {} numbers", fields.size(), place + 1),
                             "complete it or remove it");
        const Field& field = fields[place];
        const std::optional<double> value = number_in(field.text);
        if (!value || !std::isfinite(*value))
            throw InputError({path_, line_, field.column},
                             fmt::format("'{}' is {}", std::string(field.text.substr(0, 40)),
                                         value ? "not a finite number" : "not a number"),
                             "write numbers with a decimal point, and remove rows without values");
        return *value;
    }

    void read_row(const std::vector<Field>& fields) {
        const PieceTable::Point point{number(fields, places_[0]), number(fields, places_[1])};
        if (!points_.empty() && !(points_.back().x < point.x))
            throw InputError({path_, line_, fields[places_[0]].column},
                             fmt::format("the abscissae do not increase: {} follows {}", point.x, points_.back().x),
                             "sort the rows, and remove repeated ones");
        if (points_.size() >= PieceTable::most_points)
            throw InputError({path_, line_, 0}, fmt::format("the table has more than {} rows", PieceTable::most_points),
                             "thin it out");
        points_.push_back(point);
    }

    const std::string& path_;
    const std::vector<std::string>& columns_;
    std::size_t places_[2] = {0, 1};
    int line_ = 0;
    bool begun_ = false;
    std::vector<PieceTable::Point> points_;
};

} // namespace

std::vector<PieceTable::Point> read_points(const std::string& path, const std::vector<std::string>& columns) {
    const std::string text = read_text_file(path, "table", longest_table);
    PointReader reader(path, columns);
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        reader.read_line(std::string_view(text).substr(at, end - at));
        at = end + 1;
    }
    return reader.take();
}

std::string path_inside(const std::string& folder, const std::string& file) {
    namespace fs = std::filesystem;
    const fs::path given(file);
    std::error_code error;
    const fs::path within = fs::canonical(folder.empty() ? fs::path(".") : fs::path(folder), error);
    const fs::path path = fs::path(folder) / given;
    const fs::path real = error ? fs::path() : fs::weakly_canonical(within / given, error);
    const fs::path relative = real.lexically_relative(within);
    if (error || given.empty() || given.is_absolute() || relative.empty() || *relative.begin() == "..")
        throw InputError(fmt::format("'{}' is not inside the folder of the model", file),
                         "put the table beside the model, and give its path from there");
    if (!fs::exists(real, error))
        throw InputError(fmt::format("the file '{}' does not exist", file),
                         "put the table beside the model, and give its path from there");
    return path.string();
}

} // namespace graze
