#include "graze/base/file_name.hpp"
#include "graze/study/showable_names.hpp"
#include "study/picture_style.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

std::vector<std::string> picture_kinds() {
    return {"bifurcation", "branch",   "basin",      "map",     "history",  "portrait",
            "poincare",    "spectrum", "regression", "scatter", "residuals"};
}

/// One point, or a list of points, each given by one coordinate.
void read_points(const StudyReader& reader, const TomlEntry& entry, StudyPicture& picture) {
    const Model none;
    reader.each(reader.items(entry), [&](const TomlEntry& point) {
        reader.each_of(point, {}, [&](const TomlEntry& at) {
            require_plain_line(at.name, "coordinate", at.place);
            picture.at.emplace_back(at.name, reader.number(none, at));
        });
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

void read_key(const StudyReader& reader, const TomlEntry& item, StudyPicture& picture) {
    const Model none;
    const std::string& key = item.name;
    if (read_style(reader, item, picture))
        return;
    if (key == "kind") {
        const std::vector<std::string> kinds = picture_kinds();
        picture.kind = kinds[reader.choice(item, kinds)];
    } else if (key == "title") {
        picture.title = reader.toml().line(item);
    } else if (key == "run" || key == "runs") {
        picture.runs = reader.strings(item);
    } else if (key == "over") {
        picture.over = reader.strings(item);
    } else if (key == "x") {
        picture.x = reader.toml().line(item);
    } else if (key == "y") {
        picture.y = reader.strings(item);
    } else if (key == "samples") {
        picture.samplings = reader.strings(item);
    } else if (key == "directions") {
        picture.directions = reader.strings(item);
    } else if (key == "x_range") {
        picture.x_range = reader.range(none, item);
    } else if (key == "y_range") {
        picture.y_range = reader.range(none, item);
    } else if (key == "fit") {
        picture.fit = reader.range(none, item);
    } else if (key == "at") {
        read_points(reader, item, picture);
    } else if (key == "points") {
        picture.points = reader.strings(item);
    } else if (key == "logarithmic") {
        read_logarithmic(reader, item, picture);
    } else if (key == "successive") {
        picture.successive = reader.toml().boolean(item);
    } else if (key == "group") {
        picture.group = reader.toml().line(item);
    } else {
        const std::vector<std::string> formats = picture_formats();
        picture.format = formats[reader.choice(item, formats)];
    }
}

} // namespace

StudyPicture read_picture(const StudyReader& reader, const TomlEntry& entry) {
    StudyPicture picture;
    picture.name = entry.name;
    picture.place = entry.place;
    Mistakes mistakes;
    mistakes.attempt([&] { require_file_name(picture.name, "name of a picture", entry.place); });
    mistakes.attempt([&] {
        reader.each_of(entry,
                       {"kind",    "title",   "run",  "runs",    "x",       "y",           "samples", "directions",
                        "x_range", "y_range", "fit",  "at",      "points",  "logarithmic", "format",  "successive",
                        "group",   "names",   "over", "x_label", "y_label", "size",        "font",    "grey"},
                       [&](const TomlEntry& item) { read_key(reader, item, picture); });
    });
    mistakes.attempt([&] {
        if (entry.node->is_table())
            check_keys_of_picture(reader, picture.kind, reader.toml().entries(reader.toml().table(entry), entry.path));
    });
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
