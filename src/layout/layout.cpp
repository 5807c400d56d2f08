#include "graze/layout/layout.hpp"

#include "layout/device_cells.hpp"

#include <fmt/format.h>

#include <set>
#include <string>

namespace graze {

namespace {

void append_mask(LayoutLibrary& to, const Layout& layout, int mask) {
    if (mask != 1 && mask != 2)
        throw InputError(fmt::format("there is no mask {}", mask), "choose mask 1 or 2");
    const std::string ending = fmt::format("_M{}", mask);
    std::string top;
    std::set<std::string, std::less<>> kept;
    for (const LayoutCell& cell : layout.library.cells) {
        LayoutCell one{.name = cell.name + ending};
        for (const CellShape& shape : cell.shapes)
            if (shape.layer.layer == mask)
                one.shapes.push_back(shape);
        for (CellReference reference : cell.references) {
            reference.cell += ending;
            if (kept.contains(reference.cell))
                one.references.push_back(std::move(reference));
        }
        if (cell.name == layout.top)
            top = one.name;
        if (!one.shapes.empty() || !one.references.empty()) {
            kept.insert(one.name);
            to.cells.push_back(std::move(one));
        }
    }
    constexpr double half_turn = 180; // turns y -> -y into x -> -x
    const bool back = mask == 1;
    to.cells.push_back({.name = fmt::format("MASK_{}", mask), .references = {{top, {}, back, back ? half_turn : 0}}});
}

} // namespace

Layout draw_device_layout(const DeviceFile& file) {
    Layout layout;
    layout.library.name = cell_name(file.name);
    layout.devices.push_back({"DEVICE", draw_device(file)});
    add_device_cells(layout.library, layout.devices[0].drawing, "");
    layout.top = "DEVICE";
    return layout;
}

void add_masks(Layout& layout) {
    LayoutLibrary extended = layout.library;
    for (const int mask : {1, 2})
        append_mask(extended, layout, mask);
    layout.library = std::move(extended);
}

LayoutLibrary mask_library(const Layout& layout, int mask) {
    LayoutLibrary alone{.name = layout.library.name};
    append_mask(alone, layout, mask);
    return alone;
}

} // namespace graze
