// Derivatives at and near a grazing; touches at and near the documented distance.

#include "closed_form.hpp"
#include "grazing_cases.hpp"
#include "simulate.hpp"

#include <gtest/gtest.h>

using namespace graze;
using namespace graze::testing;

namespace grazing_derivatives_test {

/// x'' = g past a surface at `surface`, in arbitrary units.
constexpr const char* parabola = R"toml(
name = "parabola"
parameters = { g = 2, e = 0.5, surface = 0, scale = 1 }
states = { x = 1, v = -2 }
modes.flight = { rates = { x = "v", v = "g" }, watch = ["contact"] }
events = { contact = { function = "scale*(x - surface)", kind = "barrier" } }
jumps.impact.v = "-e*v"
transitions = [{ mode = "flight", event = "contact", jump = "impact", next = "flight" }]
)toml";

/// @return whether derivatives are valid at the end
bool valid_after(const Model& model, std::vector<double> state, double end, double tolerance) {
    Experiment experiment(model, with_tolerance(tolerance));
    experiment.trajectory.start(state, 0, 0, end);
    const std::size_t columns = state.size() + model.parameter_values().size();
    std::vector<double> seeds(columns, 0.0);
    seeds[0] = 1;
    experiment.trajectory.carry_tangents(seeds, 1);
    graze::run(experiment.trajectory, experiment.jets);
    EXPECT_EQ(experiment.trajectory.outcome().ending, Ending::end_time);
    for (const double derivative : experiment.trajectory.tangents())
        EXPECT_TRUE(std::isfinite(derivative));
    return experiment.trajectory.tangents_valid();
}

TEST(GrazingDerivatives, DoNotExistAtAnExactGrazing) {
    Random random(61);
    for (int i = 0; i < 500; ++i) {
        Model model = model_from(parabola);
        // Powers of two make it exact in any units.
        const double length = std::exp2(random.integer(-30, 20)), time = std::exp2(random.integer(-20, 20));
        model.set_parameter("g", 2 * length / (time * time));
        model.set_parameter("surface", random.chance(0.5) ? 0 : -length * random.integer(1, 8));
        model.set_parameter("scale", random.log_uniform(1e-9, 1e9));
        const double surface = model.parameter_values()[2], tolerance = random.log_uniform(1e-15, 1e-6);
        if (i == 0)
            model = model_from(parabola);
        const std::vector<double> state =
            i == 0 ? std::vector{1.0, -2.0} : std::vector{length + surface, -2 * length / time};
        EXPECT_FALSE(valid_after(model, state, 3 * (i == 0 ? 1 : time), tolerance)) << i;
        EXPECT_TRUE(valid_after(model, state, 0.9 * (i == 0 ? 1 : time), tolerance)) << i;
    }
}

TEST(GrazingDerivatives, ExistNearAGrazing) {
    Random random(62);
    for (int i = 0; i < 500; ++i) {
        Model model = model_from(parabola);
        const double length = random.log_uniform(1e-9, 1e6), time = random.log_uniform(1e-9, 1e6);
        const double depth = random.log_uniform(1e-12, 1e-3) * (random.chance(0.5) ? 1 : -1);
        model.set_parameter("g", 2 * length / (time * time));
        model.set_parameter("scale", random.log_uniform(1e-9, 1e9));
        EXPECT_TRUE(
            valid_after(model, {length * (1 + depth), -2 * length / time}, 3 * time, random.log_uniform(1e-15, 1e-6)))
            << depth;
    }
}

TEST(GrazingDerivatives, NonFiniteSeedsAreRefused) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Experiment experiment(model_from(parabola));
        experiment.trajectory.start(std::vector{1.0, 0.0}, 0, 0, 1);
        std::vector<double> seeds(2 * 6, 0.0);
        for (const std::size_t place : {0U, 5U, 11U}) {
            seeds.assign(seeds.size(), 1.0);
            seeds[place] = bad;
            EXPECT_THROW(experiment.trajectory.carry_tangents(seeds, 2), InputError);
        }
    }
}

TEST(Touches, AreReportedUpToTheDocumentedDistance) {
    // Free vibration at the distance b + cos(omega t) from the stop, or its cube, first far and then close; the
    // function has been b + 1 large before it becomes b - 1.
    Random random(63);
    int touched = 0, passed = 0;
    for (int i = 0; i < 2000; ++i) {
        const double tolerance = random.log_uniform(1e-13, 1e-6), ratio = random.uniform(0.5, 2);
        if (std::abs(ratio - 1) < 0.03)
            continue; // the largest value of the function is known to a few per cent
        const bool gap_is_cubic = random.chance(0.3);
        const double length = random.log_uniform(1e-9, 1e6), omega = random.log_uniform(1e-6, 1e6);
        const double excess = ratio * 100 * tolerance * 2; // largest: 2
        const Model model = model_from(fmt::format(
            "name = \"vibration\"\nparameters = {{ k = {:.17g}, gap = {:.17g}, unit = {:.17g} }}\n"
            "states = {{ x = 0, v = 0 }}\nmodes.one = {{ rates = {{ x = \"v\", v = \"-k*x\" }}, watch = [\"stop\"] }}\n"
            "events.stop = {{ function = \"{}\" }}\n[[transitions]]\nmode = \"one\"\nevent = \"stop\"\nnext = "
            "\"end\"\n",
            omega * omega, 1 + excess, length, gap_is_cubic ? "gap + (x/unit)^3" : "(gap + x/unit)*unit"));
        Experiment experiment(model, with_tolerance(tolerance));
        const double phase = random.uniform(-2.5, -0.5); // before the time of the largest distance
        const Outcome outcome = experiment.run_from({length * std::cos(phase), -length * omega * std::sin(phase)}, 0,
                                                    (3.14159265 * 1.5 - phase) / omega);
        ASSERT_EQ(outcome.ending, Ending::end_time);
        EXPECT_EQ(experiment.recorder.contacts().size(), ratio < 1 ? 1U : 0U)
            << ratio << " tolerance " << tolerance << " cubic " << gap_is_cubic << " phase " << phase;
        ++(ratio < 1 ? touched : passed);
    }
    EXPECT_GT(touched, 500);
    EXPECT_GT(passed, 500);
}

} // namespace grazing_derivatives_test
