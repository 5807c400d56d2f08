#include "picture/layout_labels.hpp"

#include "graze/layout/layout.hpp"
#include "layout/mask_outlines.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace graze::testing::layout_labels_test {

/// True when a polygon of a layer in the flattened drawing contains a point.
bool has(const Layout& layout, MaskLayer layer, GridPoint at) {
    const std::vector<PlacedShape> shapes = flattened(layout.library, layout.top);
    return std::any_of(shapes.begin(), shapes.end(),
                       [&](const PlacedShape& one) { return one.layer == layer && contains(one.polygon, at); });
}

/// The part that is drawn at a point.
std::string part_at(const Layout& layout, GridPoint at) {
    for (const MaskLayer layer : {mask_layers::beams, mask_layers::trusses, mask_layers::mass, mask_layers::electrode,
                                  mask_layers::stops, mask_layers::front})
        if (has(layout, layer, at))
            return layer == mask_layers::front ? "trench" : std::string(layer_text(layer));
    return "frame";
}

TEST(LayoutLabels, LeadersEndOnTheirParts) {
    const std::vector<GivenLengths> devices{
        {},
        {{"electrode_length", 600}, {"pad_width", 1800}},
        {{"electrode_length", 300}, {"pad_width", 200}, {"pad_length", 2000}, {"electrode_width", 100}},
        {{"electrode_length", 2600}, {"pad_width", 300}, {"electrode_width", 900}},
        {{"folds", 5}, {"flexure_length", 700}, {"electrode_length", 1000}},
        {{"chamber_margin", 0}, {"bar_width", 20}},
        {{"flexure_length", 300}, {"electrode_length", 500}, {"pad_width", 500}, {"stop_width", 40}},
    };
    for (const GivenLengths& given : devices) {
        const Layout layout = draw_device_layout(load_device_file("mems-switch-device", given));
        const auto text_of = [](MaskLayer layer) { return std::string(layer_text(layer)); };
        std::size_t known = 0;
        for (const PartLabel& label : part_labels(layout.devices[0].drawing)) {
            const auto leads_to = [&](const char* start, const std::string& part) {
                if (!label.text.starts_with(start))
                    return;
                ++known;
                EXPECT_EQ(part_at(layout, label.at), part) << label.text;
            };
            leads_to("gap", "trench");
            leads_to("fixed electrode", text_of(mask_layers::electrode));
            leads_to("its bonded base", text_of(mask_layers::electrode));
            leads_to("contact pad", text_of(mask_layers::electrode));
            leads_to("moat", "trench");
            leads_to("finger", "frame");
            leads_to("lug", text_of(mask_layers::mass));
            leads_to("folded flexure", text_of(mask_layers::beams));
            leads_to("beam", text_of(mask_layers::beams));
            leads_to("mass", text_of(mask_layers::mass));
            leads_to("stop", text_of(mask_layers::stops));
            leads_to("channel", "trench");
            leads_to("truss", text_of(mask_layers::trusses));
            leads_to("frame", "frame");
            if (label.text.starts_with("its bonded base")) {
                EXPECT_TRUE(has(layout, mask_layers::base, label.at));
            }
            if (label.text.starts_with("gap")) { // between electrode and mass, not beside them
                const GridBox electrode = bounding_box(layout.devices[0].drawing.electrode);
                EXPECT_GT(label.at.x, electrode.right);
                EXPECT_TRUE(has(layout, mask_layers::electrode, {electrode.right, label.at.y}));
            }
        }
        EXPECT_EQ(known, 14U);
    }
}

TEST(LayoutLabels, ScaleBarsAreRound) {
    EXPECT_DOUBLE_EQ(round_length(999), 500);
    EXPECT_DOUBLE_EQ(round_length(499), 200);
    EXPECT_DOUBLE_EQ(round_length(199), 100);
    EXPECT_DOUBLE_EQ(round_length(0.03), 0.02);
}

} // namespace graze::testing::layout_labels_test
