#include "graze/picture/fabrication_picture.hpp"

#include "graze/picture/figure.hpp"
#include "picture/gnuplot_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace graze {

namespace {

// In pixels, like all positions on the page.
constexpr double fabrication_width = 1000, page_margin = 20, title_height = 26, section_height = 112, row_gap = 16,
                 letter_size = 14;
constexpr std::size_t row_columns = 2;

struct MaterialLook {
    ProcessMaterial material;
    const char *name, *colour;
};
/// Materials in drawing order, from the lowest layer upwards; the colours differ in grey too.
constexpr std::array<MaterialLook, 4> material_looks{{{ProcessMaterial::silicon, "silicon", "#b8bec6"},
                                                      {ProcessMaterial::epoxy, "epoxy (SU-8)", "#3f7f4f"},
                                                      {ProcessMaterial::resist, "photoresist", "#e8a33d"},
                                                      {ProcessMaterial::aluminium, "aluminium", "#1c2f5c"}}};

/// Range of the coordinates of all cross-sections, which have one scale.
PlaneBox extent_of_steps(const std::vector<ProcessStep>& steps) {
    PlaneBox extent;
    for (const ProcessStep& step : steps)
        for (const ProcessSlab& slab : step.slabs)
            extent = {std::min(extent.left, slab.left), std::max(extent.right, slab.right),
                      std::min(extent.low, slab.low), std::max(extent.high, slab.high)};
    return extent;
}

class FabricationPicture {
public:
    explicit FabricationPicture(const std::vector<ProcessStep>& steps)
        : steps_(&steps), extent_(extent_of_steps(steps)), rows_((steps.size() + row_columns) / row_columns),
          page_height_(static_cast<double>(rows_) * (title_height + section_height + row_gap) + 2 * page_margin) {}

    std::string text(const std::string& ending, const std::string& output) {
        for (std::size_t i = 0; i < steps_->size(); ++i)
            draw((*steps_)[i], i);
        write_legend(steps_->size());
        const std::string font = fmt::format("font 'sans,{:.3g}'", ending == "pdf" ? 0.75 * letter_size : letter_size);
        const std::string size =
            drawing_terminal(ending, fabrication_width, page_height_, 2) + (ending == "png" ? " fontscale 1.5" : "");
        return fmt::format("set terminal {} {}\nset output {}\nset encoding utf8\nunset key\nunset tics\nunset border\n"
                           "set lmargin at screen 0\nset rmargin at screen 1\nset bmargin at screen 0\nset tmargin at "
                           "screen 1\nset xrange [0:{}]\nset yrange [{}:0]\n{}plot NaN\nset output\n",
                           size, font, quoted_path(output), fabrication_width, page_height_, commands_);
    }

private:
    /// Upper left corner of a step's cross-section.
    std::pair<double, double> corner(std::size_t place) const {
        const double width = fabrication_width / static_cast<double>(row_columns);
        const std::size_t row = place / row_columns;
        return {width * static_cast<double>(place % row_columns) + page_margin,
                page_margin + static_cast<double>(row) * (title_height + section_height + row_gap)};
    }
    static double section_width() { return fabrication_width / static_cast<double>(row_columns) - 2 * page_margin; }

    void rectangle(double left, double top, double right, double bottom, const char* colour) {
        // The border has the same colour, so that no seams appear between touching slabs.
        commands_ += fmt::format("set object rectangle from {:.6g},{:.6g} to {:.6g},{:.6g} fc rgb '{}' fs solid border "
                                 "lc rgb '{}' lw 0.3\n",
                                 left, bottom, right, top, colour, colour);
    }
    void write(const std::string& what, double x, double y) {
        commands_ += fmt::format("set label \"{}\" at {:.6g},{:.6g} left\n", plain(what), x, y);
    }

    void draw(const ProcessStep& step, std::size_t place) {
        const auto [left, top] = corner(place);
        const double across = section_width() / (extent_.right - extent_.left),
                     up = section_height / (extent_.high - extent_.low), base = top + title_height + section_height;
        write(step.text, left, top + title_height / 2);
        for (const MaterialLook& look : material_looks)
            for (const ProcessSlab& slab : step.slabs)
                if (slab.material == look.material)
                    rectangle(left + (slab.left - extent_.left) * across, base - (slab.high - extent_.low) * up,
                              left + (slab.right - extent_.left) * across, base - (slab.low - extent_.low) * up,
                              look.colour);
    }

    /// Writes the legend in the place after the last step.
    void write_legend(std::size_t place) {
        constexpr double box = 18, row = 25;
        const auto [left, top] = corner(place);
        double y = top + title_height / 2;
        for (const MaterialLook& look : material_looks) {
            rectangle(left, y - box / 2, left + 2 * box, y + box / 2, look.colour);
            write(look.name, left + 3 * box, y);
            y += row;
        }
        const double times =
            section_height / (extent_.high - extent_.low) / (section_width() / (extent_.right - extent_.left));
        write(fmt::format("heights {:.2g} times as large as lengths, films thicker than they are", times), left, y);
    }

    const std::vector<ProcessStep>* steps_;
    PlaneBox extent_;
    std::size_t rows_;
    double page_height_;
    std::string commands_;
};

} // namespace

std::string fabrication_picture_script(const std::vector<ProcessStep>& steps, const std::string& ending,
                                       const std::string& output) {
    return FabricationPicture(steps).text(ending, output);
}

} // namespace graze
