#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// What is drawn. The first four kinds lead from one point to another.
enum class ShapeKind {
    line,
    arrow,
    spring,
    wall, ///< a line that is hatched on its right, seen in its direction
    path, ///< lines from point to point
    box,
    circle,
    text,
};
inline constexpr std::array<std::string_view, 8> shape_kind_names{"line", "arrow", "spring", "wall",
                                                                  "path", "box",   "circle", "text"};

/// Black is the colour of writing, which is white on a dark ground.
enum class ShapeColour { black, grey, blue, orange, green, red };
inline constexpr std::array<std::string_view, 6> shape_colour_names{"black", "grey", "blue", "orange", "green", "red"};

inline std::string_view name_of(ShapeKind kind) {
    return shape_kind_names.at(static_cast<std::size_t>(kind));
}
inline std::string_view name_of(ShapeColour colour) {
    return shape_colour_names.at(static_cast<std::size_t>(colour));
}
/// Whether the shape leads from its first point to its second.
inline bool has_ends(ShapeKind kind) {
    return kind <= ShapeKind::wall;
}

/// Two expressions: a point, or a width and a height.
struct DrawnPair {
    std::string x, y;
};

/// One shape. Its numbers are the texts of expressions in states, parameters and definitions, so that it moves with the
/// states. They are texts to leave the graph of the model as it is: a drawing cannot change a number that is computed.
struct DrawnShape {
    ShapeKind kind = ShapeKind::line;
    std::vector<DrawnPair> points{}; ///< both ends, all points of a path, or the centre
    DrawnPair size{};                ///< width and height of a box
    std::string radius{};            ///< of a circle
    std::string text{};              ///< what is written; no expression
    ShapeColour colour = ShapeColour::black;
    std::vector<std::size_t> modes{}; ///< in which it is shown; empty: in all
};

/// A scene that shows a motion: one unit is as long horizontally as vertically.
struct ModelDrawing {
    std::string text{};
    std::array<std::string, 2> x{}, y{}; ///< limits of the scene, expressions in parameters
    std::vector<DrawnShape> shapes{};
};

inline constexpr std::size_t most_shapes = 100, most_points_of_a_path = 200;

struct Model;

/// The limits of a scene at the present parameters of a model.
struct SceneLimits {
    std::array<double, 2> x{}, y{};
};
/// Nothing without a drawing, and at parameters at which a limit is not finite or the upper one not above the lower.
std::optional<SceneLimits> scene_limits(const Model& model);

} // namespace graze
