#pragma once

#include "odeint_peer.hpp"
#include "paired_timing.hpp"

#include "graze/model/catalogue.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <string_view>
#include <vector>

// The electromagnetic vibro-impactor on its period-3 orbit with impacts.

/// Counts impacts.
struct ContactCounter : graze::Observer {
    std::size_t contacts = 0;
    void contact(const graze::Contact& contact) override {
        contacts += contact.kind == graze::ContactKind::crossing ? 1 : 0;
    }
};

class Testbed {
public:
    static constexpr double forcing_period = 0.16; ///< at 6.25 Hz
    static constexpr int orbit_periods = 3;

    graze::Model model = graze::load_model("electromagnetic-testbed");

    /// Returns the state at phase 0 after the motion from rest has settled on the orbit at 4.833 V.
    std::vector<double> settled() const {
        const graze::Simulation simulation(graze::System(model), {}, {}, {.tolerance = 1e-15});
        ContactCounter counter;
        graze::Trajectory trajectory(simulation, model.parameter_values(), borrowed(counter));
        std::vector<double> state = model.initial_state();
        state[2] = 0.1;
        trajectory.start(state, model.initial_mode, 0, 600 * forcing_period);
        graze::JetSet jets(simulation, graze::LaneKind::single);
        run(trajectory, jets);
        return {trajectory.state().begin(), trajectory.state().end()};
    }

    OdeintPeer::Parameters groups() const {
        const double rate = value("w0"), length = value("beta2");
        return {.voltage = value("V0") / value("voltage_unit"),
                .frequency = value("omega") / rate,
                .damping = value("zeta"),
                .restitution = value("e"),
                .gap = value("d") / length,
                .stop = value("delta") / length,
                .inductance = value("Ll") * length / value("beta1"),
                .resistance = value("R") * length / (value("beta1") * rate)};
    }

    OdeintPeer::State nondimensional(std::span<const double> state) const {
        const double length = value("beta2");
        return {state[0] / length, state[1] / (length * value("w0")), state[2] / value("current_unit")};
    }

private:
    double value(std::string_view parameter) const {
        const std::vector expressions{model.symbol(parameter)};
        return model.values_of(expressions)[0];
    }
};
