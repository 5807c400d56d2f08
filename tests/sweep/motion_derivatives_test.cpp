#include "sweep/motion_derivatives.hpp"

#include "settle.hpp"

#include "graze/model/catalogue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace graze::motion_derivatives_test {

/// One motion that is observed by MotionDerivatives and also propagates derivatives by all states itself.
class Followed : public Observer {
public:
    Followed(const Model& model, const std::string& section, const SimulationOptions& options = {})
        : simulation_(System(model), {section_probe(model, section)}, {}, options), map_(simulation_, 0), modes_(map_),
          maps_(modes_), derivatives(modes_, maps_),
          trajectory(simulation_, model.parameter_values(), borrowed(static_cast<Observer&>(*this))) {}

    /// @param scale unit of each state
    void run(const std::vector<double>& state, std::size_t mode, double time, const std::vector<double>& scale) {
        const std::size_t states = state.size(), stride = states + trajectory.parameters().size();
        std::vector<double> seeds(states * stride, 0.0);
        for (std::size_t i = 0; i < states; ++i)
            seeds[i * stride + i] = map_.takes_part(i) ? 1 : 0;
        Eigen::MatrixXd unit =
            Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(states), static_cast<Eigen::Index>(states));
        for (std::size_t i = 0; i < states; ++i)
            unit(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) = seeds[i * stride + i];
        marks.clear();
        derivatives.begin(trajectory.parameters(), scale, unit, [this](const MotionDerivatives::Mark& mark) {
            marks.emplace_back(mark.time, derivatives.derivatives());
        });
        trajectory.start(state, mode, 0, time);
        trajectory.carry_tangents(seeds, states);
        JetSet jets(simulation_, LaneKind::single);
        graze::run(trajectory, jets);
        derivatives.carry();
    }
    /// Returns the difference of the two, for each direction relative to its size; both in units of the scales.
    double difference(const std::vector<double>& scale) const {
        double worst = 0;
        const std::size_t states = scale.size();
        for (std::size_t j = 0; j < states; ++j) {
            double apart = 0, size = 0;
            for (std::size_t i = 0; i < states; ++i) {
                const double carried = trajectory.derivative(i, j);
                const double followed =
                    derivatives.derivatives()(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
                apart = std::max(apart, std::abs(carried - followed) / scale[i]);
                size = std::max(size, std::abs(carried) / scale[i]);
            }
            worst = std::max(worst, size > 0 ? apart / size : apart);
        }
        return worst;
    }

    void step(const Step& step) override { derivatives.step(step); }
    void contact(const Contact& contact) override {
        contacts += contact.kind == ContactKind::crossing ? 1 : 0;
        derivatives.contact(contact);
    }
    void passage(const Passage& passage) override { derivatives.mark_ahead(passage.time, passage.mode, passage.state); }
    void grazing() override { derivatives.grazing(); }
    bool follows_derivatives() const override { return true; }

private:
    Simulation simulation_;
    SectionMap map_;
    VariationalModes modes_;
    StepMaps maps_;

public:
    MotionDerivatives derivatives;
    Trajectory trajectory;
    std::vector<std::pair<double, Eigen::MatrixXd>> marks;
    int contacts = 0;
};

TEST(MotionDerivatives, EqualThoseOfTheTrajectory) {
    struct Case {
        std::string model, section;
        testing::Settings parameters;
        double time;
        std::vector<double> scale;
        int contacts;
    };
    const std::vector<Case> cases{
        {"electromagnetic-testbed", "phase0", {{"V0", 5.2}}, 1.6, {1e-3, 0.1, 1, 1}, 10},
        {"impact-oscillator", "phase0", {}, 60, {1, 1, 1}, 5},
        {"impact-oscillator-two-stops", "phase0", {}, 60, {1, 1, 1}, 5},
        {"dry-friction-oscillator", "phase0", {}, 60, {1, 1, 1}, 5},
        {"microbeam", "phase0", {}, 3, {1e-6, 1, 1}, 0},
    };
    for (const Case& one : cases) {
        const Model model = testing::shipped_with(one.model, one.parameters);
        for (const double tolerance : {1e-8, 1e-12}) {
            Followed motion(model, one.section, {.tolerance = tolerance});
            motion.run(model.initial_state(), model.initial_mode, one.time, one.scale);
            EXPECT_GE(motion.contacts, one.contacts) << one.model;
            EXPECT_TRUE(motion.derivatives.valid() && !motion.derivatives.broken()) << one.model;
            // Dozens of steps and contacts, each with errors of some tolerances.
            EXPECT_LT(motion.difference(one.scale), 100 * tolerance) << one.model << " " << tolerance;
        }
    }
}

TEST(MotionDerivatives, AtMarksEqualClosedForms) {
    // The tangent of a linear oscillator rotates, whatever its motion; marks are within steps.
    const Model turning = oscillator("-X", SectionOf::clock, 0.3, 0.1, 7.3);
    Followed motion(turning, "s");
    motion.run(turning.initial_state(), 0, 20, {1, 1, 1});
    ASSERT_GT(motion.marks.size(), 20u);
    for (const auto& [time, matrix] : motion.marks) {
        EXPECT_NEAR(matrix(0, 0), std::cos(time), 1e-11) << time;
        EXPECT_NEAR(matrix(0, 1), std::sin(time), 1e-11) << time;
        EXPECT_NEAR(matrix(1, 0), -std::sin(time), 1e-11) << time;
        EXPECT_NEAR(matrix(1, 1), std::cos(time), 1e-11) << time;
    }
}

TEST(MotionDerivatives, AreComputedInPartsWhereTheyChangeFasterThanTheMotion) {
    // Neighbours approach within a hundredth of a step: of a motion at rest, and of a slow one.
    for (const double rate : {3.0, 30.0, 100.0}) {
        const Model resting = first_order(fmt::format("-{}*x", rate), SectionOf::clock, 0);
        Followed rest(resting, "s");
        rest.run(resting.initial_state(), 0, 3.5, {1, 1});
        for (const auto& [time, matrix] : rest.marks)
            EXPECT_NEAR(std::log(matrix(0, 0)) / (-rate * time), 1, 1e-9) << rate << " " << time;
        EXPECT_EQ(rest.marks.size(), 4u);
    }
}

TEST(MotionDerivatives, AreInvalidIfTheyWouldTakeTooManyParts) {
    // Neighbours approach within 1e-12 of a step.
    const Model resting = first_order("-1e12*x", SectionOf::clock, 0);
    Followed rest(resting, "s");
    rest.run(resting.initial_state(), 0, 3.5, {1, 1});
    EXPECT_FALSE(rest.derivatives.valid());
}

TEST(MotionDerivatives, OfAStepDoNotDependOnOtherLanes) {
    const Model model = load_model("electromagnetic-testbed");
    const Simulation simulation(System(model), {section_probe(model, "phase0")});
    const SectionMap map(simulation, 0);
    const VariationalModes modes(map);
    ASSERT_TRUE(modes.suit());
    EXPECT_EQ(modes.directions(), (std::vector<std::size_t>{0, 1, 2})); // not the phase, which no state disturbs
    StepMaps together(modes), alone(modes);
    const std::vector<double> scale{1e-3, 0.1, 1, 1}, parameters = model.parameter_values();
    std::vector<std::vector<double>> states;
    for (int k = 0; k < 23; ++k)
        states.push_back({1e-5 * k, 0.01 * k, 0.1 - 0.01 * k, 0.2 * k});
    together.begin(parameters, scale);
    for (std::size_t k = 0; k < states.size(); ++k)
        together.add(0, states[k], 1e-4 * static_cast<double>(k * k)); // up to far beyond the radius of convergence
    together.compute();
    for (std::size_t k = 0; k < states.size(); ++k) {
        alone.begin(parameters, scale);
        alone.add(0, states[k], 1e-4 * static_cast<double>(k * k));
        alone.compute();
        EXPECT_TRUE(std::ranges::equal(alone.map(0), together.map(k))) << k;
    }
}

TEST(MotionDerivatives, DoNotExistAcrossGrazingAndAccumulations) {
    // At its greatest height the motion just touches the surface.
    const Model grazing = testing::OneMode{.states = "x = -1\nv = 0",
                                           .rates = "x = 'v', v = '-x'",
                                           .clock = "1",
                                           .period = "1",
                                           .stops = {{"wall", "1 - x", "v = '-0.5*v'"}},
                                           .more = testing::at_phase(0.5, "s")}
                              .model();
    Followed touching(grazing, "s");
    touching.run(grazing.initial_state(), 0, 2, {1, 1, 1});
    EXPECT_TRUE(touching.derivatives.valid());
    touching.run(grazing.initial_state(), 0, 4, {1, 1, 1});
    EXPECT_FALSE(touching.trajectory.tangents_valid());
    EXPECT_FALSE(touching.derivatives.valid());

    Model ball = load_model("bouncing-ball");
    ball.set_parameter("a", 0.0005); // the ball stays on the table
    Followed bouncing(ball, "phase0");
    bouncing.run(ball.initial_state(), ball.initial_mode, 5, {1, 1, 1});
    EXPECT_TRUE(bouncing.derivatives.broken());
}

} // namespace graze::motion_derivatives_test
