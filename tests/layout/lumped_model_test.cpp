#include "graze/layout/lumped_model.hpp"

#include "drawn_frame.hpp"
#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

namespace graze::lumped_model_test {

const char* const shipped = "mems-switch-device";

/// A file with vertical walls at the drawn edges, almost in vacuum.
DeviceFile ideal() {
    DeviceFile file = load_device_file(shipped);
    file.conditions.bias = 0;
    file.conditions.taper = 0;
    return file;
}

TEST(LumpedModel, FollowsFromTheOutlines) {
    const DeviceFile file = ideal();
    const LumpedModel lumped = lumped_model_of(file);
    const DeviceDimensions& d = file.device;
    // The H with four lugs by hand, in um^2.
    const double half = d.mass_half_length(), notch = 2 * d.notch_half_width();
    const double area =
        2 * d.bar_width * 2 * half + d.bridge_width * notch + 4 * d.truss_width * (d.flexure_width + d.flexure_spacing);
    EXPECT_NEAR(lumped.plate_mass, 2330 * area * 1e-12 * 250e-6, 1e-12 * lumped.plate_mass);
    // Beams contribute 12/35, the two trusses a quarter.
    const double beams = 8 * d.flexure_width * d.flexure_length * 12 / 35;
    const double truss = d.truss_width * (d.flexure_middle + 4 * d.flexure_width + 2 * d.flexure_spacing);
    EXPECT_NEAR(lumped.mass, 2330 * (area + beams + 2 * truss / 4) * 1e-12 * 250e-6, 1e-12 * lumped.mass);
    // Four rows of two guided beams, less the compliance of trusses.
    const double guided = 4 * 169e9 * 250e-6 * std::pow(d.flexure_width / d.flexure_length, 3) / 2;
    EXPECT_NEAR(lumped.stiff_trusses, guided, 1e-12 * guided);
    EXPECT_NEAR(lumped.stiffness, guided, 1e-3 * guided);
    EXPECT_LT(lumped.stiffness, guided);
    EXPECT_DOUBLE_EQ(lumped.gap, d.gap * 1e-6);
    EXPECT_DOUBLE_EQ(lumped.stop, d.stop_gap * 1e-6);
    EXPECT_DOUBLE_EQ(lumped.closure, lumped.gap);
    EXPECT_GT(lumped.area, d.electrode_length * 250e-12);    // plus the fringe field:
    EXPECT_NEAR(lumped.area, 2000e-6 * 250e-6, 0.05 * 5e-7); // 2 g/pi of 250 um
    EXPECT_NEAR(lumped.damping, lumped.electrode_film + lumped.stop_films + lumped.chamber_film, 1e-18);
    // 2 sqrt(k m) zeta, and Eq. (6.1) at its fold.
    EXPECT_NEAR(lumped.damping_ratio() * 2 * std::sqrt(lumped.stiffness * lumped.mass), lumped.damping, 1e-18);
    const double v = lumped.pull_in(), q = lumped.gap / 3, rest = lumped.gap - q;
    EXPECT_NEAR(lumped.stiffness * q, 8.8541878128e-12 * lumped.area * v * v / (2 * rest * rest),
                1e-12 * lumped.stiffness * q);
}

TEST(LumpedModel, ShippedDeviceIsThatOfChapterSix) {
    const LumpedModel lumped = lumped_model_of(load_device_file(shipped));
    // The drawing is on a grid, the pressure has three digits.
    EXPECT_NEAR(lumped.damping_ratio(), 0.02, 1e-5);
    EXPECT_NEAR(lumped.stop / lumped.gap, 0.6, 1e-6);
    // Section 6.5: at rest it snapped slightly above 50 V.
    EXPECT_GT(lumped.pull_in(), 51);
    EXPECT_LT(lumped.pull_in(), 54);
    EXPECT_NEAR(lumped.frequency(), 964, 1);
}

TEST(LumpedModel, HasTheStiffnessOfTheDrawnFrame) {
    DeviceFile file = ideal();
    const auto compare = [&](const std::string& what) {
        const DeviceDrawing drawing = draw_device(file);
        const DrawnFrame frame(drawing);
        const LumpedModel lumped = lumped_model_of(drawing, file);
        const double height = 250e-6, by = file.conditions.modulus * 1e9 * height;
        // Rigid parts of the one are stiffer by a factor in the other.
        EXPECT_NEAR(lumped.stiffness, by * frame.stiffness(), 5e-5 * lumped.stiffness) << what;
        EXPECT_NEAR(lumped.rigid_mass, by * frame.with_rigid_mass(), 5e-5 * lumped.rigid_mass) << what;
    };
    compare("as shipped");
    file.device.truss_width = 15;
    for (const std::size_t folds : {1U, 2U, 3U, 6U}) {
        file.device.folds = folds;
        compare(std::to_string(folds) + " folds");
    }
    file = ideal();
    for (const double bar : {6.0, 20.0, 50.0}) {
        file.device.bar_width = bar;
        compare("bars of " + std::to_string(bar));
    }
    file = ideal();
    file.device.bridge_width = 6; // it does not bend, by symmetry
    compare("a thin bridge");
}

TEST(LumpedModel, OfTheShippedDeviceEqualsTheShippedModel) {
    const Model model = load_model(shipped);
    const std::vector<double> values = model.parameter_values();
    for (const auto& [name, value] : parameters_of(lumped_model_of(load_device_file(shipped)), model).set)
        EXPECT_NEAR(values[*model.find_parameter(name)], value, 5e-10 * value) << name; // ten digits are written
    EXPECT_EQ(values[*model.find_parameter("f")], values[*model.find_parameter("f0")]);
}

/// Logarithmic derivative of a number by a dimension.
double power(const std::function<double(const LumpedModel&)>& number,
             const std::function<void(DeviceFile&, double)>& set) {
    DeviceFile less = ideal(), more = ideal();
    set(less, 0.99);
    set(more, 1.01);
    return std::log(number(lumped_model_of(more)) / number(lumped_model_of(less))) / std::log(1.01 / 0.99);
}

TEST(LumpedModel, ScalesWithPowersOfDimensions) {
    const auto stiffness = [](const LumpedModel& m) { return m.stiffness; };
    const auto stiff = [](const LumpedModel& m) { return m.stiff_trusses; };
    const auto width = [](DeviceFile& f, double s) { f.device.flexure_width *= s; };
    const auto length = [](DeviceFile& f, double s) { f.device.flexure_length *= s; };
    const auto thickness = [](DeviceFile& f, double s) { f.process.wafer_thickness = 50 + 250 * s; };
    // Error of the central difference of a power; dimensions are rounded to 1 nm.
    EXPECT_NEAR(power(stiff, width), 3, 1e-9);
    EXPECT_NEAR(power(stiff, length), -3, 1e-9);
    EXPECT_NEAR(power(stiff, thickness), 1, 1e-9);
    EXPECT_NEAR(power(stiffness, width), 3, 5e-3);
    const auto modulus = [](DeviceFile& f, double s) { f.conditions.modulus *= s; };
    EXPECT_NEAR(power([](const LumpedModel& m) { return m.frequency(); }, modulus), 0.5, 1e-9);
    const auto density = [](DeviceFile& f, double s) { f.conditions.density *= s; };
    EXPECT_NEAR(power([](const LumpedModel& m) { return m.mass; }, density), 1, 1e-9);
    EXPECT_NEAR(power([](const LumpedModel& m) { return m.damping_ratio(); }, density), -0.5, 1e-9);
    const auto viscosity = [](DeviceFile& f, double s) { f.conditions.viscosity *= s; };
    EXPECT_NEAR(power([](const LumpedModel& m) { return m.damping; }, viscosity), 1, 1e-9);
    // Root of k d^3/A; the fringe field is 4 percent of A, and grows with d.
    const auto gap = [](DeviceFile& f, double s) { f.device.gap *= s; };
    EXPECT_NEAR(power([](const LumpedModel& m) { return m.pull_in(); }, gap), 1.5 - 0.02, 0.005);
}

TEST(LumpedModel, OverEtchNarrowsFlexuresWidensGapsAndThinsTheMass) {
    const DeviceFile drawn = ideal();
    DeviceFile etched = drawn;
    etched.conditions.bias = 0.3;
    const LumpedModel before = lumped_model_of(drawn), after = lumped_model_of(etched);
    EXPECT_NEAR(after.gap - before.gap, 0.6e-6, 1e-15);
    EXPECT_NEAR(after.stop - before.stop, 0.6e-6, 1e-15);
    // Beams become narrower by 0.6 and longer by 0.6.
    const DeviceDimensions& d = drawn.device;
    const double ratio = std::pow((d.flexure_width - 0.6) / d.flexure_width, 3) *
                         std::pow(d.flexure_length / (d.flexure_length + 0.6), 3);
    EXPECT_NEAR(after.stiff_trusses / before.stiff_trusses, ratio, 1e-9);
    EXPECT_LT(after.plate_mass, before.plate_mass);
    EXPECT_LT(after.pull_in(), before.pull_in());
    // An over-etched drawing equals a drawing of the result: the same H with all edges set back.
    GridPolygon square{{0, 0}, {100'000, 0}, {100'000, 100'000}, {0, 100'000}};
    EXPECT_NEAR(etched_area(square, {.bias = 0.3, .slope = 0}, 250), 99.4 * 99.4, 1e-9);
    EXPECT_NEAR(etched_area(GridPolygon(square.rbegin(), square.rend()), {.bias = 0.3, .slope = 0}, 250), 99.4 * 99.4,
                1e-9);
    // An L has one re-entrant corner.
    const GridPolygon l{{0, 0}, {100'000, 0}, {100'000, 50'000}, {50'000, 50'000}, {50'000, 100'000}, {0, 100'000}};
    EXPECT_NEAR(etched_area(l, {.bias = 0.3, .slope = 0}, 250), 99.4 * 49.4 + 49.4 * 50, 1e-9);
    // A wedge: mean of (100 - 2 z/1000)^2 over 250 um of depth, by Simpson's rule, which is exact.
    EXPECT_NEAR(etched_area(square, {.bias = 0, .slope = 1e-3}, 250), (1e4 + 4 * 99.75 * 99.75 + 99.5 * 99.5) / 6,
                1e-9);
}

TEST(LumpedModel, TaperNarrowsTheContactAtTheTop) {
    DeviceFile wider = ideal(), narrower = ideal();
    wider.conditions.taper = 0.05;
    narrower.conditions.taper = -0.05;
    const double by = 2 * 250e-6 * std::tan(0.05 * std::numbers::pi / 180), drawn = ideal().device.stop_gap * 1e-6;
    EXPECT_NEAR(lumped_model_of(wider).stop, drawn, 1e-15);
    EXPECT_NEAR(lumped_model_of(narrower).stop, drawn - by, 1e-15);
    const double top = ideal().device.gap * 1e-6, bottom = top + by;
    EXPECT_NEAR(lumped_model_of(wider).gap, 2 * top * bottom / (top + bottom), 1e-15);
    // If the bias compensates the taper, the trench shifts as a whole: narrow beams at the bottom, wide at the top.
    EXPECT_LT(lumped_model_of(wider).stiffness, lumped_model_of(narrower).stiffness);
    const LumpedModel nearer = lumped_model_of(draw_device(wider), wider.process, wider.conditions, -0.1);
    EXPECT_NEAR(nearer.stop, drawn - 0.1e-6, 1e-15);
    EXPECT_GT(nearer.stop_films, lumped_model_of(wider).stop_films);
}

TEST(LumpedModel, RefusesAPartThatTheEtchRemoves) {
    for (const auto& [bias, taper] : {std::pair{3.5, 0.0}, {20.0, 0.0}, {0.0, 10.0}, {-8.0, 0.0}, {0.0, -2.0}}) {
        DeviceFile file = ideal();
        file.conditions.bias = bias;
        file.conditions.taper = taper;
        EXPECT_THROW(lumped_model_of(file), InputError) << bias << ' ' << taper;
    }
}

TEST(LumpedModel, NamesThePlaceOfTheNumberThatRemovesAPart) {
    const auto place = [](const GivenLengths& given) {
        try {
            lumped_model_of(load_device_file(shipped, given));
        } catch (const InputError& error) {
            EXPECT_NE(error.problem().find(" um"), std::string::npos) << error.problem();
            EXPECT_NE(error.remedy().find("another bias, taper"), std::string::npos);
            return error.place().file;
        }
        return std::string("nothing is wrong");
    };
    EXPECT_EQ(place({{"bar_width", 0.5}}), "given bar_width");
    EXPECT_EQ(place({{"taper", 1}}), "given taper");
    EXPECT_EQ(place({{"bar_width", 90}, {"bias", 4}}), "given bias");
}

TEST(LumpedModel, GivesParametersInTheModelsUnits) {
    const LumpedModel lumped = lumped_model_of(load_device_file(shipped));
    Model model = load_model(shipped);
    const ParameterFile file = parameters_of(lumped, model);
    EXPECT_EQ(file.model, shipped);
    ASSERT_EQ(file.set.size(), 6U);
    EXPECT_EQ(file.set[0].first, "m");
    EXPECT_NEAR(file.set[0].second, lumped.mass * 1e9, 1e-15 * lumped.mass * 1e9); // ug
    EXPECT_NEAR(file.set[1].second, lumped.frequency() / 1e3, 1e-15);
    EXPECT_NEAR(file.set[3].second, lumped.area * 1e12, 1e-10);
    // In any units it is the same device.
    for (Parameter& one : model.parameters)
        if (one.name == "m")
            one.unit = "Mg";
        else if (one.name == "d" || one.name == "stop")
            one.unit = "nm";
    const ParameterFile other = parameters_of(lumped, model);
    EXPECT_NEAR(other.set[0].second, lumped.mass * 1e-3, 1e-15 * lumped.mass * 1e-3);
    EXPECT_NEAR(other.set[4].second, lumped.gap * 1e9, 1e-9);
    const std::string text = write_parameter_file(file);
    EXPECT_EQ(parse_parameter_file(text, "f").set, file.set);
    EXPECT_THROW(parameters_of(lumped, load_model("bouncing-ball")), InputError);
    EXPECT_THROW(parameters_of(lumped, load_model("mems-switch")), InputError);
}

} // namespace graze::lumped_model_test
