#include "model/model_file_tables.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/piece_table.hpp"
#include "model/point_file.hpp"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace graze {

void TableParts::read_tables(const TomlEntry& group) {
    for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
        places_.set(entry.path, entry.place);
        if (mistakes_.attempt([&] { read_table(entry); }))
            continue;
        // A placeholder for expressions that look the table up.
        model_.graph->add_table(std::make_shared<const PieceTable>(
            entry.name, std::vector<PieceTable::Point>{{0, 0}, {1, 0}}, PieceTable::Options{}));
    }
}

void TableParts::read_table(const TomlEntry& entry) {
    std::optional<TomlEntry> file, points, columns;
    PieceTable::Options options;
    std::string text;
    constexpr std::array kinds{PieceTable::Interpolation::linear, PieceTable::Interpolation::cubic};
    constexpr std::array beyond{PieceTable::Outside::hold, PieceTable::Outside::linear, PieceTable::Outside::error};
    std::optional<TomlEntry> outside;
    read_parts(entry, {{"file", [&](const TomlEntry& part) { file = part; }},
                       {"columns", [&](const TomlEntry& part) { columns = part; }},
                       {"points", [&](const TomlEntry& part) { points = part; }},
                       {"interpolation",
                        [&](const TomlEntry& part) {
                            options.interpolation = kinds[choice(part, {"linear", "cubic"})];
                        }},
                       {"periodic", [&](const TomlEntry& part) { options.periodic = reader_.boolean(part); }},
                       {"outside", [&](const TomlEntry& part) { outside = part; }},
                       {"text", text_into(text)}});
    if (file.has_value() == points.has_value())
        throw InputError(entry.place, fmt::format("{} needs either points or a file", entry.path),
                         "give points = [[x, f], ...], or file = \"...\" in the folder of the model");
    if (columns && !file)
        throw InputError(columns->place, fmt::format("{} has columns but no file", entry.path), "leave columns out");
    if (outside && options.periodic)
        throw InputError(outside->place, fmt::format("{} is periodic: nothing is outside", entry.path),
                         "leave outside out, or periodic");
    if (outside)
        options.outside = beyond[choice(*outside, {"hold", "linear", "error"})];
    std::vector<std::string> names;
    if (columns) {
        for (const TomlEntry& element : reader_.elements(*columns))
            names.push_back(reader_.string(element));
        if (names.size() != 2)
            throw InputError(columns->place, fmt::format("{} names {} columns", columns->path, names.size()),
                             "name two: of the argument and of the value");
    }
    std::vector<PieceTable::Point> given = file ? points_of_file(*file, names) : points_in(*points);
    try {
        model_.graph->add_table(
            std::make_shared<const PieceTable>(entry.name, std::move(given), options, std::move(text)));
    } catch (const InputError& error) {
        const toml::node& node = file ? *file->node : *points->node;
        throw InputError(reader_.place(node), error.problem(), error.remedy());
    }
}

std::vector<PieceTable::Point> TableParts::points_in(const TomlEntry& entry) {
    std::vector<PieceTable::Point> points;
    for (const TomlEntry& element : reader_.elements(entry)) {
        std::vector<double> numbers;
        for (const TomlEntry& one : reader_.elements(element)) {
            if (!one.node->is_number())
                reader_.fail_type(one, "a number");
            numbers.push_back(number(one));
        }
        if (numbers.size() != 2)
            throw InputError(reader_.place(*element.node),
                             fmt::format("{} has {} numbers", element.path, numbers.size()),
                             "a point has two: argument and value");
        if (!points.empty() && !(points.back().x < numbers[0]))
            throw InputError(reader_.place(*element.node),
                             fmt::format("the abscissae of {} do not increase: {} follows {}", entry.path, numbers[0],
                                         points.back().x),
                             "sort the points, and leave out repeated ones");
        points.push_back({numbers[0], numbers[1]});
    }
    return points;
}

std::vector<PieceTable::Point> TableParts::points_of_file(const TomlEntry& entry,
                                                          const std::vector<std::string>& columns) {
    const std::string name = reader_.string(entry);
    if (!folder_)
        throw InputError(reader_.place(*entry.node),
                         fmt::format("the file '{}' of a table cannot be read: the model itself is in no file", name),
                         "write its points into the model, as points = [[x, f], ...]");
    std::string path;
    try {
        path = path_inside(*folder_, name);
    } catch (const InputError& error) {
        throw InputError(reader_.place(*entry.node), error.problem(), error.remedy());
    }
    return read_points(path, columns);
}

} // namespace graze
