// Motions where the surfaces of slides meet: two relays, against their equations solved by trying all combinations.

#include "base/message_of.hpp"
#include "closed_form.hpp"
#include "model_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace graze::corner_modes_test {

using namespace graze::testing;

/// Two relays u = sign(x), v = sign(y): the rates of x, y and z are drive - matrix (u, v), the same in all modes.
struct Relays {
    std::array<std::string, 3> drive{};
    std::array<std::array<double, 2>, 3> matrix{};
    std::string states = "x = 1\ny = 1\nz = 0\nclock = 0\n";
};

std::string text_of(const Relays& relays) {
    std::string text = "name = \"relays\"\n[states]\n" + relays.states + "[events]\nfront = \"x\"\nside = \"y\"\n";
    for (const int u : {1, -1})
        for (const int v : {1, -1}) {
            text += fmt::format("[modes.{}{}]\nrates = {{ clock = 1", u > 0 ? 'p' : 'm', v > 0 ? 'p' : 'm');
            for (std::size_t i = 0; i < 3; ++i)
                text += fmt::format(", {} = \"{} - ({:.17g})*({}) - ({:.17g})*({})\"", "xyz"[i], relays.drive[i],
                                    relays.matrix[i][0], u, relays.matrix[i][1], v);
            text += " }\n";
        }
    return text + slides_between_quadrants();
}

/// With p = sin(t) the relays balance it until it exceeds what they can: u = sin(t) leaves the corner at its bound.
TEST(CornerModes, SlideAlongBothSurfacesUntilARelayIsAtItsBound) {
    Relays relays{.drive = {"1.5*sin(clock)", "0.3", "0"}, .matrix = {{{1, 0.25}, {0.5, 1}, {-1, -2}}}};
    relays.states = "x = 0\ny = 0\nz = 0\nclock = 0\n";
    Experiment experiment(model_from(text_of(relays)), with_tolerance(1e-14));
    const Model& model = experiment.simulation.model();
    const auto corner = model.find_mode("upper-right");
    ASSERT_TRUE(corner.has_value());
    // u + v/4 = 1.5 sin(t), u/2 + v = 0.3: u = (1.5 sin(t) - 0.075)/0.875.
    const double end = std::asin(0.95 / 1.5);
    EXPECT_EQ(experiment.run_from({0, 0, 0, 0}, *corner, end).ending, Ending::end_time);
    // z' = u + 2 v = 0.6
    EXPECT_NEAR(experiment.state()[2], 0.6 * end, 1e-14);
    EXPECT_EQ(experiment.state()[0], 0);
    EXPECT_EQ(experiment.state()[1], 0);
    EXPECT_EQ(experiment.run_from({0, 0, 0, 0}, *corner, end + 0.3).ending, Ending::end_time);
    ASSERT_GE(experiment.recorder.contacts().size(), 1U);
    EXPECT_EQ(experiment.label(0), "upper-right:right");
    EXPECT_NEAR(experiment.recorder.contacts()[0].contact.time, end, 1e-14);
    EXPECT_GT(experiment.state()[0], 0);
    EXPECT_EQ(experiment.state()[1], 0);
}

/// A motion of constant rates from vertex to vertex.
class Vertices {
public:
    Vertices(const std::array<double, 3>& drive, const Relays& relays) : drive_(drive), matrix_(relays.matrix) {}

    enum class End { time, not_unique, too_many }; ///< motions may run into the corner by infinitely many crossings
    End run(std::array<double, 3>& at, double time) {
        std::array<int, 2> signs{at[0] > 0 ? 1 : -1, at[1] > 0 ? 1 : -1};
        constexpr int most = 200;
        for (int vertex = 0; time > 0; ++vertex) {
            if (vertex == most)
                return End::too_many;
            const std::array<double, 3> rates = rates_of(signs);
            double step = time;
            int first = -1;
            for (int i = 0; i < 2; ++i)
                if (const auto k = static_cast<std::size_t>(i); signs[k] != 0 && rates[k] * signs[k] < 0)
                    if (const double until = -at[k] / rates[k]; until < step) {
                        step = until;
                        first = i;
                    }
            for (std::size_t i = 0; i < 3; ++i)
                at[i] += step * rates[i];
            time -= step;
            if (first < 0)
                return End::time;
            at[static_cast<std::size_t>(first)] = 0;
            std::array<bool, 2> free{signs[0] == 0, signs[1] == 0};
            free[static_cast<std::size_t>(first)] = true;
            at[0] = free[0] ? 0 : at[0];
            at[1] = free[1] ? 0 : at[1];
            const auto next = next_signs(signs, free);
            if (!next)
                return End::not_unique;
            signs = *next;
        }
        return End::time;
    }

private:
    /// The relays' values; those with the sign 0 make their rate zero.
    std::array<double, 2> values_of(const std::array<int, 2>& signs) const {
        std::array<double, 2> values{static_cast<double>(signs[0]), static_cast<double>(signs[1])};
        const auto& m = matrix_;
        if (signs[0] == 0 && signs[1] == 0) {
            const double determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
            values = {(drive_[0] * m[1][1] - drive_[1] * m[0][1]) / determinant,
                      (m[0][0] * drive_[1] - m[1][0] * drive_[0]) / determinant};
        } else if (signs[0] == 0) {
            values[0] = (drive_[0] - m[0][1] * values[1]) / m[0][0];
        } else if (signs[1] == 0) {
            values[1] = (drive_[1] - m[1][0] * values[0]) / m[1][1];
        }
        return values;
    }
    std::array<double, 3> rates_of(const std::array<int, 2>& signs) const {
        const std::array<double, 2> values = values_of(signs);
        std::array<double, 3> rates = drive_;
        for (std::size_t i = 0; i < 3; ++i)
            rates[i] -= matrix_[i][0] * values[0] + matrix_[i][1] * values[1];
        return rates;
    }
    /// The only consistent combination of the relays that are free: those at a bound lead away, the others attract.
    std::optional<std::array<int, 2>> next_signs(const std::array<int, 2>& from,
                                                 const std::array<bool, 2>& free) const {
        std::vector<std::array<int, 2>> consistent;
        for (int u = -1; u <= 1; ++u)
            for (int v = -1; v <= 1; ++v) {
                const std::array<int, 2> signs{free[0] ? u : from[0], free[1] ? v : from[1]};
                if ((!free[0] && u != 0) || (!free[1] && v != 0))
                    continue; // once for each
                const std::array<double, 2> values = values_of(signs);
                const std::array<double, 3> rates = rates_of(signs);
                bool holds = true;
                for (std::size_t i = 0; i < 2; ++i)
                    if (free[i])
                        holds = holds && (signs[i] == 0 ? std::abs(values[i]) < 1 && matrix_[i][i] > 0
                                                        : rates[i] * signs[i] > 0);
                if (signs[0] == 0 && signs[1] == 0)
                    holds = holds && matrix_[0][0] * matrix_[1][1] - matrix_[0][1] * matrix_[1][0] > 0;
                if (holds)
                    consistent.push_back(signs);
            }
        if (consistent.size() != 1)
            return std::nullopt;
        return consistent.front();
    }

    std::array<double, 3> drive_;
    std::array<std::array<double, 2>, 3> matrix_;
};

/// Attracting and repelling surfaces, coupled at random: where one combination of the relays is consistent the motion
/// follows it, and otherwise it ends.
TEST(CornerModes, FollowTheOnlySolutionOfBothRelays) {
    Random random(71);
    int along_both = 0, ended = 0, compared = 0, spirals = 0;
    for (int i = 0; i < 400; ++i) {
        std::array<double, 3> drive{};
        Relays relays;
        for (std::size_t k = 0; k < 3; ++k) {
            drive[k] = random.uniform(-0.9, 0.9);
            relays.drive[k] = fmt::format("({:.17g})", drive[k]);
            for (double& one : relays.matrix[k])
                one = random.uniform(-1.5, 1.5);
        }
        relays.matrix[0][0] = random.uniform(-0.5, 1.5);
        relays.matrix[1][1] = random.uniform(-0.5, 1.5);
        std::array<double, 3> at{random.uniform(0.1, 1), random.uniform(0.1, 1), 0};
        constexpr double time = 20;
        Experiment experiment(model_from(text_of(relays)), with_tolerance(1e-13));
        const Outcome outcome =
            experiment.run_from({at[0], at[1], 0, 0}, *experiment.simulation.model().find_mode("pp"), time);
        const auto end = Vertices(drive, relays).run(at, time);
        const auto& m = relays.matrix;
        if (end == Vertices::End::too_many) { // a spiral into the corner: see spiral_test.cpp
            const bool unique = m[0][0] > 0 && m[1][1] > 0 && m[0][0] * m[1][1] - m[0][1] * m[1][0] > 0;
            ASSERT_EQ(outcome.ending, unique ? Ending::end_time : Ending::no_transition) << i << ' ' << outcome.detail;
            if (!unique)
                continue;
            EXPECT_EQ(experiment.state()[0], 0) << i;
            EXPECT_EQ(experiment.state()[1], 0) << i;
            ++spirals;
            continue;
        }
        if (outcome.ending != Ending::end_time) {
            ++ended;
            EXPECT_EQ(outcome.ending, Ending::no_transition) << i << " " << outcome.detail;
            EXPECT_TRUE(end == Vertices::End::not_unique || m[0][0] * m[1][1] - m[0][1] * m[1][0] < 0)
                << i << outcome.detail;
            continue;
        }
        ASSERT_EQ(end, Vertices::End::time) << i << "\n" << text_of(relays);
        ++compared;
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR(experiment.state()[k], at[k], 1e-11) << i;
        along_both += at[0] == 0 && at[1] == 0 ? 1 : 0;
    }
    EXPECT_GT(along_both, 15);
    EXPECT_GT(compared, 200);
    EXPECT_GT(spirals, 8);
    EXPECT_LT(ended, 100);
}

/// Other parts of a model may name the mode, also when it is written and read again.
TEST(CornerModes, AreNamedByOtherParts) {
    const Relays relays{.drive = {"0.2", "0.1", "0"}, .matrix = {{{1, 0}, {0, 1}, {1, 3}}}};
    std::string text = text_of(relays);
    text.replace(text.rfind("'pp'"), 4, "'upper-right'");
    const Model model = model_from(text);
    EXPECT_EQ(model.modes[model.initial_mode].name, "upper-right");
    const Model again = model_from(write_model(model));
    EXPECT_EQ(write_model(again), write_model(model));
    Experiment experiment(again, with_tolerance(1e-14));
    EXPECT_EQ(experiment.run_from({0, 0, 0, 0}, again.initial_mode, 2).ending, Ending::end_time);
    EXPECT_NEAR(experiment.state()[2], -(0.2 + 3 * 0.1) * 2, 1e-14);
}

/// A mode that a declaration makes has no rates yet when corners are looked for.
TEST(CornerModes, AreNotLookedForBetweenDerivedModes) {
    const Relays relays{.drive = {"0", "0", "0"}, .matrix = {{{1, 0}, {0, 1}, {0, 0}}}};
    std::string text = text_of(relays);
    for (std::size_t at = text.find("'mm'"); at != std::string::npos; at = text.find("'mm'", at))
        text.replace(at, 4, "'upper'");
    EXPECT_THAT(message_of([&] { model_from(text); }), ::testing::HasSubstr("which a declaration makes"));
}

/// Utkin's controls: the same equations in all modes; a product of both controls makes the motion not unique.
TEST(CornerModes, NeedEquationsThatAreLinearInBothControls) {
    const auto text = [](const std::string& rate) {
        std::string all = "name = \"controls\"\n[states]\nx = 1\ny = 1\nz = 0\n[events]\nfront = \"x\"\nside = \"y\"\n";
        for (const char* mode : {"pp", "pm", "mp", "mm"})
            all += fmt::format("[modes.{}]\nrates = {{ x = \"0.2 - u\", y = \"0.1 - v\", z = \"{}\" }}\n", mode, rate);
        const auto with = [](char control) { return fmt::format("convention = 'utkin'\ncontrol = '{}'\n", control); };
        return all + slides_between_quadrants(with('u'), with('v'));
    };
    Experiment linear(model_from(text("u + 3*v")), with_tolerance(1e-14));
    EXPECT_EQ(linear.run(5).ending, Ending::end_time);
    EXPECT_EQ(linear.label(1), "right:front");
    // Until 10/9 u = v = 1; until 5/4 v = 0.1; then also u = 0.2.
    EXPECT_NEAR(linear.state()[2], 4 * 10 / 9.0 + 1.3 * (1.25 - 10 / 9.0) + 0.5 * 3.75, 1e-13);
    for (const char* rate : {"u*v", "u^2", "u^3 + v"}) {
        const Model model = model_from(text(rate));
        EXPECT_FALSE(model.find_mode("upper-right")) << rate;
        Experiment other(model);
        EXPECT_EQ(other.run(5).ending, Ending::no_transition) << rate;
    }
}

} // namespace graze::corner_modes_test
