#include "identify/piece_motion.hpp"

#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace graze::testing::piece_motion_test {

struct Case {
    Model model;
    std::vector<std::string> moved;
    double begin, end;
    std::size_t times;
};

/// Compares the derivatives of all samples, of the end, and of the sides beyond contacts with central differences.
void expect_differences(const Case& one) {
    const Model& model = one.model;
    const System system(model);
    std::vector<std::size_t> moved;
    for (const std::string& name : one.moved)
        moved.push_back(model.independent_parameter(name).place());
    PieceMotion motion(Simulation(system, {}, {}, {.tolerance = 1e-14}), moved);
    const std::size_t states = model.states.size(), count = motion.directions();
    std::vector<double> seeds(states * count, 0.0), times;
    for (std::size_t i = 0; i < states; ++i)
        seeds[i * count + i] = 1;
    for (std::size_t k = 0; k < one.times; ++k)
        times.push_back(one.begin +
                        (one.end - one.begin) * (static_cast<double>(k) + 0.5) / static_cast<double>(one.times));
    const std::vector<double> parameters = model.parameter_values(), start = model.initial_state();
    MotionPiece piece{{}, seeds, model.initial_mode, one.begin, one.end, times, 1.5 * (times[1] - times[0])};
    const auto follow = [&](const std::vector<double>& values, const std::vector<double>& state) {
        motion.set_parameters(values);
        piece.state = state;
        return motion.follow(piece);
    };
    const PredictedMotion known = follow(parameters, start);
    ASSERT_TRUE(known.complete) << known.detail;
    EXPECT_TRUE(known.differentiable);
    EXPECT_GT(known.contacts, 0U);
    std::vector<double> sizes(states, 0.0);
    for (const PredictedMotion::Sample& sample : known.samples)
        for (std::size_t i = 0; i < states; ++i)
            sizes[i] = std::max(sizes[i], std::abs(sample.state[i]));
    std::size_t beyond = 0;
    for (std::size_t d = 0; d < count; ++d) {
        const double size = d < states ? sizes[d] : std::abs(parameters[moved[d - states]]), step = 1e-6 * size;
        std::vector<PredictedMotion> sides;
        for (const double sign : {1.0, -1.0}) {
            std::vector<double> values = parameters, state = start;
            (d < states ? state[d] : values[moved[d - states]]) += sign * step;
            sides.push_back(follow(values, state));
        }
        // The differences have errors from the third derivative and from round-off of the motion, 1e-13/1e-6.
        const auto expect = [&](double derivative, double above, double below, std::size_t i, std::size_t k) {
            const double scale = sizes[i] / size, period = model.periods()[i];
            const double difference = period > 0 ? std::remainder(above - below, period) : above - below;
            EXPECT_NEAR(derivative / scale, difference / (2 * step) / scale,
                        1e-4 * std::max(1.0, std::abs(derivative / scale)))
                << model.name << ": state " << i << " direction " << d << " at " << k;
        };
        for (std::size_t k = 0; k < times.size(); ++k)
            for (std::size_t i = 0; i < states; ++i) {
                const PredictedMotion::Sample& sample = known.samples[k];
                expect(sample.derivatives[i * count + d], sides[0].samples[k].state[i], sides[1].samples[k].state[i], i,
                       k);
                if (!sample.other)
                    continue;
                ++beyond;
                expect(sample.other_derivatives[i * count + d], sides[0].samples[k].other_state[i],
                       sides[1].samples[k].other_state[i], i, k);
            }
        for (std::size_t i = 0; i < states; ++i)
            expect(known.end_derivatives[i * count + d], sides[0].end_state[i], sides[1].end_state[i], i, times.size());
    }
    EXPECT_GT(beyond, 0U);
}

TEST(PieceMotion, DerivativesEqualFiniteDifferences) {
    expect_differences({load_model("impact-oscillator"), {"zeta", "omega", "sigma", "e", "amplitude"}, 0, 9, 87});
    expect_differences({load_model("bouncing-ball"), {"g", "e", "a", "f"}, 0, 0.5, 113});
    Model rubbing = load_model("dry-friction-oscillator");
    rubbing.set_initial("v", -0.1); // the law chooses the mode in which the motion begins
    expect_differences({rubbing, {"zeta", "omega", "friction_static", "friction_dynamic"}, 0, 20, 119});
    expect_differences({load_model("ball-and-shaker"), {"zeta", "omega_n", "e", "a", "f"}, 0, 0.4, 117});
    expect_differences(
        {load_model("electromagnetic-testbed"), {"V0", "zeta", "e", "beta1", "R", "w0", "delta", "Ll"}, 0, 0.6, 119});
}

/// A cyclic state whose period depends on a parameter: the phase is w t all the same.
TEST(PieceMotion, DerivativesAreRightForPeriodsThatDependOnParameters) {
    const Model model = parse_model(R"(
name = "clock"
parameters = { w = 3, wall = 0.9 }
states = { x = -0.3, v = 0, tau = { initial = 0.4, period = "2*pi/w" } }
[modes.swing]
rates = { x = "v", v = "cos(w*tau) - 4*x - 0.1*v", tau = 1 }
watch = ["hit"]
[events.hit]
function = "wall/4 - x"
[jumps.bounce]
v = "-0.8*v"
[[transitions]]
mode = "swing"
event = "hit"
jump = "bounce"
next = "swing"
)",
                                    "clock.toml");
    expect_differences({model, {"w", "wall"}, 0, 9, 87});
}

} // namespace graze::testing::piece_motion_test
