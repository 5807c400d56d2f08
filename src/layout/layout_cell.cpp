#include "graze/layout/layout_cell.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace graze {

namespace {

using LayerText = std::pair<MaskLayer, std::string_view>;
constexpr std::array<LayerText, 16> layer_table{{
    {mask_layers::back, "mask 1: etched from the back (chambers)"},
    {mask_layers::back_letters, "mask 1: letters"},
    {mask_layers::back_marks, "mask 1: alignment marks"},
    {mask_layers::front, "mask 2: etched through from the front"},
    {mask_layers::front_letters, "mask 2: letters"},
    {mask_layers::front_marks, "mask 2: alignment marks"},
    {mask_layers::mass, "mass"},
    {mask_layers::beams, "beams of the flexures"},
    {mask_layers::trusses, "trusses of the flexures"},
    {mask_layers::electrode, "fixed electrode"},
    {mask_layers::base, "bonded base of the fixed electrode"},
    {mask_layers::stops, "stops"},
    {mask_layers::die, "outline of the die"},
    {mask_layers::notes, "notes"},
    {mask_layers::wafer, "outline of the wafer"},
    {mask_layers::usable, "outline of the part for devices"},
}};

constexpr std::size_t longest_cell_name = 28; // GDSII allows 32, some of which a suffix may need

struct Transform {
    double cosine = 1, sine = 0;
    bool mirrored = false;
    double x = 0, y = 0;

    std::pair<double, double> operator()(double px, double py) const {
        const double up = mirrored ? -py : py;
        return {x + cosine * px - sine * up, y + sine * px + cosine * up};
    }
};

Transform within(const Transform& outer, const CellReference& reference) {
    constexpr double right_angle = 90;
    const double turns = reference.degrees / right_angle, angle = reference.degrees * std::numbers::pi / 180;
    // Right angles are exact, so that rotated cells stay on the grid.
    const bool exact = turns == std::round(turns);
    const double cosine = exact ? std::round(std::cos(angle)) : std::cos(angle);
    const double sine = exact ? std::round(std::sin(angle)) : std::sin(angle);
    const double up = outer.mirrored ? -1 : 1;
    Transform result;
    result.mirrored = outer.mirrored != reference.mirrored;
    result.cosine = outer.cosine * cosine - outer.sine * up * sine;
    result.sine = outer.sine * cosine + outer.cosine * up * sine;
    std::tie(result.x, result.y) = outer(static_cast<double>(reference.at.x), static_cast<double>(reference.at.y));
    return result;
}

using CellIndex = std::unordered_map<std::string_view, const LayoutCell*>;

/// Indexes the cells; each may only contain earlier ones, hence never itself.
CellIndex index_of(const LayoutLibrary& library) {
    CellIndex index;
    for (const LayoutCell& cell : library.cells) {
        for (const CellReference& reference : cell.references)
            if (!index.contains(reference.cell))
                throw InputError(
                    fmt::format("cell '{}' refers to '{}', which is not before it", cell.name, reference.cell),
                    "give each cell after those that it contains, and none within itself");
        if (!index.emplace(cell.name, &cell).second)
            throw InputError(fmt::format("there are two cells of the name '{}'", cell.name), "give each its own name");
    }
    return index;
}

void flatten(const CellIndex& index, const LayoutCell& cell, const Transform& placed,
             std::vector<PlacedShape>& shapes) {
    for (const CellShape& shape : cell.shapes) {
        PlacedShape& one = shapes.emplace_back(PlacedShape{shape.layer, {}});
        for (const GridPoint& corner : shape.polygon) {
            const auto [x, y] = placed(static_cast<double>(corner.x), static_cast<double>(corner.y));
            one.polygon.push_back({std::llround(x), std::llround(y)});
        }
    }
    for (const CellReference& reference : cell.references)
        flatten(index, *index.at(reference.cell), within(placed, reference), shapes);
}

std::map<MaskLayer, double> areas_within(const CellIndex& index, const LayoutCell& top) {
    std::map<MaskLayer, double> areas;
    for (const CellShape& shape : top.shapes)
        areas[shape.layer] += area_of(shape.polygon);
    for (const CellReference& reference : top.references)
        for (const auto& [layer, area] : areas_within(index, *index.at(reference.cell)))
            areas[layer] += area;
    return areas;
}

const LayoutCell& cell_named(const LayoutLibrary& library, std::string_view name) {
    const LayoutCell* cell = library.find(name);
    if (!cell)
        throw InputError("there is no cell '" + std::string(name) + "'", "");
    return *cell;
}

} // namespace

std::string_view layer_text(MaskLayer layer) {
    for (const auto& [one, text] : layer_table)
        if (one == layer)
            return text;
    return {};
}

std::vector<MaskLayer> all_layers() {
    std::vector<MaskLayer> layers;
    for (const auto& [one, text] : layer_table)
        layers.push_back(one);
    return layers;
}

const LayoutCell* LayoutLibrary::find(std::string_view cell) const {
    const auto found =
        std::find_if(cells.begin(), cells.end(), [&](const LayoutCell& one) { return one.name == cell; });
    return found == cells.end() ? nullptr : &*found;
}

void require_order_of_cells(const LayoutLibrary& library) {
    index_of(library);
}

std::vector<PlacedShape> flattened(const LayoutLibrary& library, std::string_view cell) {
    std::vector<PlacedShape> shapes;
    flatten(index_of(library), cell_named(library, cell), {}, shapes);
    return shapes;
}

std::map<MaskLayer, double> areas_of(const LayoutLibrary& library, std::string_view cell) {
    return areas_within(index_of(library), cell_named(library, cell));
}

std::string cell_name(std::string_view text) {
    std::string name;
    for (const char c : text.substr(0, longest_cell_name))
        name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
    return name;
}

} // namespace graze
