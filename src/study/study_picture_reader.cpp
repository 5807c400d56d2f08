#include "graze/base/file_name.hpp"
#include "graze/base/input_error.hpp"
#include "graze/study/showable_names.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace graze {

namespace {

constexpr double least_size = 40, greatest_size = 1000; ///< mm
constexpr double least_font = 4, greatest_font = 72;    ///< points
/// A picture of more would be unreadable, and as text of many megabytes too long for a page.
constexpr std::size_t most_axes = 50, most_runs_shown = 500;

void require_between(double value, double least, double greatest, const char* what, const char* unit,
                     const Place& place) {
    if (value != 0 && !(value >= least && value <= greatest))
        throw InputError(place, fmt::format("{} of {:g} {} cannot be drawn", what, value, unit),
                         fmt::format("choose {:g} to {:g} {}", least, greatest, unit));
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

namespace {

void read_size(const StudyReader& reader, const TomlEntry& entry, StudyPicture& picture) {
    FigureStyle& style = picture.style;
    if (entry.node->is_string() && reader.toml().line(entry).find_first_of("x,;") != std::string::npos)
        reader.fail(entry, fmt::format("{} is a text, not a width or a width and a height", entry.path),
                    "write it as 170 or [170, 100], in mm");
    const std::vector<TomlEntry> sides = reader.items(entry);
    if (entry.node->is_array() && sides.size() != 2)
        reader.fail(entry, fmt::format("{} needs a width and a height", entry.path), "write it as [170, 100], in mm");
    style.width = reader.positive(StudyReader::no_model(), sides[0]);
    if (sides.size() > 1)
        style.height = reader.positive(StudyReader::no_model(), sides[1]);
    check_style(style, entry.place);
}

void read_font(const StudyReader& reader, const TomlEntry& entry, StudyPicture& picture) {
    FigureStyle& style = picture.style;
    const auto size = reader.into(style.font_size, StudyReader::no_model(), positive_number);
    if (entry.node->is_table())
        reader.read_keys(entry, {{"name", reader.into(style.font)}, {"size", size}});
    else
        entry.node->is_number() ? size(entry) : reader.into(style.font)(entry);
    check_style(style, entry.place);
}

std::vector<std::string> picture_kinds() {
    return {"bifurcation", "branch",   "atlas",    "basin",      "map",     "history",
            "portrait",    "poincare", "spectrum", "regression", "scatter", "residuals"};
}

void require_few(std::size_t count, std::size_t most, const char* what, const TomlEntry& entry) {
    if (count > most)
        throw InputError(entry.place, fmt::format("{} has {} {}", entry.path, count, what),
                         fmt::format("show {} at most", most));
}

/// One point, or a list of points, each given by one coordinate.
void read_marked_points(const StudyReader& reader, const TomlEntry& entry, StudyPicture& picture) {
    reader.each(reader.items(entry), [&](const TomlEntry& point) {
        reader.each_of(point, {}, [&](const TomlEntry& at) {
            require_plain_line(at.name, "coordinate", at.place);
            picture.at.emplace_back(at.name, reader.number(StudyReader::no_model(), at));
        });
    });
}

void read_names(const StudyReader& reader, const TomlEntry& entry, StudyPicture& picture) {
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        require_plain_line(item.name, "name", item.place);
        picture.names.emplace_back(item.name, reader.toml().line(item));
    });
}

void read_logarithmic(const StudyReader& reader, const TomlEntry& entry, StudyPicture& picture) {
    for (const std::string& axis : reader.strings(entry)) {
        picture.logarithmic_x = picture.logarithmic_x || axis == "x";
        picture.logarithmic_y = picture.logarithmic_y || axis == "y";
        if (axis != "x" && axis != "y")
            reader.fail(entry, fmt::format("there is no axis '{}'", axis), "name x, y or both");
    }
}

void read_picture_keys(const StudyReader& reader, const TomlEntry& entry, StudyPicture& picture) {
    const auto by = [&](auto read) { return [&, read](const TomlEntry& item) { read(reader, item, picture); }; };
    const auto one_of = [&](const std::vector<std::string>& words, std::string& word) {
        return [&, words](const TomlEntry& item) { word = words[reader.choice(item, words)]; };
    };
    reader.read_keys(entry, {{"kind", one_of(picture_kinds(), picture.kind)},
                             {"title", reader.into(picture.title)},
                             {"run", reader.into(picture.runs)},
                             {"runs", reader.into(picture.runs)},
                             {"x", reader.into(picture.x)},
                             {"y", reader.into(picture.y)},
                             {"samples", reader.into(picture.samplings)},
                             {"directions", reader.into(picture.directions)},
                             {"x_range", reader.into(picture.x_range)},
                             {"y_range", reader.into(picture.y_range)},
                             {"fit", reader.into(picture.fit)},
                             {"at", by(read_marked_points)},
                             {"points", reader.into(picture.points)},
                             {"logarithmic", by(read_logarithmic)},
                             {"format", one_of(picture_formats(), picture.format)},
                             {"successive", reader.into(picture.successive)},
                             {"group", reader.into(picture.group)},
                             {"names", by(read_names)},
                             {"over", reader.into(picture.over)},
                             {"x_label", reader.into(picture.x_label)},
                             {"y_label", reader.into(picture.y_labels)},
                             {"size", by(read_size)},
                             {"font", by(read_font)},
                             {"grey", reader.into(picture.style.grey)}});
}

} // namespace

StudyPicture read_picture(const StudyReader& reader, const TomlEntry& entry) {
    StudyPicture picture;
    picture.name = entry.name;
    picture.place = entry.place;
    Mistakes mistakes;
    mistakes.attempt([&] { require_file_name(picture.name, "name of a picture", entry.place); });
    mistakes.attempt([&] { read_picture_keys(reader, entry, picture); });
    mistakes.attempt([&] {
        if (entry.node->is_table())
            check_keys_of_picture(reader, picture.kind, reader.toml().entries(reader.toml().table(entry), entry.path));
    });
    mistakes.attempt([&] { require_few(picture.y.size(), most_axes, "vertical axes", entry); });
    mistakes.attempt([&] { require_few(picture.runs.size() + picture.over.size(), most_runs_shown, "runs", entry); });
    mistakes.throw_noted();
    if (picture.runs.empty())
        throw InputError(entry.place, fmt::format("{} shows no run", entry.path), "give run = \"NAME\"");
    return picture;
}

void check_shown_names(const StudyReader& reader, const Study& study, const StudyPicture& picture,
                       const TomlEntry& entry) {
    if (picture.names.empty())
        return;
    ShowableNames showable(picture);
    for (const auto* runs : {&picture.runs, &picture.over})
        for (const std::string& run : *runs)
            showable.add(*study.find_run(run));
    for (const TomlEntry& key : reader.toml().entries(reader.toml().table(entry), entry.path))
        if (key.name == "names")
            reader.each_of(key, {}, [&](const TomlEntry& item) { showable.require(item.name, item.place, item.path); });
}

} // namespace graze
