// Special points very near a grazing, and the absence of spurious ones, against closed forms.

#include "follow.hpp"
#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::near_grazing_test {

using namespace graze::testing;
using std::numbers::pi;

/// Orbits with one impact per period of x'' + 2 zeta x' + x = A cos(omega t + phi) at the stop sigma, with the
/// restitution e. Motion and A exp(i phi) are linear in sigma and the speed v of the impact (Shaw and Holmes 1983), in
/// long double: A^2 = p + q v + r v^2.
struct Impacts {
    using Number = long double;
    Number zeta, omega, e, sigma;
    Number p = 0, q = 0, r = 0;             ///< coefficients of the squared amplitude
    Number still = 0, by_speed = 0;         ///< A cos(phi)
    Number out_still = 0, out_by_speed = 0; ///< A sin(phi)
    Number after_an_impulse = 0, trace = 0,
           loss = 0; ///< response to an impulse and trace over one period without impact; determinant of the map

    Impacts(Number damping, Number frequency, Number restitution, Number stop)
        : zeta(damping), omega(frequency), e(restitution), sigma(stop) {
        const Number d = std::sqrt(1 - zeta * zeta), period = 2 * std::numbers::pi_v<Number> / omega;
        const Number decay = std::exp(-zeta * period), c = std::cos(d * period), s = std::sin(d * period);
        // x(T) = x(0) and v(T) = v of what is free, whose jumps are zero and v(0) - v(T) = -(1 + e) v.
        const Number m11 = decay * (c + zeta / d * s), m12 = decay * s / d, m22 = decay * (c - zeta / d * s);
        // (x0, v0) of the free part: x0 = m11 x0 + m12 v0, v0 + (1 + e) v = -m12 x0 + m22 v0.
        const Number determinant = (1 - m11) * (1 - m22) + m12 * m12;
        const Number x0 = -(1 + e) * m12 / determinant, v0 = -(1 + e) * (1 - m11) / determinant;
        // The forced part has sigma - x0 v and -e v - v0 v at the time of the impact.
        const Number real = 1 - omega * omega, imaginary = 2 * zeta * omega;
        // x = Re(A e^(i phi) / (real + i imaginary) e^(i omega t)) = u, v / omega = -Im(...).
        const auto in_phase = [&](Number u, Number w) { return real * u - imaginary * w; };
        const auto out_of_phase = [&](Number u, Number w) { return imaginary * u + real * w; };
        const Number u_still = sigma, u_speed = -x0, w_speed = (e + v0) / omega;
        still = in_phase(u_still, 0);
        by_speed = in_phase(u_speed, w_speed);
        out_still = out_of_phase(u_still, 0);
        out_by_speed = out_of_phase(u_speed, w_speed);
        p = still * still + out_still * out_still;
        q = 2 * (still * by_speed + out_still * out_by_speed);
        r = by_speed * by_speed + out_by_speed * out_by_speed;
        after_an_impulse = m12;
        trace = m11 + m22;
        loss = e * e * decay * decay;
    }
    Number amplitude(Number speed) const { return std::sqrt(p + q * speed + r * speed * speed); }
    Number fold() const { return -q / (2 * r); }
    /// Returns the speed at the flip, where 1 + trace + determinant of the impact map is zero; the condition is linear
    /// in the speed.
    Number flip() const {
        const Number k = after_an_impulse * (1 + e);
        return -k * (still - sigma) / (1 + loss - e * trace + k * by_speed);
    }
    Model model(Number at) const {
        const auto narrow = [](Number value) { return static_cast<double>(value); };
        return shipped_with("impact-oscillator", {{"zeta", narrow(zeta)},
                                                  {"omega", narrow(omega)},
                                                  {"e", narrow(e)},
                                                  {"sigma", narrow(sigma)},
                                                  {"amplitude", narrow(at)}});
    }
};

/// Returns the frequency near 2 at which the fold or flip has a given speed.
double tuned(bool fold, double speed) {
    const auto lack = [&](double omega) {
        const Impacts here(0.1L, omega, 0.7L, 0.5L);
        return (fold ? here.fold() : here.flip()) - speed;
    };
    // At omega = 2 sqrt(1 - zeta^2) both have zero speed.
    double low = 1.95, high = 2.03;
    const bool falls = lack(low) > 0;
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        ((lack(middle) > 0) == falls ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

TEST(NearGrazing, FoldsAndFlipsOfSlowImpactsAreFoundFromTheTouch) {
    for (const bool fold : {true, false})
        for (const double speed : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
            const Impacts known(0.1L, tuned(fold, speed), 0.7L, 0.5L);
            const Model model = known.model(0.5L * known.amplitude(0));
            const double most = static_cast<double>(1.2L * known.amplitude(0));
            const BranchSettings settings = in_parameter(model, "amplitude", 0.01, most);
            const Branch free = follow_branch(System(model), settled(model, "phase0").orbit, settings);
            ASSERT_EQ(names(free), "GR");
            EXPECT_NEAR(free.special[0].parameter, static_cast<double>(known.amplitude(0)), 1e-11);
            const Branch impacting =
                follow(model, branches_at(System(model), free.special[0], settings).front(), settings);
            ASSERT_EQ(names(impacting), fold ? "SN BD" : "PD BD") << speed;
            EXPECT_NEAR(impacting.special[0].parameter,
                        static_cast<double>(known.amplitude(fold ? known.fold() : known.flip())), 1e-10)
                << speed;
        }
}

TEST(NearGrazing, FoldsAndFlipsOfSlowImpactsAreFoundTowardsTheTouch) {
    for (const bool fold : {true, false})
        for (const double speed : {1e-3, 1e-5, 1e-7, 1e-8}) {
            const Impacts known(0.1L, tuned(fold, speed), 0.7L, 0.5L);
            constexpr double begin = 0.1; // speed
            Model model = known.model(known.amplitude(begin));
            const double phase = static_cast<double>(
                std::atan2(known.out_still + known.out_by_speed * begin, known.still + known.by_speed * begin));
            const Orbit orbit =
                given_orbit(model, "impact", {{0.5, -0.7 * begin, phase}}, {2 * pi / static_cast<double>(known.omega)});
            std::string all;
            for (const int direction : {1, -1}) {
                const BranchSettings settings = in_parameter(model, "amplitude", 0.01, 2.5, direction);
                const Branch branch = follow_branch(System(model), orbit, settings);
                all += names(branch) + ";";
                for (const SpecialPoint& point : branch.special)
                    if (point.type == PointType::fold || point.type == PointType::flip) {
                        EXPECT_NEAR(point.parameter,
                                    static_cast<double>(known.amplitude(fold ? known.fold() : known.flip())), 1e-10);
                    }
            }
            EXPECT_NE(all.find(fold ? "SN GR" : "PD GR"), std::string::npos) << speed << ": " << all;
            EXPECT_EQ(all.find("BP"), std::string::npos) << all;
        }
}

/// A linear oscillator with a pulse of force while cos(theta) > c.
Model pulsed(double c, const char* off, const char* on, const char* kind) {
    return TwoModes{.parameters = fmt::format("c = {}", c),
                    .states = "x = 0.1\nv = 0",
                    .clock = "1.2",
                    .first = {"on", "x = 'v', v = '0.3 - 0.3*v - x'", "off", off},
                    .second = {"off", "x = 'v', v = '-0.3*v - x'", "on", on},
                    .kind = kind,
                    .more = at_phase(1)}
        .model();
}

TEST(NearGrazing, VanishingPulseIsNotABranchPoint) {
    // At c = 1 the pulse has zero length and the event that begins it zero speed. The multipliers, of modulus e^(-0.15
    // T), are far from 1.
    const Model model = pulsed(0.2, "cos(theta) - c", "c - cos(theta)", "barrier");
    for (const int direction : {1, -1}) {
        const BranchSettings settings = in_parameter(model, "c", -1.5, 1.5, direction);
        const Branch branch = follow_branch(System(model), settled(model, "start").orbit, settings);
        EXPECT_EQ(names(branch).find("BP"), std::string::npos) << names(branch);
        EXPECT_EQ(branch.outcome, BranchOutcome::unphysical);
        EXPECT_NEAR(branch.points.back().parameter, direction, 1e-8); // the branch has a fold there
        if (direction > 0) {
            ASSERT_EQ(names(branch), "GR");
            EXPECT_NEAR(branch.special[0].parameter, 1, 1e-12);
        }
    }
}

TEST(NearGrazing, FunctionThatStartsToRiseFromItsSurfaceIsNotATouch) {
    // From c = 0 on the function of event `on` is negative at the start of the segment and rises; the event happens at
    // theta = 2 pi as before. At c = 1 the event `off` is touched.
    const Model model = pulsed(-0.3, "sin(theta) - c", "-sin(theta)", "section");
    BranchSettings settings = in_parameter(model, "c", -0.9, 1.5);
    const Branch branch = follow_branch(System(model), settled(model, "start").orbit, settings);
    EXPECT_EQ(names(branch), "GR");
    EXPECT_NEAR(branch.special.at(0).parameter, 1, 1e-12);
    settings.direction = -1;
    settings.least = -1.5;
    const Branch down = follow_branch(System(model), settled(model, "start").orbit, settings);
    EXPECT_EQ(names(down), "GR");
    EXPECT_NEAR(down.special.at(0).parameter, -1, 1e-12);
}

} // namespace graze::near_grazing_test
