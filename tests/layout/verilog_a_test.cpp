// The Verilog-A module, evaluated independently of its writer, against the model's own equations.

#include "graze/layout/verilog_a.hpp"

#include "graze/base/input_error.hpp"
#include "graze/flow/system.hpp"
#include "graze/layout/lumped_model.hpp"
#include "graze/model/catalogue.hpp"
#include "verilog_a_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace graze::verilog_a_test {

using testing::VerilogModule;

const char* const shipped = "mems-switch-device";

VerilogModule module_of(const Model& model) {
    return VerilogModule(verilog_a_text(model, "mems-switch-device", "graze"));
}

/// Rates of the module at a position (um) and velocity (um/ms, i.e. mm/s): in um/s and mm/s^2.
struct Rates {
    double position, velocity;
};
Rates rates_of(VerilogModule& module, double q, double v, double voltage) {
    auto flows = module.flows({{"position", q}, {"velocity", v}, {"fixed", voltage}, {"moving", 0}});
    return {-flows.at("position"), -flows.at("velocity")};
}

/// Acceleration in um/ms^2, by the model's compiled equations.
double acceleration_of(const System& system, const std::string& mode, double q, double v, double voltage) {
    const Model& model = system.model();
    std::vector<double> inputs{q, v, 1};
    for (const Parameter& one : model.parameters)
        if (one.value)
            inputs.push_back(one.name == "V" ? voltage : *one.value);
    std::size_t place = 0;
    while (model.modes[place].name != mode)
        ++place;
    const Function& rates = system.mode(place).rates;
    std::vector<double> result(rates.outputs()), work(rates.workspace());
    rates.evaluate(inputs, result, work);
    EXPECT_EQ(result[0], v);
    return result[1];
}

TEST(VerilogA, HasTheModelsEquationsBetweenContacts) {
    const Model model = load_model(shipped);
    const System system(model);
    VerilogModule module = module_of(model);
    EXPECT_EQ(module.name, "mems_switch_device_va");
    std::mt19937 generator(1);
    const auto within = [&](double least, double greatest) {
        return std::uniform_real_distribution<double>(least, greatest)(generator);
    };
    const double stop = 9, gap = 14.2; // up to a twentieth of the gap before the electrodes meet
    for (int i = 0; i < 200; ++i) {
        const double q = within(-stop, gap), v = within(-100, 100), voltage = i % 3 == 0 ? 0 : within(-60, 60);
        const Rates rates = rates_of(module, q, v, voltage);
        const double expected = acceleration_of(system, voltage == 0 ? "off" : "on", q, v, voltage);
        // um/ms^2 are 1e3 mm/s^2. Some ten roundings of terms that may cancel; these are the sizes of the largest.
        const double w0 = 2 * std::numbers::pi * 0.964, size = w0 * w0 * gap + 2 * w0 * 0.02 * 100;
        EXPECT_NEAR(rates.velocity, 1e3 * expected, 1e3 * 1e-14 * (size + std::abs(expected))) << q << ' ' << voltage;
        EXPECT_NEAR(rates.position, 1e3 * v, 1e-12);
    }
}

TEST(VerilogA, ForceAndChargeAreConsistent) {
    // Without losses the force is V^2/2 dC/dq, where C is charge over voltage.
    VerilogModule module = module_of(load_model(shipped));
    const double mass = module.parameters.at("m"), voltage = 30, step = 1e-3;
    const auto charge = [&](double q) {
        rates_of(module, q, 0, voltage);
        return module.charges.at("fixed,moving");
    };
    for (const double q : {-8.0, 0.0, 5.0, 12.0}) {
        const double force =
            1e-3 * mass * (rates_of(module, q, 0, voltage).velocity - rates_of(module, q, 0, 0).velocity);
        const double slope = (charge(q + step) - charge(q - step)) / (2 * step * 1e-6); // of the charge, per metre
        // The difference's error: the third derivative of 1/(d - q), (step/(d - q))^2 of the slope.
        EXPECT_NEAR(force, 0.5 * voltage * slope, 2e-7 * force * std::pow(3 / (15 - q), 2)) << q;
    }
}

TEST(VerilogA, StopsReturnTheShareOfTheSpeed) {
    for (const double e : {1.0, 0.8, 0.3, 0.0}) {
        Model model = load_model(shipped);
        model.set_parameter("e", e);
        VerilogModule module = module_of(model);
        const double stop = 9, before = 50, contact = 0.5 / (100 * 0.9640932355e3); // half a period on the stop, in s
        double q = -stop, v = -before;
        // Classical Runge-Kutta until it leaves the stop (within a few periods).
        const double h = contact / 400;
        int steps = 0;
        do {
            const Rates a = rates_of(module, q, v, 0),
                        b = rates_of(module, q + h / 2 * a.position, v + h / 2 * a.velocity, 0),
                        c = rates_of(module, q + h / 2 * b.position, v + h / 2 * b.velocity, 0),
                        d = rates_of(module, q + h * c.position, v + h * c.velocity, 0);
            q += h / 6 * (a.position + 2 * b.position + 2 * c.position + d.position);
            v += h / 6 * (a.velocity + 2 * b.velocity + 2 * c.velocity + d.velocity);
        } while (q < -stop && ++steps < 4000);
        // The device's own spring acts too: w0 stop for half a period of contact, a hundredth of its period, is 3
        // percent of w0 stop = 54 mm/s, most of which is returned.
        EXPECT_NEAR(v / before, e, 0.04) << e;
    }
}

TEST(VerilogA, IsFiniteWhereTheElectrodesMeet) {
    VerilogModule module = module_of(load_model(shipped));
    for (const double q : {14.2, 14.5, 14.999, 15.0, 15.1, 20.0}) {
        const Rates rates = rates_of(module, q, 0, 50);
        EXPECT_TRUE(std::isfinite(rates.velocity)) << q;
        if (q > 14.4) {
            EXPECT_LT(rates.velocity, 0) << q; // pushed back
        }
    }
}

TEST(VerilogA, UsesTheParametersAndUnitsOfModels) {
    Model model = load_model(shipped);
    EXPECT_TRUE(has_verilog_a(model));
    for (Parameter& one : model.parameters)
        if (one.name == "d" || one.name == "stop")
            one.unit = "nm";
    VerilogModule module = module_of(model);
    EXPECT_NEAR(module.parameters.at("d"), 14.99999378e-9, 1e-22); // its numbers are in nanometres now
    EXPECT_NEAR(module.parameters.at("m"), 357.1554696e-9, 1e-20);
    EXPECT_EQ(module.parameters.at("epsilon"), vacuum_permittivity);
    EXPECT_FALSE(has_verilog_a(load_model("mems-switch")));
    EXPECT_THROW(verilog_a_text(load_model("bouncing-ball"), "ball", "graze"), InputError);
    const auto refused = [&](const char* name, double value) {
        Model other = load_model(shipped);
        other.set_parameter(name, value);
        EXPECT_THROW(verilog_a_text(other, "x", "graze"), InputError) << name << ' ' << value;
    };
    refused("m", 0);
    refused("f0", -1);
    refused("e", 1.2);
    refused("stop", 0);
    EXPECT_EQ(VerilogModule(verilog_a_text(load_model(shipped), "2 mm", "graze")).name, "_2_mm_va");
}

} // namespace graze::verilog_a_test
