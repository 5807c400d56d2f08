// From a designed device to the drawing that realises it after the etch, and back.

#include "graze/layout/matched_drawing.hpp"

#include "graze/base/input_error.hpp"
#include "graze/layout/lumped_model.hpp"
#include "graze/model/catalogue.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace graze::matched_drawing_test {

const char* const shipped = "mems-switch-device";

const MatchedQuantity& quantity(const MatchedDrawing& drawing, const std::string& parameter) {
    for (const MatchedQuantity& one : drawing.quantities)
        if (one.parameter == parameter)
            return one;
    throw std::runtime_error("no quantity " + parameter);
}

/// Change of a quantity by one step of the grid, or by a billionth of the pressure.
double step_of(const MatchedDrawing& drawing, const MatchedQuantity& one) {
    DeviceFile more = drawing.file;
    const std::string number = one.number.substr(one.number.find('.') + 1);
    if (number == "pressure")
        more.conditions.pressure *= 1 + 1e-9;
    for (const auto& field : device_fields())
        if (number == field.name)
            more.device.*field.member += 1e-3;
    for (const auto& [name, value] : parameters_of(lumped_model_of(more), load_model(shipped)).set)
        if (name == one.parameter)
            return std::abs(value - one.drawn);
    return 0;
}

TEST(MatchedDrawing, FindsAKnownDrawingFromAnotherStart) {
    // The dimensions of a known device are found from a different start.
    DeviceFile known = load_device_file(shipped);
    known.device.gap = 14.6;
    known.device.stop_gap = 8.1;
    known.device.electrode_length = 1900;
    known.device.bar_width = 105;
    known.device.flexure_length = 1130;
    known.conditions.pressure = 2500;
    Model designed = load_model(shipped);
    for (const auto& [name, value] : parameters_of(lumped_model_of(known), designed).set)
        designed.set_parameter(name, value);
    const MatchedDrawing found = match_drawing(load_device_file(shipped), designed);
    EXPECT_TRUE(found.is_met());
    EXPECT_EQ(found.file.device, known.device);
    EXPECT_NEAR(found.file.conditions.pressure, 2500, 2500 * 2e-9); // steps of it are of 1e-9
    for (const MatchedQuantity& one : found.quantities)
        EXPECT_NEAR(one.relative(), 0, 1e-8) << one.parameter;
}

TEST(MatchedDrawing, AllowsForBiasAndTaper) {
    Model designed = load_model(shipped);
    designed.set_parameter("d", 14.5);
    designed.set_parameter("stop", 8.2);
    DeviceFile file = load_device_file(shipped);
    for (const auto& [bias, taper] : {std::pair{0.0, 0.0}, {0.5, 0.0}, {0.3, 0.1}, {-0.2, -0.05}}) {
        file.conditions.bias = bias;
        file.conditions.taper = taper;
        const MatchedDrawing found = match_drawing(file, designed);
        // Walls recede by r(z) on both sides: the stops' gap at its narrowest, and 2 g0 g1/(g0 + g1).
        const double slope = std::tan(taper * std::acos(-1.0) / 180), bottom = bias + 250 * slope;
        EXPECT_NEAR(found.file.device.stop_gap + 2 * std::min(bias, bottom), 8.2, 5.1e-4) << bias << ' ' << taper;
        const double g0 = found.file.device.gap + 2 * bias, g1 = found.file.device.gap + 2 * bottom;
        EXPECT_NEAR(2 * g0 * g1 / (g0 + g1), 14.5, 5.1e-4) << bias << ' ' << taper;
        for (const MatchedQuantity& one : found.quantities)
            EXPECT_TRUE(one.met) << one.parameter << ": " << one.reason;
    }
}

TEST(MatchedDrawing, IsAsCloseAsTheGridAllows) {
    const DeviceFile file = load_device_file(shipped);
    const Model model = load_model(shipped);
    std::mt19937 generator(6);
    const auto within = [&](double least, double greatest) {
        return std::uniform_real_distribution<double>(least, greatest)(generator);
    };
    for (int i = 0; i < 12; ++i) {
        Model designed = model;
        designed.set_parameter("d", within(12, 18));
        designed.set_parameter("stop", within(6, 11));
        designed.set_parameter("zeta", within(0.005, 0.04));
        designed.set_parameter("f0", within(0.7, 1.3));
        const MatchedDrawing found = match_drawing(file, designed);
        for (const MatchedQuantity& one : found.quantities) {
            if (one.met) {
                EXPECT_LE(std::abs(one.drawn - one.designed), 0.51 * step_of(found, one) + 1e-12 * one.designed)
                    << i << ' ' << one.parameter;
            } else {
                EXPECT_FALSE(one.reason.empty()) << i << ' ' << one.parameter;
            }
        }
    }
}

TEST(MatchedDrawing, SaysWhyAQuantityCannotBeMet) {
    Model designed = load_model(shipped);
    designed.set_parameter("zeta", 0.5); // more than the gas gives at an atmosphere
    const MatchedDrawing thick = match_drawing(load_device_file(shipped), designed);
    EXPECT_FALSE(thick.is_met());
    const MatchedQuantity& zeta = quantity(thick, "zeta");
    EXPECT_FALSE(zeta.met);
    EXPECT_NEAR(zeta.after, 101325, 1e-3);
    EXPECT_NE(zeta.reason.find("process.pressure would have to be more than 101325 Pa"), std::string::npos)
        << zeta.reason;
    EXPECT_TRUE(quantity(thick, "d").met && quantity(thick, "f0").met);

    designed = load_model(shipped);
    designed.set_parameter("stop", 45); // stops extend from the frame, 40 away, by at least half a flexure
    designed.set_parameter("d", 60);
    const MatchedDrawing wide = match_drawing(load_device_file(shipped), designed);
    const MatchedQuantity& stop = quantity(wide, "stop");
    EXPECT_FALSE(stop.met);
    EXPECT_LT(stop.after, 40);
    EXPECT_NE(stop.reason.find("device.stop_gap would have to be more than 36.5 um"), std::string::npos) << stop.reason;
}

TEST(MatchedDrawing, KeepsGivenNumbers) {
    const DeviceFile file = load_device_file(shipped, {{"gap", 13.5}, {"pressure", 4000}});
    Model designed = load_model(shipped);
    const MatchedDrawing found = match_drawing(file, designed);
    EXPECT_EQ(found.file.device.gap, 13.5);
    EXPECT_EQ(found.file.conditions.pressure, 4000);
    EXPECT_EQ(quantity(found, "d").reason, "gap is given");
    EXPECT_TRUE(quantity(found, "stop").met && quantity(found, "f0").met && quantity(found, "m").met);
    EXPECT_THROW(match_drawing(file, load_model("mems-switch")), InputError);
}

} // namespace graze::matched_drawing_test
