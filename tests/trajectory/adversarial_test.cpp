// Contacts at the limit of detection, of the linear impact oscillator in closed form.

#include "grazing_cases.hpp"

using namespace graze;
using namespace graze::testing;

namespace adversarial_test {

/// Returns the maxima of the height above the surface in (0, end) of a linear oscillator.
/// @param spacing times the time scale of the motion: less than the distance of maxima
std::vector<Peak> maxima(const LinearOscillator& oscillator, double surface, Real end, Real spacing, Real& size) {
    const Real fastest = std::max<Real>(1, oscillator.omega());
    const auto count = static_cast<std::size_t>(std::ceil(end * fastest / spacing)) + 2;
    const Real h = end / Real(count - 1);
    const auto motions = oscillator.sample(h, count);
    std::vector<Peak> peaks;
    for (std::size_t i = 0; i < count; ++i) {
        size = std::max(size, std::abs(motions[i].x) + std::abs(motions[i].v));
        if (i == 0 || !(motions[i - 1].v > 0 && motions[i].v <= 0))
            continue;
        const auto velocity = [&](Real s) {
            const auto motion = oscillator.at(s);
            return std::pair(motion.v, motion.acceleration);
        };
        const Real t = root_in(velocity, h * Real(i - 1), h * Real(i));
        const auto highest = oscillator.at(t);
        peaks.push_back({t, highest.x - surface, std::abs(highest.acceleration)});
    }
    return peaks;
}

struct OscillatorCase {
    double zeta, omega, amplitude, sigma = 0, e = 0.8, x, v, theta;
    std::vector<double> parameters() const { return {zeta, omega, amplitude, sigma, e}; }
    std::vector<double> state() const { return {x, v, theta}; }
    LinearOscillator oscillator() const {
        LinearOscillator result(zeta, omega, amplitude);
        result.start(x, v, theta);
        return result;
    }
    std::string label(double tolerance, double end) const {
        return fmt::format("zeta={} omega={} amplitude={} sigma={} e={} x={} v={} theta={} tol={} T={}", zeta, omega,
                           amplitude, sigma, e, x, v, theta, tolerance, end);
    }
};

OscillatorCase draw_oscillator(Random& random) {
    OscillatorCase one{};
    one.zeta = random.chance(0.3) ? 0 : random.log_uniform(1e-3, 0.5);
    do
        one.omega = random.log_uniform(0.1, 20);
    while (std::abs(one.omega - 1) < 0.05);
    one.amplitude = random.chance(0.2) ? 0 : random.uniform(-2, 2);
    one.x = random.uniform(-2, 1);
    one.v = random.uniform(-1.5, 1.5);
    one.theta = random.uniform(0, 6.28);
    return one;
}

/// Judges the engine's result for one case.
void judge(Tally& tally, Bench& bench, Witness& witness, const OscillatorCase& one, double end, Real spacing) {
    const LinearOscillator oscillator = one.oscillator();
    Real size = std::abs(Real(one.sigma)) + std::abs(one.amplitude);
    const auto peaks = maxima(oscillator, one.sigma, end, spacing, size);
    const Outcome outcome = bench.run(one.parameters(), one.state(), end, witness);
    Band band = band_of(bench.tolerance(), size, bench.steps);
    // Small is relative to the size of the gap, which is at least its size at the start.
    band.touch = std::min(band.touch, 50 * bench.tolerance() * std::abs(Real(one.sigma) - one.x));
    const auto depth = [&](Real t) {
        const auto motion = oscillator.at(t);
        return std::pair(motion.x - one.sigma, motion.v);
    };
    tally.judge(witness, outcome, peaks, depth, band, 4 * epsilon * end, one.label(bench.tolerance(), end));
}

TEST(Adversarial, GrazesOfTheLinearImpactOscillatorAreMet) {
    Random random(1);
    Bench bench(load_model("impact-oscillator"), 1e-6, 1e-15, 46);
    Witness witness;
    Tally tally;
    while (tally.cases < 60000) {
        OscillatorCase one = draw_oscillator(random);
        bench.draw(random);
        Real size = 0;
        double end = random.uniform(2, 14) / std::sqrt(std::max(1.0, one.omega));
        const auto peaks = maxima(one.oscillator(), 0, end, 0.15L, size);
        // Choose a peak that is higher than all before it.
        std::vector<Peak> records;
        Real highest = one.x;
        for (const Peak& peak : peaks)
            if (peak.height > highest) {
                records.push_back(peak);
                highest = peak.height;
            }
        if (records.empty())
            continue;
        const Peak& chosen = records[static_cast<std::size_t>(random.integer(0, static_cast<int>(records.size()) - 1))];
        one.sigma = static_cast<double>(chosen.height - draw_depth(random));
        if (!(one.sigma > one.x))
            continue;
        if (chosen.time < records.back().time)
            end = static_cast<double>(chosen.time + 0.02);
        judge(tally, bench, witness, one, end, 0.15L);
    }
    tally.expect_clean(60000);
}

TEST(Adversarial, GrazesJustAfterTheStartAreMet) {
    Random random(2);
    Bench bench(load_model("impact-oscillator"), 1e-6, 1e-15, 46);
    Witness witness;
    Tally tally;
    while (tally.cases < 30000) {
        OscillatorCase one = draw_oscillator(random);
        bench.draw(random);
        one.v = 0;
        LinearOscillator oscillator = one.oscillator();
        if (!(oscillator.acceleration(0) < -0.01))
            continue;
        const double ahead = random.log_uniform(1e-9, 1) / std::max(1.0, one.omega) * (random.chance(0.8) ? 1 : -1);
        const Real peak = one.x;
        one.x = static_cast<double>(oscillator.x(-ahead));
        one.v = static_cast<double>(oscillator.v(-ahead));
        one.theta -= one.omega * ahead;
        one.sigma = static_cast<double>(peak - draw_depth(random));
        if (!(one.sigma > one.x))
            continue;
        const double end = std::max(0.0, ahead) + random.uniform(0.01, 0.5) / std::max(1.0, one.omega);
        judge(tally, bench, witness, one, end, std::min(0.15, 0.05 * end * std::max(1.0, one.omega)));
    }
    tally.expect_clean(30000);
}

TEST(Adversarial, GrazesJustAfterAnImpactAreMet) {
    Random random(3);
    Bench bench(load_model("impact-oscillator"), 1e-6, 1e-15, 46);
    Witness witness;
    witness.wanted = 2;
    Tally tally;
    while (tally.cases < 20000) {
        OscillatorCase one = draw_oscillator(random);
        bench.draw(random);
        if (std::abs(one.amplitude) < 0.1)
            continue;
        // If the force presses towards the stop with `press` and decreases at the rate `relief`, a mass that leaves
        // with the speed 3 press^2 / (8 relief) returns to graze.
        const double press = random.log_uniform(1e-4, 0.3);
        one.theta = random.uniform(0.3, 2.8);
        if (one.amplitude < 0)
            one.theta += 3.14159;
        one.sigma = one.amplitude * std::cos(one.theta) - press;
        const double relief = one.omega * one.amplitude * std::sin(one.theta);
        const double excess = random.log_uniform(1e-7, 0.5) * (random.chance(0.5) ? 1 : -1);
        const double speed = 3 * press * press / (8 * relief) * (1 + excess);
        one.x = one.sigma;
        one.v = speed / one.e;
        const std::vector<double> state = one.state();
        const double end = std::min(2.5 * press / relief, 1.0);
        one.v = -one.e * one.v;
        const LinearOscillator oscillator = one.oscillator();
        Real size = std::abs(Real(one.sigma)) + std::abs(one.amplitude);
        const auto peaks = maxima(oscillator, one.sigma, end, 0.025 * end * std::max(1.0, one.omega), size);
        const Outcome outcome = bench.run(one.parameters(), state, end, witness);
        // The graze follows soon after the start: there is no truncation error yet, and little round-off.
        Band band = band_of(end < 1e-3 ? 0 : bench.tolerance(), size, 1);
        band.touch = std::min(band.touch, std::min(1e-3L, Real(bench.tolerance())) * end * speed);
        const auto depth = [&](Real t) { return std::pair(oscillator.x(t) - one.sigma, oscillator.v(t)); };
        tally.judge(witness, outcome, peaks, depth, band, 4 * epsilon * end, one.label(bench.tolerance(), end));
    }
    tally.expect_clean(20000);
}

TEST(Adversarial, SeveralGrazesInOneArcAreMet) {
    // Free vibration without damping returns to the same height; a force of twice the frequency makes two peaks with a
    // shallow dip between them, which one step may span.
    Random random(4);
    Bench bench(load_model("impact-oscillator"), 1e-6, 1e-15, 46);
    Witness witness;
    Tally tally;
    while (tally.cases < 15000) {
        OscillatorCase one{};
        bench.draw(random);
        one.omega = 2;
        double end = random.uniform(0.7, 25);
        Real spacing = 0.15L;
        if (random.chance(0.5)) {
            one.x = random.uniform(-1, 1);
            one.v = random.uniform(-1, 1);
        } else {
            one.amplitude = 0.75 + random.log_uniform(1e-5, 0.2);
            LinearOscillator oscillator(0, 2, one.amplitude);
            oscillator.start(1 - Real(one.amplitude) / 3, 0, 0);
            const double before = random.uniform(0.6, 3);
            one.x = static_cast<double>(oscillator.x(-before));
            one.v = static_cast<double>(oscillator.v(-before));
            one.theta = -2 * before;
            end = before + random.uniform(0.1, 0.8);
            spacing = 0.003L;
        }
        Real highest = -10, size = 0;
        for (const Peak& peak : maxima(one.oscillator(), 0, end, spacing, size))
            highest = std::max(highest, peak.height);
        one.sigma = static_cast<double>(highest - draw_depth(random));
        if (highest > -10 && one.sigma > one.x)
            judge(tally, bench, witness, one, end, spacing);
    }
    tally.expect_clean(15000);
}

} // namespace adversarial_test
