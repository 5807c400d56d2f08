#include "graze/layout/layout.hpp"

#include "base/message_of.hpp"
#include "graze/layout/gds_stream.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <set>

namespace graze::testing::layout_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

DeviceFile file_of(const std::string& sections) {
    return parse_device_file("name = \"my-switch\"\n" + sections, "mine.toml");
}

std::string message(const std::string& sections) {
    return message_of([&] { draw_wafer_layout(file_of(sections)); });
}

/// Areas of the flattened polygons by layer, in square micrometres.
std::map<MaskLayer, double> flat_areas(const LayoutLibrary& library, const std::string& cell) {
    std::map<MaskLayer, double> areas;
    for (const PlacedShape& one : flattened(library, cell))
        areas[one.layer] += area_of(one.polygon);
    return areas;
}

TEST(Layout, OfADeviceHasItsCells) {
    Layout layout = draw_device_layout(file_of("[device]\n"));
    EXPECT_EQ(layout.top, "DEVICE");
    EXPECT_EQ(layout.library.name, "my_switch");
    EXPECT_EQ(flat_areas(layout.library, "DEVICE"), areas_of(layout.library, "DEVICE"));
    for (const MaskLayer layer : {mask_layers::back, mask_layers::front, mask_layers::front_marks, mask_layers::mass})
        EXPECT_GT(areas_of(layout.library, "DEVICE")[layer], 0);
    layout = draw_device_layout(file_of("[device]\nmark_size = 0\nlabel_height = 0\n"));
    EXPECT_FALSE(areas_of(layout.library, "DEVICE").contains(mask_layers::front_marks));
    EXPECT_FALSE(areas_of(layout.library, "DEVICE").contains(mask_layers::front_letters));
}

TEST(Layout, OfMasksHasOnlyTheirLayersAndMirrorsTheFirst) {
    Layout layout = draw_device_layout(file_of("[device]\n"));
    const auto all = areas_of(layout.library, "DEVICE");
    add_masks(layout);
    for (const int mask : {1, 2}) {
        const LayoutLibrary alone = mask_library(draw_device_layout(file_of("[device]\n")), mask);
        const std::string top = "MASK_" + std::to_string(mask);
        std::map<MaskLayer, double> expected;
        for (const auto& [layer, area] : all)
            if (layer.layer == mask)
                expected[layer] = area;
        EXPECT_EQ(areas_of(alone, top), expected);
        EXPECT_EQ(areas_of(layout.library, top), expected);
    }
    // The channel leads to the right, and to the left on the back.
    const auto box = [&](const char* cell) {
        GridBox found{};
        for (const PlacedShape& one : flattened(layout.library, cell))
            if (one.layer == mask_layers::back)
                found = found.with(bounding_box(one.polygon));
        return found;
    };
    EXPECT_EQ(box("DEVICE").right, 3'000'000);
    EXPECT_EQ(box("MASK_1"),
              (GridBox{-box("DEVICE").right, box("DEVICE").bottom, -box("DEVICE").left, box("DEVICE").top}));
    EXPECT_THROW(mask_library(layout, 3), InputError);
}

TEST(Layout, OfAWaferHasDevicesOnACircle) {
    const Layout layout = draw_wafer_layout(file_of("[device]\n[wafer]\n"));
    ASSERT_EQ(layout.sites.size(), 8U);
    EXPECT_THAT(layout.site_degrees, ElementsAre(22.5, 67.5, 112.5, 157.5, 202.5, 247.5, 292.5, 337.5));
    EXPECT_EQ(layout.devices.size(), 1U);
    const auto wafer = areas_of(layout.library, "WAFER"), device = areas_of(layout.library, "DEVICE");
    EXPECT_NEAR(wafer.at(mask_layers::mass), 8 * device.at(mask_layers::mass), 1e-6);
    // A disc less the segment beyond the flat; the circle is a polygon of about 720 sides, each of which removes a
    // share of (2 pi/720)^2/6 = 1.3e-5.
    const double radius = 50'000, half = 16'250, angle = std::asin(half / radius);
    const double disc = radius * radius * (M_PI - angle) + half * std::sqrt(radius * radius - half * half);
    EXPECT_NEAR(wafer.at(mask_layers::wafer), disc, 2e-5 * disc);
    // All channels point outwards: the etched polygons reach the edge.
    double farthest = 0;
    std::size_t masses = 0;
    for (const PlacedShape& one : flattened(layout.library, "WAFER"))
        for (const GridPoint& corner : one.polygon) {
            const double r = std::hypot(static_cast<double>(corner.x), static_cast<double>(corner.y));
            if (one.layer == mask_layers::front)
                farthest = std::max(farthest, r);
            if (one.layer == mask_layers::die) {
                EXPECT_LT(r, 45e6) << "of the part for devices";
            }
            masses += one.layer == mask_layers::mass ? 1 : 0;
        }
    EXPECT_NEAR(farthest, 50e6, 1e3)
        << "the channels end at the edge, a tenth of a millimetre to each side of the radius";
    EXPECT_EQ(masses, 8U * 20U) << "corners of eight masses";
}

/// Twelve devices, two of which point at the flat, at 15 degrees to either side of its middle.
TEST(Layout, OfAWaferHasChannelsThatEndAtItsFlat) {
    const Layout layout = draw_wafer_layout(file_of("[device]\n[wafer]\ndevices = 12\n"));
    const double flat = std::sqrt(50e6 * 50e6 - 16.25e6 * 16.25e6); // nm
    double lowest = 0;
    for (const PlacedShape& one : flattened(layout.library, "WAFER"))
        if (one.layer == mask_layers::front || one.layer == mask_layers::back)
            for (const GridPoint& corner : one.polygon) {
                // Corners are rounded when drawn, and again when rotated.
                lowest = std::min(lowest, static_cast<double>(corner.y));
                EXPECT_GE(static_cast<double>(corner.y), -flat - 2);
                EXPECT_LE(std::hypot(static_cast<double>(corner.x), static_cast<double>(corner.y)), 50e6 + 2);
            }
    EXPECT_NEAR(lowest, -flat, 5) << "and they do reach it";
    // Each channel, 200 um wide, is 17 mm long; two are shortened by the flat. Of the others the rim, 100^2/(2 50000) =
    // 0.1 um lower at their sides, removes half of that by its chords. Ends are on the grid.
    const double device = areas_of(layout.library, "DEVICE").at(mask_layers::front);
    const double cut = 50'000 - flat / 1000 / std::cos(M_PI / 12);
    const double expected = 12 * device + 200 * (12 * 17'000 - 2 * cut - 10 * 0.05);
    EXPECT_NEAR(areas_of(layout.library, "WAFER").at(mask_layers::front), expected, 12 * 200 * 0.001);
}

TEST(Layout, OfVariantsHasEachVariantOnce) {
    const Layout layout = draw_wafer_layout(
        file_of("[device]\n[wafer]\ndevices = 7\nvary = { stop_gap = [7, 8, 9], gap = [15], folds = [2] }\n"));
    EXPECT_THAT(layout.sites, ElementsAre(0, 1, 2, 0, 1, 2, 0));
    ASSERT_EQ(layout.devices.size(), 3U);
    EXPECT_EQ(layout.devices[1].cell, "DEVICE_2");
    EXPECT_EQ(layout.devices[1].drawing.dimensions.stop_gap, 8);
    EXPECT_EQ(layout.devices[1].drawing.dimensions.folds, 2U);
    EXPECT_THAT(message("[device]\n[wafer]\nvary = { stop_gap = [7, 41] }\n"),
                HasSubstr("mine.toml:4:21: the stops do not reach out of the frame"));
}

TEST(Layout, OfAWaferIsRefusedIfPartsOverlap) {
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {"devices = 40", "mine.toml:4:11: device 1 and device 2 overlap; give fewer devices"},
        {"radius = 43000", "mine.toml:4:10: device 1 reaches into the exclusion"},
        {"exclusion = 20000", "reaches into the exclusion at the wafer's edge"},
        {"exclusion = 50000", "nothing is left within an exclusion"},
        {"flat_length = 100000", "a flat of 100000 um is longer"},
        {"flat_length = 80000", "reaches into the exclusion"},
        {"mark_radius = 30000\nmark_size = 20000", "an alignment mark of the wafer lies on device"},
        {"mark_radius = 49900", "lie beyond its edge"},
        {"label = \"naïve\"", "mine.toml:4:9: 'naïve MASK 1' has letters that are not drawn on masks"},
        {"label = \"" + std::string(80, 'W') + "\"", "reach beyond the part for devices"},
        {"label_height = 4000", "lie on device"},
        {"label_height = 0.001", "the letters are too small"},
        {"devices = 0", "give a whole number from 1"},
    };
    for (const auto& [text, said] : mistakes)
        EXPECT_THAT(message("[device]\n[wafer]\n" + text + "\n"), HasSubstr(said)) << text;
    EXPECT_EQ(message("[device]\n[wafer]\ndevices = 1\nradius = 0\nlabel_height = 0\n"), "");
    EXPECT_EQ(message("[device]\n[wafer]\ndevices = 5\n"), "") << "an odd number leaves the marks free, too";
}

/// Ten thousand drawings with all their cells, as a sweep may need. Counted, not timed.
TEST(Layout, OfTenThousandVariantsAreDrawnAndWritten) {
    DeviceFile file = file_of("[device]\nmark_size = 0\n");
    std::set<std::size_t> sizes;
    std::size_t drawn = 0;
    for (int i = 0; i < 10'000; ++i) {
        file.device.stop_gap = 5 + 0.001 * i;
        file.device.flexure_length = 1000 + 0.01 * i;
        drawn += draw_device(file).etched.empty() ? 0 : 1;
    }
    EXPECT_EQ(drawn, 10'000U);
    EXPECT_EQ(gds_stream(draw_device_layout(file).library), gds_stream(draw_device_layout(file).library));
}

} // namespace graze::testing::layout_test
