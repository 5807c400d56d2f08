#include "study/picture_style.hpp"

#include "graze/base/file_name.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace graze {

namespace {

constexpr double least_size = 40, greatest_size = 1000; ///< mm
constexpr double least_font = 4, greatest_font = 72;    ///< points

void require_between(double value, double least, double greatest, const char* what, const char* unit,
                     const Place& place) {
    if (value != 0 && !(value >= least && value <= greatest))
        throw InputError(place, fmt::format("{} of {:g} {} cannot be drawn", what, value, unit),
                         fmt::format("choose {:g} to {:g} {}", least, greatest, unit));
}

void read_size(const StudyReader& reader, const TomlEntry& entry, FigureStyle& style) {
    const Model none;
    if (entry.node->is_string() && reader.toml().line(entry).find_first_of("x,;") != std::string::npos)
        reader.fail(entry, fmt::format("{} is a text, not a width or a width and a height", entry.path),
                    "write it as 170 or [170, 100], in mm");
    if (!entry.node->is_array()) {
        style.width = reader.positive(none, entry);
        return;
    }
    const std::vector<TomlEntry> sides = reader.toml().elements(entry);
    if (sides.size() != 2)
        reader.fail(entry, fmt::format("{} needs a width and a height", entry.path), "write it as [170, 100], in mm");
    style.width = reader.positive(none, sides[0]);
    style.height = reader.positive(none, sides[1]);
}

void read_font(const StudyReader& reader, const TomlEntry& entry, FigureStyle& style) {
    if (entry.node->is_number()) {
        style.font_size = reader.positive(Model(), entry);
        return;
    }
    if (!entry.node->is_table()) {
        style.font = reader.toml().line(entry);
        return;
    }
    reader.each_of(entry, {"name", "size"}, [&](const TomlEntry& item) {
        if (item.name == "name")
            style.font = reader.toml().line(item);
        else
            style.font_size = reader.positive(Model(), item);
    });
}

} // namespace

void check_style(const FigureStyle& style, const Place& place) {
    require_between(style.width, least_size, greatest_size, "a picture with a width", "mm", place);
    require_between(style.height, least_size, greatest_size, "a picture with a height", "mm", place);
    require_between(style.font_size, least_font, greatest_font, "letters with a size", "points", place);
    if (!std::all_of(style.font.begin(), style.font.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == ' ' || c == '-'; }))
        throw InputError(place, fmt::format("'{}' is no name of a font", style.font),
                         "use letters, digits, blanks and '-', as in \"Latin Modern Roman\"");
}

bool read_style(const StudyReader& reader, const TomlEntry& entry, StudyPicture& picture) {
    if (entry.name == "names") {
        reader.each_of(entry, {}, [&](const TomlEntry& item) {
            require_plain_line(item.name, "name", item.place);
            picture.names.emplace_back(item.name, reader.toml().line(item));
        });
    } else if (entry.name == "x_label") {
        picture.x_label = reader.toml().line(entry);
    } else if (entry.name == "y_label") {
        picture.y_labels = reader.strings(entry);
    } else if (entry.name == "size") {
        read_size(reader, entry, picture.style);
    } else if (entry.name == "grey") {
        picture.style.grey = reader.toml().boolean(entry);
    } else if (entry.name == "font") {
        read_font(reader, entry, picture.style);
    } else {
        return false;
    }
    check_style(picture.style, entry.place);
    return true;
}

} // namespace graze
