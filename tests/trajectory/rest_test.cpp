// Motions that rest on a surface and leave it again, in any units: round-off of the gap and errors of the steps at rest
// are not penetrations.

#include "closed_form.hpp"
#include "simulate.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

using namespace graze;
using namespace graze::testing;

namespace rest_test {

/// The same gap in several equivalent forms, some with cancelling terms.
constexpr std::array gaps{
    "x - a*sin(theta)",         "-(a*sin(theta) - x)",          "(x - a*sin(theta))*scale",
    "x/a - sin(theta)",         "scale*x - scale*a*sin(theta)", "(x + h) - (a*sin(theta) + h)",
    "2*x - (a*sin(theta) + x)", "a*(x/a - sin(theta))",         "x^2 - (a*sin(theta))^2 + (x - a*sin(theta))*3*a"};

/// A ball on a table.
/// @param lands whether the jump at the release puts it exactly on the table once more
/// @param sticks whether a contact at zero speed leads to rest as well
Model ball(const std::string& gap, bool lands, bool sticks) {
    return model_from(fmt::format(
        R"toml(
name = "ball"
parameters = {{ g = 9.81, e = 0.5, a = 0.01, omega = 40, scale = 1, h = 1 }}
states = {{ x = 0.1, v = 0, theta = {{ initial = 0, period = "2*pi" }} }}
definitions = {{ speed = "a*omega*cos(theta)", support = "g - a*omega^2*sin(theta)" }}
events = {{ contact = "{}", release = "support" }}
modes.flight = {{ rates = {{ x = "v", v = "-g", theta = "omega" }}, watch = ["contact"] }}
modes.rest = {{ rates = {{ x = "speed", v = "-a*omega^2*sin(theta)", theta = "omega" }}, watch = ["release"] }}
initial.mode = "flight"
jumps.impact.v = "-e*v + (1 + e)*speed"
jumps.land = {{ x = "a*sin(theta)", v = "speed" }}
transitions = [
  {{ mode = "flight", event = "contact", jump = "impact", next = {}, chatter = {{ jump = "land", mode = "rest" }} }},
  {{ mode = "rest", event = "release", jump = "{}", next = "flight" }},
]
)toml",
        gap,
        sticks ? R"([{ when = "v - speed > 0", mode = "flight" }, { when = "support > 0", mode = "rest" },
                     { mode = "flight" }])"
               : R"("flight")",
        lands ? "land" : "identity"));
}

struct Units {
    double length, time;
};

Units draw_units(Random& random) {
    return {random.log_uniform(1e-9, 1e6), random.log_uniform(1e-9, 1e6)};
}

/// Sets random parameters and returns a random state above the table.
std::vector<double> draw_ball(Random& random, Model& model, const Units& units) {
    const double g = random.log_uniform(0.1, 100), omega = random.log_uniform(0.3, 100);
    const double a = g / (omega * omega) * random.uniform(1e-3, 3), theta = random.uniform(0, 6.28);
    model.set_parameter("g", g * units.length / (units.time * units.time));
    model.set_parameter("omega", omega / units.time);
    model.set_parameter("a", a * units.length);
    model.set_parameter("e", random.chance(0.15) ? 0 : random.uniform(0, 0.9));
    model.set_parameter("scale", random.log_uniform(1e-9, 1e9));
    model.set_parameter("h", a * units.length * random.log_uniform(1e-3, 1e3));
    const double height = random.chance(0.2) ? 0 : a * random.log_uniform(1e-3, 10);
    return {units.length * (a * std::sin(theta) + height),
            units.length / units.time * random.uniform(-1, 1) * a * omega, theta};
}

double rounds(const Model& model, double count) {
    return count * 2 * std::numbers::pi / model.parameter_values()[3];
}

TEST(Rest, BallsAtRestOnATableNeverFallThroughIt) {
    Random random(41);
    int left = 0;
    for (int i = 0; i < 600; ++i) {
        const std::string gap = gaps[static_cast<std::size_t>(i) % gaps.size()];
        const bool lands = random.chance(0.3), sticks = random.chance(0.4);
        Model model = ball(gap, lands, sticks);
        const auto state = draw_ball(random, model, draw_units(random));
        const double tolerance = random.log_uniform(1e-15, 1e-6);
        Experiment experiment(model, {.tolerance = tolerance, .step_limit = 100000});
        const Outcome outcome = experiment.run_from(state, 0, rounds(model, 40));
        EXPECT_EQ(outcome.ending, Ending::end_time)
            << gap << " lands " << lands << " tolerance " << tolerance << ": " << outcome.detail;
        for (const auto& contact : experiment.recorder.contacts())
            left += contact.contact.mode_before == 1;
    }
    EXPECT_GT(left, 600);
}

TEST(Rest, StatesBeyondTheSurfaceAreStillInadmissible) {
    Random random(42);
    int judged = 0;
    for (int i = 0; i < 600; ++i) {
        const std::string gap = gaps[static_cast<std::size_t>(i) % gaps.size()];
        Model model = ball(gap, false, false);
        auto state = draw_ball(random, model, draw_units(random));
        const auto parameters = model.parameter_values();
        const double a = parameters[2], h = parameters[5];
        // The depth is well beyond the resolution of this form's terms.
        const double resolution = 1e-12 * std::max(a, gap.find('h') == std::string::npos ? 0 : h);
        const double depth = random.log_uniform(1e-12, 0.1) * a;
        if (depth < resolution)
            continue;
        state[0] = a * std::sin(state[2]) - depth;
        Experiment experiment(model, with_tolerance(random.log_uniform(1e-15, 1e-6)));
        EXPECT_EQ(experiment.run_from(state, 0, rounds(model, 1)).ending, Ending::inadmissible)
            << gap << " " << depth / a;
        ++judged;
    }
    EXPECT_GT(judged, 400);
}

TEST(Rest, AModeThatLeadsBeyondTheSurfaceIsDetected) {
    // A mode that should move the ball with the table, but sinks a thousandth of the table's amplitude in each radian.
    Model model = ball(gaps[0], false, false);
    model.modes[1].rates[0] = model.modes[1].rates[0] - 1e-3 * model.symbol("a") * model.symbol("omega");
    model.set_parameter("a", 0.01);
    model.set_parameter("e", 0.2);
    Experiment experiment(model);
    EXPECT_EQ(experiment.run_from({0.03, 0, 0}, 0, 20).ending, Ending::inadmissible);
}

} // namespace rest_test
