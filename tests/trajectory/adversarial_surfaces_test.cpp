// Contacts at the limit of detection, with surfaces that are curved, narrow or many.

#include "grazing_cases.hpp"

#include <array>

using namespace graze;
using namespace graze::testing;

namespace adversarial_surfaces_test {

/// Straight flight past surfaces whose functions vary much faster than the motion; each mode has one surface.
constexpr const char* straight_flight = R"toml(
name = "straight-flight"
parameters = { u = 1, w = 0, k = 1, limit = 0 }
states = { x = 0, y = 0 }
modes.circle = { rates = { x = "u", y = "w" }, watch = ["circle"] }
modes.bell = { rates = { x = "u", y = "w" }, watch = ["bell"] }
modes.witch = { rates = { x = "u", y = "w" }, watch = ["witch"] }
modes.waves = { rates = { x = "u", y = "w" }, watch = ["waves"] }
initial.mode = "circle"
events.circle = "x^2 + y^2 - limit^2"
events.bell = "limit - exp(-k*x^2)"
events.witch = "limit - 1/(1 + k*x^2)"
events.waves = "limit - sin(k*x)"
transitions = [
  { mode = "circle", event = "circle", next = "end" },
  { mode = "bell", event = "bell", next = "end" },
  { mode = "witch", event = "witch", next = "end" },
  { mode = "waves", event = "waves", next = "end" },
]
)toml";

struct Flight {
    double u, w, k, limit, x, y, end;
    Jet2 height(int surface, Real t) const {
        const Real a = x + u * t, b = y + w * t;
        const Real rate = u * a, square = rate * rate;
        switch (surface) {
        case 0:
            return {Real(limit) * limit - a * a - b * b, -2 * (u * a + w * b), -2 * (Real(u) * u + Real(w) * w)};
        case 1: {
            const Real bell = std::exp(-k * a * a);
            return {bell - limit, -2 * k * rate * bell, bell * (4 * k * Real(k) * square - 2 * k * Real(u) * u)};
        }
        case 2: {
            const Real witch = 1 / (1 + k * a * a);
            return {witch - limit, -2 * k * rate * witch * witch,
                    witch * witch * (8 * k * Real(k) * square * witch - 2 * k * Real(u) * u)};
        }
        default: {
            const Real fast = Real(k) * u;
            return {std::sin(k * a) - limit, fast * std::cos(k * a), -fast * fast * std::sin(k * a)};
        }
        }
    }
};

TEST(Adversarial, FastVaryingSurfacesAreMet) {
    Random random(5);
    Bench bench(model_from(straight_flight), 1e-6, 1e-15, 46);
    Witness witness;
    std::array<Tally, 4> tallies;
    for (int i = 0; i < 24000; ++i) {
        const int surface = i % 4;
        bench.draw(random);
        Flight one{};
        one.u = random.log_uniform(0.1, 10);
        one.x = -random.log_uniform(1e-3, 3);
        one.end = random.uniform(1, 2) * -one.x / one.u + 0.1;
        Real size = 1, noise = 0;
        if (surface == 0) {
            one.y = random.uniform(-1, 1);
            one.w = random.uniform(-1, 1) * one.u;
            const Real speed = Real(one.u) * one.u + Real(one.w) * one.w;
            const Real nearest = std::abs(Real(one.x) * one.w - Real(one.y) * one.u) / std::sqrt(speed);
            const Real square = nearest * nearest - draw_depth(random);
            if (!(square > 0))
                continue;
            one.limit = static_cast<double>(std::sqrt(square));
            one.end = 2 * static_cast<double>(std::abs(one.x * one.u + one.y * one.w) / speed) + 0.1;
            size = 2 * (Real(one.x) * one.x + Real(one.y) * one.y) + speed * one.end * one.end;
        } else {
            one.k = surface == 3 ? random.log_uniform(1, 300) : random.log_uniform(1, 1000);
            if (surface == 1) // farther away the bell underflows
                one.x = -std::min(-one.x, std::sqrt(600 / one.k));
            one.limit = 1 - draw_depth(random);
            noise = (std::abs(one.x) + one.u * one.end) * std::sqrt(one.k); // arguments, amplified by slopes
        }
        if (!(one.height(surface, 0).value < 0))
            continue;
        const auto height = [&](Real t) { return one.height(surface, t); };
        Real spacing = one.end / 20;
        if (surface == 3)
            spacing = std::min<Real>(one.end, 0.3L / (one.k * one.u));
        else if (surface > 0)
            spacing = std::min<Real>(one.end / 3, 2 * std::abs(one.x) / one.u);
        auto peaks = maxima(height, one.end, spacing);
        const std::vector<double> parameters{one.u, one.w, one.k, one.limit}, state{one.x, one.y};
        Outcome outcome = bench.run(parameters, state, one.end, witness, static_cast<std::size_t>(surface));
        if (outcome.ending == Ending::terminal)
            outcome.ending = Ending::stopped;
        const auto depth = [&](Real t) {
            const Jet2 jet = one.height(surface, t);
            return std::pair(jet.value, jet.slope);
        };
        Band band = band_of(bench.tolerance(), size, bench.steps);
        band.contact += 4 * epsilon * noise * std::sqrt(std::abs(2 * (one.limit - 1)));
        band.touch = std::min(band.touch, 50 * bench.tolerance() * -one.height(surface, 0).value);
        tallies[static_cast<std::size_t>(surface)].judge(
            witness, outcome, peaks, depth, band, 4 * epsilon * (one.end + std::abs(one.x) / one.u),
            fmt::format("surface {} u={} w={} k={} limit={} x={} y={} tol={} T={}", surface, one.u, one.w, one.k,
                        one.limit, one.x, one.y, bench.tolerance(), one.end));
    }
    for (const Tally& tally : tallies)
        tally.expect_clean(2500);
}

TEST(Adversarial, GrazesOfTheBallAndShakerAreMet) {
    Random random(6);
    Bench bench(load_model("ball-and-shaker"), 1e-6, 1e-15, 46);
    Witness witness;
    Tally tally;
    while (tally.cases < 10000) {
        bench.draw(random);
        const double zeta = random.log_uniform(1e-3, 0.3), natural = 25.2, a = random.uniform(0.1, 1),
                     f = random.log_uniform(2, 60), theta = random.uniform(0, 6.28), q = random.uniform(0, 2),
                     v = random.uniform(-50, 50);
        const Real pi = 3.141592653589793238462643383279502884L;
        const Real omega = 2 * pi * Real(f);
        LinearOscillator ball(zeta, omega, 0, natural);
        ball.start(q, v, theta);
        const auto shaker = [&](Real t) {
            const auto motion = ball.at(t);
            const Real phase = theta + omega * t;
            return Jet2{a * std::sin(phase) - motion.x, a * omega * std::cos(phase) - motion.v,
                        -a * omega * omega * std::sin(phase) - ball.acceleration(t)};
        };
        const double end = random.uniform(0.05, 0.4);
        auto peaks = maxima(shaker, end, 0.25L / std::max<Real>(omega, natural));
        Real highest = -10;
        for (const Peak& peak : peaks)
            highest = std::max(highest, peak.height);
        const double b = static_cast<double>(highest - draw_depth(random));
        if (highest < -9 || !(shaker(0).value < b))
            continue;
        for (Peak& peak : peaks)
            peak.height -= b;
        const Real size = a + std::abs(b) + std::abs(q) + std::abs(v) / natural;
        const Outcome outcome =
            bench.run(std::vector{zeta, natural, 0.55, a, b, f}, std::vector{q, v, theta}, end, witness);
        const auto depth = [&](Real t) {
            const Jet2 jet = shaker(t);
            return std::pair(jet.value - b, jet.slope);
        };
        Band band = band_of(bench.tolerance(), size, bench.steps);
        band.touch = std::min(band.touch, 50 * bench.tolerance() * (b - shaker(0).value));
        tally.judge(witness, outcome, peaks, depth, band, 4 * epsilon * end,
                    fmt::format("zeta={} a={} b={} f={} q={} v={} theta={} tol={} T={}", zeta, a, b, f, q, v, theta,
                                bench.tolerance(), end));
    }
    tally.expect_clean(10000);
}

/// Two stops so close together that round-off decides which is met first.
constexpr const char* two_barriers = R"toml(
name = "two-barriers"
parameters = { first = 1, second = 1 }
states = { x = 0, v = 0 }
modes.flight = { rates = { x = "v", v = "-x" }, watch = ["second", "first"] }
events = { first = "first - x", second = "second - x" }
transitions = [
  { mode = "flight", event = "first", next = "end" },
  { mode = "flight", event = "second", next = "end" },
]
)toml";

TEST(Adversarial, TheFirstOfSeveralBarriersIsMetFirst) {
    Random random(7);
    const Model model = model_from(two_barriers);
    const std::size_t first = *model.find_event("first");
    struct : Observer {
        std::size_t event = 9;
        double time = -1;
        void contact(const Contact& contact) override {
            if (contact.kind != ContactKind::touch && time < 0) {
                event = contact.event;
                time = contact.time;
            }
        }
    } observer;
    std::vector<std::unique_ptr<Simulation>> simulations;
    for (const double tolerance : {1e-6, 1e-9, 1e-12, 1e-15})
        simulations.push_back(std::make_unique<Simulation>(System(model), std::vector<Probe>{},
                                                           std::vector<Expression>{}, with_tolerance(tolerance)));
    long wrong = 0, late = 0;
    for (int i = 0; i < 8000; ++i) {
        const Simulation& simulation = *simulations[static_cast<std::size_t>(i % 4)];
        const double x = random.uniform(-1, 0.5), v = random.uniform(0.2, 1), reach = std::hypot(x, v);
        const double nearer = x + (reach - x) * random.uniform(0.1, 0.9999);
        const double further = nearer + random.log_uniform(1e-15, 1e-2);
        const bool swap = random.chance(0.5);
        const std::vector<double> parameters{swap ? further : nearer, swap ? nearer : further};
        observer.event = 9;
        observer.time = -1;
        Trajectory trajectory(simulation, parameters, borrowed(observer));
        trajectory.start(std::vector{x, v}, 0, 0, 7);
        run(trajectory);
        LinearOscillator oscillator(0, 2, 0);
        oscillator.start(x, v, 0);
        const Real size = 2, band = band_of(simulation.options().tolerance, size, trajectory.steps()).contact;
        late += observer.time < 0 || std::abs(oscillator.x(observer.time) - nearer) > band;
        wrong += (observer.event == first) == swap && further - nearer > 64 * epsilon;
    }
    EXPECT_EQ(late, 0);
    EXPECT_EQ(wrong, 0);
}

} // namespace adversarial_surfaces_test
