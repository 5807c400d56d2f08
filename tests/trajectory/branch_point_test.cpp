// Contacts by Hertz's law, whose force is a power of the indentation: series end where contacts begin and end.

#include "closed_form.hpp"
#include "simulate.hpp"

#include <gtest/gtest.h>

using namespace graze;
using namespace graze::testing;

namespace branch_point_test {

/// A body between two soft walls, free from 0 to `width`. The force is stiffness times the power p of the indentation.
/// @param loss function of the event that ends a contact with the right wall
Model between_walls(double stiffness, double width, double p, const char* loss = "x - width") {
    return model_from(fmt::format(R"toml(
name = "walls"
parameters = {{ k = {0:.17g}, width = {1:.17g}, p = {2:.17g} }}
states = {{ x = {{ initial = "width/2" }}, v = 1 }}
modes.free = {{ rates = {{ x = "v", v = 0 }}, watch = ["right", "left"] }}
modes.right = {{ rates = {{ x = "v", v = "-k*(x - width)^p" }}, watch = ["off_right"] }}
modes.left = {{ rates = {{ x = "v", v = "k*(-x)^p" }}, watch = ["off_left"] }}
initial.mode = "free"
events.right = {{ function = "width - x", kind = "section" }}
events.left = {{ function = "x", kind = "section" }}
events.off_right = {{ function = "{3}", kind = "section" }}
events.off_left = {{ function = "-x", kind = "section" }}
transitions = [
  {{ mode = "free", event = "right", next = "right" }},
  {{ mode = "free", event = "left", next = "left" }},
  {{ mode = "right", event = "off_right", next = "free" }},
  {{ mode = "left", event = "off_left", next = "free" }},
]
)toml",
                                  stiffness, width, p, loss));
}

/// Returns the duration of a contact: 2 (d/v) times the integral of (1 - u^(p + 1))^(-1/2), d the largest indentation.
double contact_time(double stiffness, double p, double v) {
    const double deepest = std::pow((p + 1) * v * v / (2 * stiffness), 1 / (p + 1)), a = 1 / (p + 1);
    return 2 * deepest / v * a * std::sqrt(3.14159265358979323846) * std::exp(std::lgamma(a) - std::lgamma(a + 0.5));
}

TEST(BranchPoint, HertzContactsBeginAndEndOnTime) {
    Random random(3);
    for (int i = 0; i < 40; ++i) {
        const double p = i % 4 == 0 ? 1.5 : random.uniform(1.05, 3.9), v = random.log_uniform(1e-3, 1e3);
        const double width = random.log_uniform(1e-3, 1e3), stiffness = random.log_uniform(1e-3, 1e6);
        SCOPED_TRACE(fmt::format("p = {}, v = {}, width = {}, k = {}", p, v, width, stiffness));
        Experiment experiment(between_walls(stiffness, width, p));
        const double contact = contact_time(stiffness, p, v), round = 2 * (width / v + contact);
        const double time = 0.5 * width / v + 5 * round;
        const Outcome outcome = experiment.run_from({0.5 * width, v}, 0, time);
        ASSERT_EQ(outcome.ending, Ending::end_time) << outcome.detail;
        // In the fifth round the body is at the right wall again, or has just touched it.
        const std::size_t contacts = experiment.recorder.contacts().size();
        EXPECT_TRUE(contacts == 20 || contacts == 21) << contacts;
        // Up to a thousand steps, each with an error of 1e-12.
        const double error = 1e-9 * (width + v * contact);
        EXPECT_NEAR(experiment.state()[0], width, error);
        EXPECT_NEAR(experiment.state()[1], v, 1e-10 * v);
        for (std::size_t c = 0; c + 1 < 20; c += 2)
            EXPECT_NEAR(experiment.recorder.contacts()[c + 1].contact.time -
                            experiment.recorder.contacts()[c].contact.time,
                        contact, 1e-10 * (time + contact));
    }
}

TEST(BranchPoint, AContactEndsWhereItsForceDoes) {
    for (const char* loss : {"x - width", "k*(x - width)^p", "1e6*(x - width)"}) {
        Experiment experiment(between_walls(20, 1, 1.5, loss));
        const double contact = contact_time(20, 1.5, 1);
        const Outcome outcome = experiment.run_from({1, 1}, 1, contact + 0.25);
        ASSERT_EQ(outcome.ending, Ending::end_time) << loss << outcome.detail;
        EXPECT_NEAR(experiment.state()[0], 0.75, 1e-11) << loss;
        EXPECT_NEAR(experiment.state()[1], -1, 1e-11) << loss;
    }
}

TEST(BranchPoint, DerivativesPassHertzContacts) {
    // The position at a time as a function of the initial speed: differences of the closed form.
    const double p = 1.5, k = 20, width = 1, time = 2.2;
    const auto position = [&](double v) { return width - v * (time - 0.5 * width / v - contact_time(k, p, v)); };
    const Simulation simulation{System(between_walls(k, width, p))};
    Trajectory trajectory(simulation, simulation.model().parameter_values());
    trajectory.start(std::vector<double>{0.5 * width, 0.6}, 0, 0, time);
    trajectory.carry_derivatives(std::vector<std::string>{"v"});
    run(trajectory);
    EXPECT_NEAR(trajectory.state()[0], position(0.6), 1e-11);
    EXPECT_NEAR(trajectory.derivative(0, 0), (position(0.6 + 1e-5) - position(0.6 - 1e-5)) / 2e-5, 1e-8);
}

TEST(BranchPoint, DerivativesPassForcesThatBeginSteeply) {
    // For p < 1 the stiffness is infinite where a contact begins and ends.
    const double k = 20, width = 1, time = 2.2;
    for (const double p : {0.5, 0.75, 1.25}) {
        const std::string text = fmt::format("{}", p);
        Model model = parse_model("parameters = { k = 20, width = 1 }\n"
                                  "states = { x = 0.5, v = 0.6 }\n"
                                  "modes.free = { rates = { x = 'v', v = '0' }, watch = ['wall'] }\n"
                                  "modes.right = { rates = { x = 'v', v = '-k*(x - width)^" +
                                      text +
                                      "' }, watch = ['loss'] }\n"
                                      "events = { wall = 'width - x', loss = 'x - width' }\n"
                                      "transitions = [{ mode = 'free', event = 'wall', next = 'right' },\n"
                                      "{ mode = 'right', event = 'loss', next = 'free' }]\n"
                                      "initial.mode = 'free'\n",
                                  "wall.toml");
        const auto whole = contact_time(k, p, 0.6);
        const Simulation simulation{System(model)};
        Trajectory trajectory(simulation, simulation.model().parameter_values());
        trajectory.start(std::vector<double>{0.5 * width, 0.6}, 0, 0, time);
        trajectory.carry_derivatives(std::vector<std::string>{"x", "v", "k"});
        run(trajectory);
        ASSERT_EQ(trajectory.outcome().ending, Ending::end_time) << trajectory.outcome().detail;
        EXPECT_NEAR(trajectory.state()[1], -0.6, 1e-11) << p;
        const double left = time - 0.5 * width / 0.6 - whole, accuracy = p < 1 ? 1e-5 : 1e-9;
        EXPECT_NEAR(trajectory.derivative(0, 0), -1, accuracy) << p;
        EXPECT_NEAR(trajectory.derivative(0, 1), -left - 0.5 * width / 0.6 + (1 - p) / (1 + p) * whole, accuracy) << p;
        EXPECT_NEAR(trajectory.derivative(0, 2), -0.6 * whole / (1 + p) / k, accuracy) << p;
        EXPECT_NEAR(trajectory.derivative(1, 1), -1, accuracy) << p;
    }
}

TEST(BranchPoint, ShallowContactsTakeFewSteps) {
    // A spring of unit frequency with the equilibrium -1 carries the body to the wall at 0.5 at low speed: a distance
    // that is a difference of states keeps few digits there.
    const Model model = parse_model("parameters = { k = 50 }\n"
                                    "states = { x = 0.5, v = 0 }\n"
                                    "modes.contact = { rates = { x = 'v', v = '-(x + 1) - k*(x - 0.5)^1.5' }, "
                                    "watch = ['loss'] }\n"
                                    "modes.free = { rates = { x = 'v', v = '-(x + 1)' } }\n"
                                    "events = { loss = 'x - 0.5' }\n"
                                    "transitions = [{ mode = 'contact', event = 'loss', next = 'free' }]\n"
                                    "initial.mode = 'contact'\n",
                                    "wall.toml");
    for (const double v : {1.0, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
        Experiment experiment(model, {.step_limit = 1000});
        const Outcome outcome = experiment.run_from({0.5, v}, 0, 3);
        ASSERT_EQ(outcome.ending, Ending::end_time) << v << outcome.detail;
        ASSERT_EQ(experiment.recorder.contacts().size(), 1u) << v;
        EXPECT_LT(experiment.trajectory.steps(), 300u) << v;
        const Contact& contact = experiment.recorder.contacts()[0].contact;
        EXPECT_NEAR(contact.rate_before, -v, 1e-9 * v + 1e-14 / v) << v; // energy is conserved
        // At low speed the force of the wall is small of higher order, and the time is 2 v/1.5.
        EXPECT_NEAR(contact.time, 2 * v / 1.5, v < 1e-3 ? 1e-2 * v : v) << v;
    }
}

} // namespace branch_point_test
