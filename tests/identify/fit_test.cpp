#include "graze/identify/fit.hpp"

#include "identify/recorded_motion.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace graze::testing {

namespace {

/// All that is computed is right to some 1e-13; numbers that follow from it are demanded to nine digits.
constexpr double nine_digits = 1e-9;

void expect_found(const RecordedMotion& motion, FitSettings settings = {}) {
    if (std::getenv("SHOW"))
        settings.progress = [](const FitProgress& p) { std::printf("%d:%d %.3e\n", p.stage, p.iteration, p.misfit); return true; };
    const auto start = std::chrono::steady_clock::now();
    const Fit fit = fit_model(motion.model, motion.task, settings);
    std::printf("[ %s %s: error %.2g, %d iterations, %zu pieces, %zu contacts, %zu misplaced, gap %.1e, condition %.1e, %.3f s ]\n",
                motion.model.name.c_str(), std::string(name_of(fit.ending)).c_str(), motion.error(fit), fit.iterations,
                fit.pieces, fit.records[0].contacts, fit.records[0].misplaced, fit.gap, fit.condition,
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    for (std::size_t j = 0; j < motion.task.parameters.size(); ++j)
        std::printf("   %s %.12g truth %.12g\n", fit.numbers[j].name.c_str(), fit.numbers[j].estimate.value, motion.truth(j));
    EXPECT_EQ(name_of(fit.ending), "converged") << fit.detail;
    EXPECT_LE(motion.error(fit), nine_digits);
}

} // namespace

TEST(Fit, FindsTheParametersOfAnImpactOscillator) {
    RecordedMotion motion(load_model("impact-oscillator"), {"x", "v"}, 0, 0.05, 600);
    for (const char* name : {"zeta", "omega", "amplitude", "sigma", "e"})
        motion.forget(name, 1.1);
    motion.forget_states();
    expect_found(motion);
}

TEST(Fit, FindsTheParametersOfTheBallAndShaker) {
    RecordedMotion motion(load_model("ball-and-shaker"), {"q"}, 2, 0.005, 400);
    for (const char* name : {"zeta", "omega_n", "e", "a", "f"})
        motion.forget(name, 1.03);
    motion.forget_states();
    expect_found(motion);
}

TEST(Fit, FindsTheParametersOfABouncingBall) {
    RecordedMotion motion(load_model("bouncing-ball"), {"x"}, 0, 0.002, 400);
    for (const char* name : {"g", "e", "a", "f"})
        motion.forget(name, 1.03);
    motion.forget_states();
    expect_found(motion);
}

TEST(Fit, FindsTheParametersOfADryFrictionOscillator) {
    RecordedMotion motion(load_model("dry-friction-oscillator"), {"x", "v"}, 0, 0.1, 500);
    for (const char* name : {"zeta", "omega", "amplitude", "friction_static", "friction_dynamic"})
        motion.forget(name, 1.05);
    motion.forget_states();
    expect_found(motion);
}

TEST(Fit, FindsTheParametersOfTheTestbedThroughChaos) {
    Model model = load_model("electromagnetic-testbed");
    RecordedMotion motion(model, {"q", "v", "I"}, 4, 0.002, 1500);
    for (const char* name : {"V0", "zeta", "e", "beta1", "R", "w0"})
        motion.forget(name, 1.05);
    motion.forget_states();
    expect_found(motion);
}

} // namespace graze::testing
