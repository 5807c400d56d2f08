#pragma once

#include "graze/layout/grid_polygon.hpp"

#include <compare>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A layer of GDSII with its datatype.
struct MaskLayer {
    int layer = 0, datatype = 0;
    auto operator<=>(const MaskLayer&) const = default;
};

/// Layers of drawings. Polygons on those of the masks are what is etched; the others are for people and programs.
namespace mask_layers {
constexpr MaskLayer back{1, 0}, back_letters{1, 1}, back_marks{1, 2};    ///< mask 1: chambers, seen from the front
constexpr MaskLayer front{2, 0}, front_letters{2, 1}, front_marks{2, 2}; ///< mask 2: etched through
constexpr MaskLayer mass{10, 0}, beams{10, 1}, trusses{10, 2}, electrode{11, 0}, base{11, 1}, stops{12, 0};
constexpr MaskLayer die{20, 0}, notes{20, 1}, wafer{21, 0}, usable{21, 1};
} // namespace mask_layers

/// What a layer has, for people. Empty for one that is not drawn on.
std::string_view layer_text(MaskLayer layer);
/// In the order of their numbers.
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

/// A cell within another: mirrored first, if it is, from y to -y, then turned counterclockwise, then moved.
struct CellReference {
    std::string cell;
    GridPoint at;
    bool mirrored = false;
    double degrees = 0;
};

struct LayoutCell {
    std::string name;
    std::vector<CellShape> shapes;
    std::vector<CellText> texts;
    std::vector<CellReference> references;

    void add(MaskLayer layer, const GridPolygon& polygon) { shapes.push_back({layer, polygon}); }
    void add(MaskLayer layer, const GridBox& box) { add(layer, polygon_of(box)); }
    template <class Shape>
    void add_all(MaskLayer layer, const std::vector<Shape>& all) {
        for (const Shape& one : all)
            add(layer, one);
    }
};

/// Cells, each before those that refer to it.
struct LayoutLibrary {
    std::string name;
    std::vector<LayoutCell> cells;

    /// Null when there is none of that name; valid until cells are added or removed.
    const LayoutCell* find(std::string_view cell) const;
    bool has(std::string_view cell) const { return find(cell) != nullptr; }
};

/// A polygon as it comes to lie in a cell, to the nanometre.
struct PlacedShape {
    MaskLayer layer;
    GridPolygon polygon;
};
/// All polygons of a cell and of what is in it. @throws InputError when there is no such cell
/// @throws InputError unless each cell of the library stands after those that it contains, under a name of its own
std::vector<PlacedShape> flattened(const LayoutLibrary& library, std::string_view cell);
/// Square micrometres of what is drawn in a cell and in those in it, by layer; what overlaps counts twice.
std::map<MaskLayer, double> areas_of(const LayoutLibrary& library, std::string_view cell);

/// @throws InputError unless each cell stands after those that it contains, under a name of its own
void require_order_of_cells(const LayoutLibrary& library);

/// Letters, digits and underscores: as names of cells may be. At most 28 of them.
std::string cell_name(std::string_view text);

} // namespace graze
