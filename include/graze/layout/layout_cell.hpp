#pragma once

#include "graze/layout/grid_polygon.hpp"

#include <compare>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A GDSII layer with its datatype.
struct MaskLayer {
    int layer = 0, datatype = 0;
    auto operator<=>(const MaskLayer&) const = default;
};

/// Layers of drawings. Polygons on the masks' layers are etched; the others are for information.
namespace mask_layers {
constexpr MaskLayer back{1, 0}, back_letters{1, 1}, back_marks{1, 2};    ///< mask 1: chambers, seen from the front
constexpr MaskLayer front{2, 0}, front_letters{2, 1}, front_marks{2, 2}; ///< mask 2: etched through
constexpr MaskLayer mass{10, 0}, beams{10, 1}, trusses{10, 2}, electrode{11, 0}, base{11, 1}, stops{12, 0};
constexpr MaskLayer die{20, 0}, notes{20, 1}, wafer{21, 0}, usable{21, 1};
} // namespace mask_layers

/// Description of a layer; empty for an unused one.
std::string_view layer_text(MaskLayer layer);
/// Returns all layers in the order of their numbers.
std::vector<MaskLayer> all_layers();

struct CellShape {
    MaskLayer layer;
    GridPolygon polygon;
};

struct CellText {
    MaskLayer layer;
    GridPoint at;
    std::string text;
    double height = 0; ///< micrometres
};

/// A placement of a cell in another: first mirrored (if so) from y to -y, then rotated counterclockwise, then moved.
struct CellReference {
    std::string cell;
    GridPoint at;
    bool mirrored = false;
    double degrees = 0;
};

/// A cell: polygons, texts and placements of other cells.
struct LayoutCell {
    std::string name{};
    std::vector<CellShape> shapes{};
    std::vector<CellText> texts{};
    std::vector<CellReference> references{};

    void add(MaskLayer layer, const GridPolygon& polygon) { shapes.push_back({layer, polygon}); }
    void add(MaskLayer layer, const GridBox& box) { add(layer, polygon_of(box)); }
    template <class Shape>
    void add_all(MaskLayer layer, const std::vector<Shape>& all) {
        for (const Shape& one : all)
            add(layer, one);
    }
};

/// A library of cells; each cell precedes those that refer to it.
struct LayoutLibrary {
    std::string name{};
    std::vector<LayoutCell> cells{};

    /// Null when there is none of that name; valid until cells are added or removed.
    const LayoutCell* find(std::string_view cell) const;
    bool has(std::string_view cell) const { return find(cell) != nullptr; }
};

/// A polygon in the coordinates of a cell, rounded to the nanometre.
struct PlacedShape {
    MaskLayer layer;
    GridPolygon polygon;
};
/// Returns all polygons of a cell and of the cells in it. @throws InputError for an unknown cell
/// @throws InputError unless each cell of the library follows those that it contains, and names are unique
std::vector<PlacedShape> flattened(const LayoutLibrary& library, std::string_view cell);
/// Returns the drawn area of a cell and of the cells in it by layer, in square micrometres; overlaps count twice.
std::map<MaskLayer, double> areas_of(const LayoutLibrary& library, std::string_view cell);

/// @throws InputError unless each cell follows those that it contains, and names are unique
void require_order_of_cells(const LayoutLibrary& library);

/// Converts a text to a valid cell name: at most 28 letters, digits and underscores.
std::string cell_name(std::string_view text);

} // namespace graze
