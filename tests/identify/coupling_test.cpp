#include "graze/identify/coupling.hpp"

#include "graze/base/input_error.hpp"
#include "identify/models.hpp"
#include "identify/noise.hpp"

#include <functional>

namespace graze::testing::coupling_test {

using namespace magnet;

std::vector<StaticLoad> loads_of(Noise& noise, double noise_q, double noise_i) {
    std::vector<StaticLoad> loads;
    for (int run = 0; run < 10; ++run)
        for (int i = 1; i <= 15; ++i) {
            const double q = 1.2e-3 * i / 15; // the snap-through is at (d + beta2)/3 = 2.1e-3
            loads.push_back({q + noise_q * noise.normal(), current_at(q) + noise_i * noise.normal()});
        }
    return loads;
}

CouplingSettings known() {
    return {.gap = gap, .stiffness = stiffness};
}

TEST(Coupling, IsExactForExactEquilibria) {
    Noise noise(1);
    const Coupling found = coupling(loads_of(noise, 0, 0), known());
    EXPECT_NEAR(found.beta1.value, beta1, 1e-9 * beta1);
    EXPECT_NEAR(found.beta2.value, beta2, 1e-9 * beta2);
    EXPECT_NEAR(found.regression_beta1, beta1, 1e-9 * beta1);
    EXPECT_NEAR(found.regression_beta2, beta2, 1e-9 * beta2);
    EXPECT_LT(found.beta1.error, 1e-9 * beta1);
    EXPECT_EQ(found.beta1.freedom, 148);
}

TEST(Coupling, DoesNotDependOnUnits) {
    Noise noise(1), same(1);
    const Coupling metres = coupling(loads_of(noise, 1e-5, 0.01), known());
    std::vector<StaticLoad> loads = loads_of(same, 1e-5, 0.01);
    for (StaticLoad& load : loads)
        load = {1e9 * load.displacement, 1e3 * load.current}; // nm and mA
    CouplingSettings settings = known();
    settings.gap *= 1e9;
    const Coupling small = coupling(loads, settings); // the stiffness keeps its number
    EXPECT_NEAR(small.beta2.value, 1e9 * metres.beta2.value, 1e-9 * 1e9 * metres.beta2.value);
    EXPECT_NEAR(small.beta1.value, 1e27 / 1e6 * metres.beta1.value, 1e-9 * 1e21 * metres.beta1.value);
    EXPECT_NEAR(small.beta1.error, 1e21 * metres.beta1.error, 1e-6 * 1e21 * metres.beta1.error);
}

TEST(Coupling, IntervalsCoverTheTruth) {
    std::size_t first = 0, second = 0, regression = 0;
    for (std::size_t seed = 0; seed < experiments; ++seed) {
        Noise noise(seed);
        CouplingSettings settings = known();
        settings.displacement_noise = 1e-5;
        settings.current_noise = 0.01;
        const Coupling found = coupling(loads_of(noise, 1e-5, 0.01), settings);
        first += covers(found.beta1, beta1) ? 1 : 0;
        second += covers(found.beta2, beta2) ? 1 : 0;
        regression += std::abs(found.regression_beta1 - beta1) < found.beta1.half_width() ? 1 : 0;
    }
    expect_coverage(first, "beta1");
    expect_coverage(second, "beta2");
    EXPECT_LE(regression, first) << "which takes displacements as exact";
}

/// Loads with an offset, a drift, a curved scale or an outlier leave structured residuals.
TEST(Coupling, NamesWhyLoadsAreNotEquilibria) {
    const auto changed = [](std::uint64_t seed, const std::function<void(StaticLoad&, std::size_t)>& change) {
        Noise noise(seed);
        std::vector<StaticLoad> loads = loads_of(noise, 1e-6, 1e-3);
        loads.resize(30);
        for (std::size_t i = 0; i < loads.size(); ++i)
            change(loads[i], i);
        return coupling(loads, known()).reasons;
    };
    std::size_t alarms = 0;
    std::string last;
    for (std::uint64_t seed = 1; seed <= experiments; ++seed)
        if (const std::vector<std::string> reasons = changed(seed, [](StaticLoad&, std::size_t) {}); !reasons.empty()) {
            ++alarms;
            last = reasons.front();
        }
    EXPECT_LE(alarms, 2U) << last;
    const std::vector<std::function<void(StaticLoad&, std::size_t)>> spoilers{
        [](StaticLoad& load, std::size_t) { load.displacement += 5e-5; },
        [](StaticLoad& load, std::size_t) { load.current += 0.1; },
        [](StaticLoad& load, std::size_t i) { load.displacement += 5e-6 * static_cast<double>(i); },
        [](StaticLoad& load, std::size_t) { load.displacement -= 100 * load.displacement * load.displacement; },
        [](StaticLoad& load, std::size_t) { load.current = std::min(load.current, 0.9 * current_at(1.2e-3)); },
        [](StaticLoad& load, std::size_t i) { load.current *= i == 7 ? 1.05 : 1; },
    };
    for (std::size_t k = 0; k < spoilers.size(); ++k)
        for (std::uint64_t seed = 1; seed <= 20; ++seed)
            EXPECT_FALSE(changed(seed, spoilers[k]).empty()) << k << ", seed " << seed;
}

TEST(Coupling, ErrorsOfGapAndStiffnessPropagate) {
    Noise noise(1), wider(1), stiffer(1);
    CouplingSettings settings = known();
    const std::vector<StaticLoad> loads = loads_of(noise, 0, 0);
    settings.gap_error = 1e-6;
    settings.stiffness_error = 1e-3 * stiffness;
    const Coupling found = coupling(loads, settings);
    // By the equations an error of the gap is one of beta2, and a relative error of the stiffness one of beta1.
    EXPECT_NEAR(found.beta2.error, 1e-6, 1e-12);
    EXPECT_NEAR(found.beta1.error, 1e-3 * beta1, 1e-9 * beta1);
}

TEST(Coupling, RefusesLoadsThatDoNotDetermineBothConstants) {
    Noise noise(1);
    const std::vector<StaticLoad> loads = loads_of(noise, 0, 0);
    EXPECT_THROW(coupling({}, known()), InputError);
    EXPECT_THROW(coupling(loads, {}), InputError);
    EXPECT_THROW(coupling(std::vector<StaticLoad>(5, loads[3]), known()), InputError);
    EXPECT_THROW(coupling(std::vector<StaticLoad>(5, {-1e-4, 1}), known()), InputError);
    EXPECT_THROW(coupling(std::vector<StaticLoad>(5, {1e-4, std::nan("")}), known()), InputError);
}

} // namespace graze::testing::coupling_test
