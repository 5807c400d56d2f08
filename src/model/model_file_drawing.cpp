#include "model/model_file_drawing.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <optional>

namespace graze {

namespace {

std::vector<std::string> texts_of(const auto& names) {
    return {names.begin(), names.end()};
}

/// The keys that a kind of shape needs.
std::vector<std::string> keys_of(ShapeKind kind) {
    if (has_ends(kind))
        return {"from", "to"};
    switch (kind) {
    case ShapeKind::path:
        return {"points"};
    case ShapeKind::box:
        return {"at", "size"};
    case ShapeKind::circle:
        return {"at", "radius"};
    default:
        return {"at", "text"};
    }
}

std::string example_of(std::string_view key) {
    if (key == "points")
        return "points = [[0, 0], [1, \"x\"], [2, 0]]";
    if (key == "radius")
        return "radius = 0.1";
    if (key == "text")
        return "text = \"...\"";
    return fmt::format("{} = [{}]", key, key == "size" ? "0.4, 0.3" : "\"x\", 0");
}

} // namespace

DrawnPair DrawingParts::pair(const TomlEntry& entry, const char* expected) {
    places_.set(entry.path, reader_.place(*entry.node));
    if (!entry.node->is_array() || entry.node->as_array()->size() != 2)
        throw InputError(reader_.place(*entry.node), fmt::format("{} must be a list of {}", entry.path, expected),
                         "give two numbers or expressions, as in [\"x\", 0.5]");
    const std::vector<TomlEntry> both = reader_.elements(entry);
    return {expression_text(both[0]), expression_text(both[1])};
}

std::vector<DrawnPair> DrawingParts::path_points(const TomlEntry& entry) {
    places_.set(entry.path, reader_.place(*entry.node));
    std::vector<DrawnPair> result;
    for (const TomlEntry& point : reader_.elements(entry)) {
        if (result.size() == most_points_of_a_path)
            throw InputError(reader_.place(*point.node),
                             fmt::format("{} has more than {} points", entry.path, most_points_of_a_path),
                             "draw it by fewer points");
        result.push_back(pair(point, "two coordinates"));
    }
    return result;
}

std::string DrawingParts::required_text(const TomlEntry& entry) {
    const std::string text = reader_.line(entry);
    if (text.empty())
        throw InputError(reader_.place(*entry.node), fmt::format("{} is empty", entry.path),
                         "write something, or leave the shape out");
    return text;
}

DrawnShape DrawingParts::shape(const TomlEntry& entry) {
    DrawnShape result;
    places_.set(entry.path, entry.place);
    std::optional<ShapeKind> kind;
    std::map<std::string, TomlEntry> given;
    std::vector<TomlEntry> modes;
    const auto keep = [&](const TomlEntry& part) { given.emplace(part.name, part); };
    read_parts(entry, {{"kind",
                        [&](const TomlEntry& part) {
                            kind = static_cast<ShapeKind>(choice(part, texts_of(shape_kind_names)));
                        }},
                       {"colour",
                        [&](const TomlEntry& part) {
                            result.colour = static_cast<ShapeColour>(choice(part, texts_of(shape_colour_names)));
                        }},
                       {"modes", [&](const TomlEntry& part) { modes = reader_.elements(part); }},
                       {"from", keep},
                       {"to", keep},
                       {"points", keep},
                       {"at", keep},
                       {"size", keep},
                       {"radius", keep},
                       {"text", keep}});
    if (!kind)
        fail_missing(entry, "kind", "kind");
    result.kind = *kind;
    for (const TomlEntry& mode : modes)
        result.modes.push_back(index(mode, model_.modes, "mode"));
    const std::vector<std::string> needed = keys_of(*kind);
    for (const auto& [key, part] : given)
        if (std::ranges::find(needed, key) == needed.end())
            throw InputError(part.place, fmt::format("a {} has no '{}'", name_of(*kind), key),
                             fmt::format("say where it is by {}", fmt::join(needed, " and ")));
    for (const std::string& key : needed) {
        const auto found = given.find(key);
        if (found == given.end())
            throw InputError(entry.place, fmt::format("{} is a {} without '{}'", entry.path, name_of(*kind), key),
                             "add " + example_of(key));
        const TomlEntry& part = found->second;
        if (key == "points")
            result.points = path_points(part);
        else if (key == "size")
            result.size = pair(part, "width and height");
        else if (key == "radius")
            result.radius = expression_text(part);
        else if (key == "text")
            result.text = required_text(part);
        else
            result.points.push_back(pair(part, "two coordinates"));
    }
    return result;
}

void DrawingParts::read_drawing(const TomlEntry& group) {
    ModelDrawing drawing;
    places_.set(group.path, group.place);
    const auto limits = [&](std::array<std::string, 2>& to, const TomlEntry& entry) {
        const DrawnPair both = pair(entry, "two limits of the scene");
        to = {both.x, both.y};
    };
    const auto shapes = [&](const TomlEntry& part) {
        places_.set(part.path, reader_.place(*part.node));
        for (const TomlEntry& entry : reader_.elements(part)) {
            if (drawing.shapes.size() == most_shapes)
                throw InputError(entry.place, fmt::format("the drawing has more than {} shapes", most_shapes),
                                 "draw the mechanics only, or join lines to a path");
            mistakes_.attempt([&] { drawing.shapes.push_back(shape(entry)); });
        }
    };
    read_parts(group, {{"text", text_into(drawing.text)},
                       {"x", [&](const TomlEntry& part) { limits(drawing.x, part); }},
                       {"y", [&](const TomlEntry& part) { limits(drawing.y, part); }},
                       {"shapes", shapes}});
    for (const char* key : {"x", "y"})
        if ((key[0] == 'x' ? drawing.x : drawing.y)[0].empty())
            throw InputError(group.place, fmt::format("the drawing has no limits in {}", key),
                             fmt::format("add {} = [-1, 1]: what the scene shows", key));
    model_.drawing = std::move(drawing);
}

} // namespace graze
