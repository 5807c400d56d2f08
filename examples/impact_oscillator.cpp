// A forced oscillator that hits a wall, written in C++: no model file is needed.

#include <graze/trajectory/trajectory.hpp>

#include <cstdio>
#include <memory>

using namespace graze;

/// x'' + 2 zeta x' + x = cos(omega t), and a rigid wall at x = gap.
Model impact_oscillator() {
    Model model;
    model.name = "impact-oscillator";
    const Expression x = model.symbol("x"), v = model.symbol("v"), theta = model.symbol("theta");
    const Expression omega = model.symbol("omega"), zeta = model.symbol("zeta"), gap = model.symbol("gap");
    const Expression e = model.symbol("e");

    model.parameters = {{.name = "omega", .value = 2.8},
                        {.name = "zeta", .value = 0.05},
                        {.name = "gap", .value = 0.1},
                        {.name = "e", .value = 0.8}};
    const Expression zero = model.number(0), period = model.number(2 * 3.141592653589793);
    model.states = {{.name = "x", .initial = zero},
                    {.name = "v", .initial = zero},
                    {.name = "theta", .initial = zero, .period = period}};
    model.events = {{.name = "wall", .function = gap - x}};
    model.jumps.push_back({.name = "impact", .map = {x, -e * v, theta}});
    model.modes = {{.name = "flight", .rates = {v, cos(theta) - 2 * zeta * v - x, omega}, .watched = {0}}};
    Transition bounce;
    bounce.label = "impact";
    bounce.jump = 1;
    bounce.next = {{.mode = 0}};
    model.transitions = {bounce};
    return model;
}

/// Prints every impact as it happens.
struct Impacts : Observer {
    void contact(const Contact& contact) override {
        std::printf("impact at t = %.12f with speed %.12f\n", contact.time, -contact.rate_before);
    }
};

int main() {
    const Simulation simulation(System(impact_oscillator()), {}, {}, {.tolerance = 1e-14});
    Trajectory trajectory(simulation, simulation.model().parameter_values(), std::make_shared<Impacts>());
    trajectory.start(simulation.model().initial_state(), 0, 0, 12);

    // The derivatives of the final state with respect to the initial x, and to the gap.
    trajectory.carry_derivatives({"x", "gap"});

    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);

    std::printf("%s at t = %g: x = %.12f\n", name_of(trajectory.outcome().ending).data(), trajectory.time(),
                trajectory.state()[0]);
    std::printf("dx/dx(0) = %.12f, dx/dgap = %.12f\n", trajectory.derivative(0, 0), trajectory.derivative(0, 1));
    return trajectory.outcome().ending == Ending::end_time ? 0 : 1;
}
