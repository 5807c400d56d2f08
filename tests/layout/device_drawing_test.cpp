#include "graze/layout/device_drawing.hpp"

#include "base/message_of.hpp"
#include "graze/layout/device_measures.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace graze::testing::device_drawing_test {

using ::testing::HasSubstr;

DeviceFile file_of(const DeviceDimensions& dimensions) {
    DeviceFile file;
    file.name = "one";
    file.file = "one.toml";
    file.device = dimensions;
    return file;
}

std::string message(const DeviceDimensions& dimensions) {
    return message_of([&] { draw_device(file_of(dimensions)); });
}

double box_area(const std::vector<GridBox>& boxes) {
    double sum = 0;
    for (const GridBox& one : boxes)
        sum += area_of(polygon_of(one));
    return sum;
}

/// Areas computed from the dimensions alone, without polygons, against those of the drawing. In micrometres, sums of
/// some thirty terms of up to 1e7 um^2 are exact to about 1e-7 um^2, while a nanometre along a side of 1 mm is 1 um^2.
void expect_closed_forms(const DeviceDimensions& d, const DeviceDrawing& drawing) {
    constexpr double near = 1e-6;
    const auto folds = static_cast<double>(d.folds);
    const DeviceMeasures measures = measures_of(drawing);
    EXPECT_NEAR(measures.gap, d.gap, 1e-9);
    EXPECT_NEAR(measures.stop_gap, d.stop_gap, 1e-9);
    EXPECT_NEAR(measures.facing_length, d.electrode_length, 1e-9);
    EXPECT_NEAR(measures.stop_length, 2 * d.stop_width, 1e-9);
    EXPECT_NEAR(measures.beam_width, d.flexure_width, 1e-9);
    EXPECT_NEAR(measures.beam_length, d.flexure_length, 1e-9);
    EXPECT_NEAR(measures.beam_spacing, d.flexure_spacing, 1e-9);
    EXPECT_EQ(measures.beams, 8 * d.folds);
    const double notch = 2 * d.notch_half_width();
    const double h = 2 * d.bar_width * 2 * d.mass_half_length() + notch * d.bridge_width +
                     4 * d.truss_width * (d.flexure_spacing + d.flexure_width);
    EXPECT_NEAR(measures.mass_area, h, near);
    EXPECT_NEAR(measures.beam_area, 8 * folds * d.flexure_width * d.flexure_length, near);
    const double pair = 2 * d.flexure_width + d.flexure_spacing, middle = 2 * pair + d.flexure_middle;
    EXPECT_NEAR(measures.truss_area, 2 * d.truss_width * (middle + 4 * (folds - 1) * pair), near);
    EXPECT_NEAR(measures.electrode_area, d.electrode_length * d.electrode_width + d.pad_length * d.pad_width, near);
    // The etched area of the notches is all that does not remain.
    const double finger = (d.flexure_middle + 2 * d.flexure_width) * d.truss_width;
    const double stays = box_area(drawing.flexure.beams) + box_area(drawing.flexure.trusses) +
                         2 * d.truss_width * (d.flexure_spacing + d.flexure_width) + finger;
    EXPECT_NEAR(total_area(drawing.flexure.etched), area_of(polygon_of(drawing.flexure.notch)) - stays, near);
}

TEST(DeviceDrawing, HasTheAreasAndGapsOfItsDimensions) {
    DeviceDimensions dimensions;
    for (const std::size_t folds : {1U, 2U, 3U, 7U}) {
        dimensions.folds = folds;
        dimensions.bar_width = folds % 2 == 0 ? 100 : 101.001; // an odd number of nanometres
        dimensions.electrode_length = 1999.999;
        dimensions.channel_width = 33.333;
        expect_closed_forms(dimensions, draw_device(file_of(dimensions)));
    }
}

/// Window, electrode and moats by numbers: the moats of plate and pad overlap each other and the window of the mass.
TEST(DeviceDrawing, EtchesTheAreaAroundTheMass) {
    const DeviceDimensions d;
    const DeviceDrawing drawing = draw_device(file_of(d));
    const double length = 2 * d.mass_half_length(), width = 2 * d.bar_width + 2 * d.notch_half_width();
    const double hull = length * width, around = (length + 2 * d.clearance) * (width + 2 * d.clearance) - hull;
    const double fingers = 2 * (d.flexure_middle + 2 * d.flexure_width) * d.clearance;
    const double stops = 2 * d.stop_width * (d.clearance - d.stop_gap);
    const double right = drawing.die.right / 1000.0 - (drawing.centre.x / 1000.0 + width / 2 + d.clearance);
    const double channel = d.channel_width * right;
    // Left of the window of the mass: the moats' union less the electrode.
    const double plate_to = d.gap + d.electrode_width + d.moat - d.clearance;
    const double moats = plate_to * (d.electrode_length + 2 * d.moat) + d.pad_length * (d.pad_width + 2 * d.moat);
    // The part of the electrode beyond the window of the mass: all but the face's first part.
    const double electrode = d.electrode_length * d.electrode_width + d.pad_length * d.pad_width;
    const double face = d.electrode_length * (d.clearance - d.gap); // within the window
    const double expected = around - fingers - stops - face + channel + moats - (electrode - face);
    EXPECT_NEAR(total_area(drawing.etched), expected, 1e-6);
    // The chamber covers all of it, with a margin.
    EXPECT_GT(total_area(drawing.chambers), expected);
}

TEST(DeviceDrawing, ScalesWithItsDimensions) {
    DeviceDimensions small;
    for (const LengthField<DeviceDimensions>& field : device_fields())
        small.*field.member /= 50; // flexures of 120 nm
    const DeviceMeasures one = measures_of(draw_device(file_of(DeviceDimensions())));
    const DeviceMeasures other = measures_of(draw_device(file_of(small)));
    EXPECT_NEAR(other.mass_area * 2500, one.mass_area, 1e-3 * one.mass_area); // lengths are rounded to 1 nm
    EXPECT_NEAR(other.gap * 50, one.gap, 1e-9);
    for (const LengthField<DeviceDimensions>& field : device_fields())
        small.*field.member *= 1000; // a die of 12 cm
    EXPECT_NEAR(measures_of(draw_device(file_of(small))).gap, one.gap * 20, 1e-9);
}

TEST(DeviceDrawing, RefusesInconsistentDimensions) {
    const auto with = [](double DeviceDimensions::*member, double value) {
        DeviceDimensions dimensions;
        dimensions.*member = value;
        return message(dimensions);
    };
    EXPECT_EQ(message(DeviceDimensions()), "");
    EXPECT_THAT(with(&DeviceDimensions::gap, -1), HasSubstr("device.gap is -1 um, not positive"));
    EXPECT_THAT(with(&DeviceDimensions::gap, NAN), HasSubstr("device.gap is not a finite number"));
    EXPECT_THAT(with(&DeviceDimensions::gap, 2e9), HasSubstr("more than a metre"));
    EXPECT_THAT(with(&DeviceDimensions::gap, 2e5), HasSubstr("give a smaller gap, or a die_length"));
    EXPECT_THAT(with(&DeviceDimensions::flexure_length, 6000), HasSubstr("flexures of 6000 um make a mass"));
    EXPECT_THAT(with(&DeviceDimensions::clearance, 900), HasSubstr("give a smaller clearance, or a die_width"));
    EXPECT_THAT(with(&DeviceDimensions::flexure_spacing, 3000), HasSubstr("give a smaller flexure_spacing"));
    EXPECT_THAT(with(&DeviceDimensions::electrode_length, 4000), HasSubstr("is longer than the mass"));
    EXPECT_THAT(with(&DeviceDimensions::stop_gap, 40), HasSubstr("give a stop_gap less than clearance"));
    EXPECT_THAT(with(&DeviceDimensions::channel_width, 3000), HasSubstr("give a narrower channel"));
    EXPECT_THAT(with(&DeviceDimensions::base_inset, 500), HasSubstr("nothing is left of the electrode's base"));
    EXPECT_THAT(with(&DeviceDimensions::pad_width, 6000), HasSubstr("with moat and frame takes"));
    EXPECT_THAT(with(&DeviceDimensions::mark_size, 2000), HasSubstr("an alignment mark of 2000 um"));
    EXPECT_THAT(with(&DeviceDimensions::mark_size, 0.01), HasSubstr("too small"));
    EXPECT_THAT(with(&DeviceDimensions::label_height, 600), HasSubstr("for which the die has no room"));
    EXPECT_THAT(with(&DeviceDimensions::label_height, 0.005), HasSubstr("too small"));
    EXPECT_THAT(with(&DeviceDimensions::label_height, 2000), HasSubstr("do not fit beside the chamber"));
    EXPECT_THAT(with(&DeviceDimensions::stop_gap, 39.998), HasSubstr("step that is too small")) << "stops of 2 nm";
}

/// The size that a message recommends is sufficient, to the nanometre.
TEST(DeviceDrawing, FitsOnTheDieThatAMessageRecommends) {
    for (const auto& [length, marks] : {std::pair{1150.0, 0.0}, {1234.567, 0.0}, {877.001, 0.0}, {6000.0, 300.0}}) {
        DeviceDimensions dimensions;
        dimensions.flexure_length = length;
        dimensions.mark_size = marks;
        dimensions.label_height = marks / 3;
        const auto asked = [&](const char* key) {
            const std::string text = message(dimensions), words = std::string(key) + " of at least ";
            const std::size_t at = text.find(words);
            return at == std::string::npos ? 0.0 : std::stod(text.substr(at + words.size()));
        };
        dimensions.die_width = 1000;
        dimensions.die_width = asked("die_width");
        dimensions.die_length = 1000;
        dimensions.die_length = asked("die_length");
        EXPECT_EQ(message(dimensions), "") << length;
        dimensions.die_length -= 0.001;
        EXPECT_THAT(message(dimensions), HasSubstr("die_length of at least"));
    }
}

/// For any dimensions the drawing is valid, or refused.
TEST(DeviceDrawing, OfRandomDimensionsIsValidOrRefused) {
    std::mt19937_64 random(20);
    std::uniform_real_distribution<double> factor(-1.3, 1.3);
    std::size_t drawn = 0;
    for (int seed = 0; seed < 4000; ++seed) {
        DeviceDimensions d;
        for (const LengthField<DeviceDimensions>& field : device_fields())
            if (random() % 3 == 0)
                d.*field.member = std::round(d.*field.member * std::exp(factor(random)) * 1000) / 1000;
        d.folds = 1 + random() % 4;
        d.die_length = d.die_width = 20'000;
        try {
            const DeviceDrawing drawing = draw_device(file_of(d));
            ++drawn;
            expect_closed_forms(d, drawing);
            for (const auto* polygons : {&drawing.etched, &drawing.chambers, &drawing.flexure.etched, &drawing.stops})
                for (const GridPolygon& one : *polygons)
                    EXPECT_FALSE(polygon_fault(one, 1)) << seed;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr(";")) << seed;
        }
        if (HasFailure())
            FAIL() << "seed " << seed;
    }
    EXPECT_GT(drawn, 1000U);
}

} // namespace graze::testing::device_drawing_test
