// Saddles with their spaces: closed forms, and derivatives against differences.

#include "orbit/saddle.hpp"

#include "graze/model/model_file.hpp"
#include "orbit/saddle_focus.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace graze::saddle_test {

using namespace graze::testing;

Saddle saddle_of(const Model& model, std::vector<ParameterId> free = {}) {
    return {System(model), 0, std::move(free), Eigen::Vector3d(1, 0.5, 2)};
}

TEST(Saddle, CoordinatesDiagonaliseTheField) {
    const Model model = focus();
    Saddle saddle = saddle_of(model);
    ASSERT_TRUE(saddle.find(model.initial_state(), model.parameter_values())) << saddle.problem();
    EXPECT_NEAR(saddle.state()[0], 0.4, 1e-14);
    EXPECT_NEAR(saddle.state()[1], 0.16, 1e-14);
    EXPECT_EQ(saddle.unstable(), 1);
    EXPECT_EQ(saddle.stable(), 2);
    EXPECT_GT(saddle.eigenvalues()[0].real(), 0);
    EXPECT_GT(saddle.eigenvalues()[1].imag(), 0);
    EXPECT_EQ(saddle.slowest_decay(), -saddle.eigenvalues()[1].real());
    // The linearised motion in coordinates is that of the field, by a small step in time.
    const Eigen::Vector3d c(0.3, -0.2, 0.5);
    constexpr double step = 1e-5;
    const Eigen::VectorXd rate = (saddle.moved(c, step) - saddle.moved(c, -step)) / (2 * step);
    Eigen::Matrix3d field;
    field << 1.3, 0.4, 0, 0.4, -0.3, -1.3, 0.2, 1.3, -0.3;
    Eigen::Vector3d state = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; k < 3; ++k)
        state += c[k] * saddle.direction(k);
    EXPECT_LT((saddle.to_coordinates() * field * state - rate).norm(), 1e-9);
    const std::vector<double> at = saddle.state_at(c);
    EXPECT_LT((saddle.from_saddle(at) - state).norm(), 1e-14);
    EXPECT_LT((saddle.to_coordinates() * state - c).norm(), 1e-14);
}

TEST(Saddle, TimesToDistancesAreThoseOfTheMotion) {
    const Model model = focus();
    Saddle saddle = saddle_of(model);
    ASSERT_TRUE(saddle.find(model.initial_state(), model.parameter_values()));
    for (const Eigen::Vector3d& c : {Eigen::Vector3d(0.1, 0, 0), Eigen::Vector3d(0, 0.3, -0.4)})
        for (const double distance : {1e-6, 0.03, 2.0})
            EXPECT_NEAR(saddle.moved(c, saddle.time_to(distance, c)).norm(), distance, 1e-10 * distance);
}

TEST(Saddle, DerivativesAgreeWithDifferences) {
    const Model model = focus();
    const std::vector<double> values = model.parameter_values(), state{0.45, 0.3, -0.1};
    const std::vector<ParameterId> free{model.independent_parameter("p"), model.independent_parameter("q")};
    Saddle saddle = saddle_of(model, free);
    ASSERT_TRUE(saddle.find(model.initial_state(), values));
    const Eigen::MatrixXd by = saddle.coordinates_by_parameters(state);
    constexpr double step = 1e-6;
    for (Eigen::Index f = 0; f < 2; ++f) {
        // A coordinate of the other space that vanishes there: its zero moves with the parameters.
        const auto moved = [&](double change) {
            std::vector<double> there = values;
            there[free[static_cast<std::size_t>(f)].place()] += change;
            Saddle other = saddle_of(model);
            EXPECT_TRUE(other.find(model.initial_state(), there));
            return other;
        };
        const Saddle up = moved(step), down = moved(-step);
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR((up.state()[static_cast<std::size_t>(i)] - down.state()[static_cast<std::size_t>(i)]) /
                            (2 * step),
                        saddle.state_by_parameters()(i, f), 1e-8);
        // The frames of neighbours, turned within their space to agree with this one on its own space.
        const Eigen::Index u = saddle.unstable(), s = saddle.stable();
        const auto coordinates = [&](const Saddle& other) {
            Eigen::Matrix3d own;
            for (Eigen::Index k = 0; k < 3; ++k)
                own.col(k) = saddle.direction(k);
            const Eigen::MatrixXd seen = other.to_coordinates() * own;
            const Eigen::VectorXd all = other.to_coordinates() * other.from_saddle(state);
            Eigen::VectorXd result(3);
            result << seen.topLeftCorner(u, u).inverse() * all.head(u),
                seen.bottomRightCorner(s, s).inverse() * all.tail(s);
            return result;
        };
        const Eigen::VectorXd differences = (coordinates(up) - coordinates(down)) / (2 * step);
        EXPECT_LT((differences - by.col(f)).norm(), 1e-8 * by.col(f).norm()) << f;
    }
}

TEST(Saddle, RefusesWhatIsNone) {
    const auto problem_of = [](const std::string& rates, const std::string& clock = "") {
        const Model model = OneMode{.states = "x = 0.1\ny = 0", .rates = rates, .clock = clock}.model();
        Saddle saddle(System(model), 0, {}, Eigen::VectorXd::Ones(static_cast<Eigen::Index>(model.states.size())));
        EXPECT_FALSE(saddle.find(model.initial_state(), model.parameter_values()));
        return saddle.problem();
    };
    EXPECT_EQ(problem_of("x = '-x', y = '-2*y'"), "the equilibrium is stable: it is no saddle");
    EXPECT_EQ(problem_of("x = 'x', y = '2*y'"), "the equilibrium is a source: it is no saddle");
    EXPECT_EQ(problem_of("x = 'y', y = '-x'"),
              "the equilibrium has an eigenvalue on the imaginary axis: it is no saddle");
    EXPECT_EQ(problem_of("x = '1 + x^2', y = '-y'"), "no equilibrium is found where the orbit begins");
    EXPECT_NE(problem_of("x = 'x', y = '-y'", "1").find("no clock"), std::string::npos);
}

/// The equations keep a sliding motion to its surface by a decay of their own, which is none of the saddle's.
TEST(Saddle, ASourceOfASlidingMotionIsNone) {
    const Model model = parse_model(R"toml(states = { x = 0, y = 0, z = 0 }
modes.left = { rates = { x = 1, y = "y - 0.1*z", z = "z + 0.1*y" } }
modes.right = { rates = { x = -1, y = "y - 0.1*z", z = "z + 0.1*y" } }
events.surface = "x"
slides.along = { surface = "surface", between = ["left", "right"] }
initial.mode = "right"
)toml",
                                    "source.toml");
    Saddle saddle(System(model), *model.find_mode("along"), {}, Eigen::Vector3d(1, 1, 1));
    EXPECT_FALSE(saddle.find(std::vector{0.0, 0.0, 0.0}, model.parameter_values()));
    EXPECT_EQ(saddle.problem(), "a saddle in a mode that slides along a surface is not supported");
}

} // namespace graze::saddle_test
