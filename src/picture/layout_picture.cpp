#include "graze/picture/layout_picture.hpp"

#include "graze/base/input_error.hpp"
#include "graze/picture/figure.hpp"
#include "layout/grid_lengths.hpp"
#include "picture/gnuplot_text.hpp"
#include "picture/layout_labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace graze {

namespace {

constexpr double page_width = 1000, page_of_all = 1420; ///< pixels, like all positions on the page
constexpr double font_height = 15;                      ///< font height

/// A rectangle on the page; `top` is measured downwards from the upper edge.
struct PageBox {
    double left, top, width, height;
};

struct LayerStyle {
    MaskLayer layer;
    const char* colour;
};

/// Layers in drawing order, the lowest first.
constexpr LayerStyle device_styles[] = {
    {mask_layers::die, "#d9d9d9"},           {mask_layers::wafer, "#d9d9d9"},       {mask_layers::front, "#ffffff"},
    {mask_layers::front_letters, "#ffffff"}, {mask_layers::front_marks, "#ffffff"}, {mask_layers::electrode, "#ee7733"},
    {mask_layers::stops, "#666666"},         {mask_layers::mass, "#4477aa"},        {mask_layers::trusses, "#77aadd"},
    {mask_layers::beams, "#225588"},
};
constexpr LayerStyle mask_styles[][3] = {
    {{mask_layers::back, "#222222"}, {mask_layers::back_letters, "#222222"}, {mask_layers::back_marks, "#222222"}},
    {{mask_layers::front, "#222222"}, {mask_layers::front_letters, "#222222"}, {mask_layers::front_marks, "#222222"}}};

/// Middle of a box, in micrometres.
PlanePoint middle_of(const GridBox& box) {
    return {static_cast<double>(box.left + box.right) / 2 / grid_per_micrometre,
            static_cast<double>(box.bottom + box.top) / 2 / grid_per_micrometre};
}

class LayoutPicture {
public:
    LayoutPicture(const Layout& layout, const std::string& ending)
        : layout_(&layout), ending_(ending), shapes_(flattened(layout.library, layout.top)) {
        for (const PlacedShape& shape : shapes_)
            by_layer_[shape.layer].push_back(&shape.polygon);
    }

    std::string text(const std::string& output) {
        const bool is_wafer = !layout_->sites.empty();
        const GridBox all = box_of(is_wafer ? mask_layers::wafer : mask_layers::die);
        const PageBox schematic{0, 30, page_width, 860};
        if (is_wafer)
            draw_wafer(schematic, all);
        else
            draw_device(schematic);
        const double side = 460, top = page_height_ - side - 10;
        for (const int mask : {1, 2})
            draw_mask(mask, {mask == 1 ? 30 : page_width - side - 30, top, side, side}, all);
        return whole(output);
    }

    /// The picture of one mask.
    std::string text_of_mask(const std::string& output, int mask) {
        page_height_ = page_width + 30; // the mask is a square below its name
        const bool is_wafer = !layout_->sites.empty();
        draw_mask(mask, {30, 60, page_width - 60, page_height_ - 90},
                  box_of(is_wafer ? mask_layers::wafer : mask_layers::die));
        return whole(output);
    }

private:
    void draw_mask(int mask, const PageBox& place, const GridBox& all) {
        begin_panel(place, all, 0.02);
        outline(layout_->sites.empty() ? mask_layers::die : mask_layers::wafer, "#888888");
        for (const LayerStyle& style : mask_styles[mask - 1])
            fill(style);
        end_panel();
        page_text(mask == 1 ? "mask 1: etched from the back (seen from the front)"
                            : "mask 2: etched through from the front",
                  place.left + place.width / 2, place.top - font_height);
    }

    std::string whole(const std::string& output) const {
        const std::string font = fmt::format("font 'sans,{:.3g}'", ending_ == "pdf" ? 0.75 * font_height : font_height);
        const std::string terminal =
            drawing_terminal(ending_, page_width, page_height_) + (ending_ == "png" ? " fontscale 0.75" : "");
        return fmt::format("set terminal {} {}\nset output {}\nset encoding utf8\nunset key\nunset tics\nunset border\n"
                           "set style fill solid\n"
                           "set style textbox opaque margins 0.4,0.4 fillcolor rgb '#ffffff' noborder\n"
                           "set multiplot\n{}{}unset multiplot\nset output\n",
                           terminal, font, quoted_path(output), data_, commands_);
    }

    GridBox box_of(MaskLayer layer) const {
        const auto found = by_layer_.find(layer);
        if (found == by_layer_.end())
            return {};
        GridBox box = bounding_box(*found->second.front());
        for (const GridPolygon* one : found->second)
            box = box.with(bounding_box(*one));
        return box;
    }

    /// Begins a panel in which `box` is drawn as large as possible, with equal scales.
    /// @param margin fraction of the box that stays free on each side; @param side_room pixels for labels on both sides
    void begin_panel(const PageBox& place, const GridBox& box, double margin, double side_room = 0) {
        scale_ = std::max(micrometres(box.width()) * (1 + 2 * margin) / (place.width - 2 * side_room),
                          micrometres(box.height()) * (1 + 2 * margin) / place.height);
        const auto [x, y] = middle_of(box);
        left_ = x - scale_ * place.width / 2;
        right_ = x + scale_ * place.width / 2;
        bottom_ = y - scale_ * place.height / 2;
        top_ = y + scale_ * place.height / 2;
        commands_ += fmt::format(
            "unset arrow\nunset label\nunset object\nset lmargin at screen {:.6g}\nset rmargin at screen {:.6g}\n"
            "set tmargin at screen {:.6g}\nset bmargin at screen {:.6g}\n"
            "set xrange [{:.10g}:{:.10g}]\nset yrange [{:.10g}:{:.10g}]\n",
            place.left / page_width, (place.left + place.width) / page_width, 1 - place.top / page_height_,
            1 - (place.top + place.height) / page_height_, left_, right_, bottom_, top_);
    }

    void end_panel() {
        commands_ += "plot " + (plots_.empty() ? "NaN" : plots_) + '\n';
        plots_.clear();
    }

    /// Adds the polygons of a layer as a datablock. @return its name
    /// @param closed false: without edges on y = 0, where the halves of a shape touch
    std::string block(MaskLayer layer, bool closed) {
        const std::string name = fmt::format("$l{}_{}_{}", layer.layer, layer.datatype, ++blocks_);
        data_ += name + " << EOD\n";
        for (const GridPolygon* polygon : by_layer_[layer]) {
            for (std::size_t i = 0; i <= polygon->size(); ++i) {
                const GridPoint& point = (*polygon)[i % polygon->size()];
                if (!closed && i > 0 && point.y == 0 && (*polygon)[i - 1].y == 0)
                    data_ += '\n';
                data_ += fmt::format("{:.10g} {:.10g}\n", micrometres(point.x), micrometres(point.y));
            }
            data_ += '\n';
        }
        data_ += "EOD\n";
        return name;
    }

    /// Plots a layer, if there is anything on it.
    void plot(MaskLayer layer, bool closed, const std::string& style) {
        if (by_layer_.contains(layer))
            plots_ += (plots_.empty() ? "" : ", ") + block(layer, closed) + style;
    }

    void fill(const LayerStyle& style) {
        // The border has the same colour, so that no seams appear between touching polygons.
        plot(style.layer, true,
             fmt::format(" with filledcurves closed fc rgb '{0}' fs solid border lc rgb '{0}' lw 0.7", style.colour));
    }

    void outline(MaskLayer layer, const char* colour, const char* dashes = "1") {
        plot(layer, layer != mask_layers::back, fmt::format(" with lines lc rgb '{}' dt {} lw 1", colour, dashes));
    }

    void page_text(const std::string& text, double x, double y) {
        commands_ += fmt::format("set label \"{}\" at screen {:.6g},{:.6g} center\nplot NaN\nunset label\n",
                                 plain(text), x / page_width, 1 - y / page_height_);
    }

    void draw_device(const PageBox& place) {
        const DeviceDrawing& drawing = layout_->devices.front().drawing;
        begin_panel(place, drawing.chamber_box, 0.02, 235);
        for (const LayerStyle& style : device_styles)
            fill(style);
        outline(mask_layers::back, "#aa3377", "2");
        outline(mask_layers::base, "#aa3377", "3");
        const std::vector<PartLabel> labels = part_labels(drawing);
        for (const bool to_left : {true, false})
            write_labels(labels, to_left);
        write_scale();
        end_panel();
    }

    /// Writes the labels of one side below one another, each as near as possible to the height of its part.
    void write_labels(const std::vector<PartLabel>& labels, bool to_left) {
        std::vector<PartLabel> here;
        std::copy_if(labels.begin(), labels.end(), std::back_inserter(here),
                     [&](const PartLabel& one) { return one.to_left == to_left; });
        std::stable_sort(here.begin(), here.end(),
                         [](const PartLabel& a, const PartLabel& b) { return a.at.y > b.at.y; });
        const double step = 2.2 * font_height * scale_;
        std::vector<double> places;
        for (const PartLabel& one : here)
            places.push_back(places.empty() ? micrometres(one.at.y)
                                            : std::min(micrometres(one.at.y), places.back() - step));
        const double least = bottom_ + 2.5 * step; // above the scale bar
        for (std::size_t i = places.size(); i-- > 0;)
            places[i] = std::max(places[i], i + 1 < places.size() ? places[i + 1] + step : least);
        for (std::size_t i = 0; i < here.size(); ++i) {
            const double inset = 225 * scale_;
            const double x = to_left ? left_ + inset : right_ - inset;
            // `boxed` texts have an opaque background.
            commands_ += fmt::format("set label \"{}\" at {:.10g},{:.10g} {} front boxed\n", plain(here[i].text),
                                     to_left ? x - 8 * scale_ : x + 8 * scale_, places[i], to_left ? "right" : "left");
            commands_ += fmt::format("set arrow from {:.10g},{:.10g} to {:.10g},{:.10g} nohead lw 0.8 lc rgb '#000000' "
                                     "front\n",
                                     x, places[i], micrometres(here[i].at.x), micrometres(here[i].at.y));
            commands_ +=
                fmt::format("set object circle at {:.10g},{:.10g} size {:.6g} fc rgb '#000000' fs solid front\n",
                            micrometres(here[i].at.x), micrometres(here[i].at.y), 2.5 * scale_);
        }
    }

    /// Draws the scale bar in the lower right corner.
    void write_scale() {
        const double length = round_length(0.2 * (right_ - left_));
        const double to = right_ - font_height * scale_, y = bottom_ + font_height * scale_;
        constexpr double millimetre = 1000;
        commands_ += fmt::format("set arrow from {:.10g},{:.10g} to {:.10g},{:.10g} nohead lw 3 lc rgb '#000000' "
                                 "front\nset label \"{:.6g} {}\" at {:.10g},{:.10g} center front boxed\n",
                                 to - length, y, to, y, length < millimetre ? length : length / millimetre,
                                 length < millimetre ? "µm" : "mm", to - length / 2, y + font_height * scale_);
    }

    void draw_wafer(const PageBox& place, const GridBox& all) {
        begin_panel(place, all, 0.02);
        fill({mask_layers::wafer, "#d9d9d9"});
        outline(mask_layers::usable, "#888888", "2");
        fill({mask_layers::back, "#bbaacc"});
        for (const LayerStyle& style : device_styles)
            if (style.layer != mask_layers::wafer && style.layer != mask_layers::die)
                fill(style);
        fill({mask_layers::back_marks, "#aa3377"});
        fill({mask_layers::back_letters, "#bbaacc"});
        outline(mask_layers::die, "#999999");
        outline(mask_layers::wafer, "#444444");
        number_devices();
        write_scale();
        end_panel();
    }

    /// Writes the number of each device beside its die, towards the centre of the wafer.
    void number_devices() {
        const std::vector<const GridPolygon*>& dies = by_layer_[mask_layers::die];
        for (std::size_t i = 0; i < dies.size(); ++i) {
            const GridBox box = bounding_box(*dies[i]);
            const auto [x, y] = middle_of(box);
            const double size = micrometres(box.width()), from = std::hypot(x, y);
            const double inwards = from > 0 ? 1 - (size / 2 + font_height * scale_) / from : 1;
            if (size > 2 * font_height * scale_) // numbers would cover smaller dies
                commands_ +=
                    fmt::format("set label \"{}\" at {:.10g},{:.10g} center front\n", i + 1, x * inwards, y * inwards);
        }
    }

    const Layout* layout_;
    double page_height_ = page_of_all;
    std::string ending_;
    std::vector<PlacedShape> shapes_;
    std::map<MaskLayer, std::vector<const GridPolygon*>> by_layer_;
    double scale_ = 1, left_ = 0, right_ = 0, bottom_ = 0,
           top_ = 0; ///< micrometres per pixel; edges of the panel in micrometres
    std::string data_, commands_, plots_;
    std::size_t blocks_ = 0;
};

} // namespace

std::string layout_picture_script(const Layout& layout, const std::string& ending, const std::string& output,
                                  std::optional<int> mask) {
    LayoutPicture picture(layout, ending);
    return mask ? picture.text_of_mask(output, *mask) : picture.text(output);
}

} // namespace graze
