#pragma once

#include "closed_form.hpp"
#include "simulate.hpp"

#include <gtest/gtest.h>

#include <memory>

// Common parts of the tests of contacts at the limit of detection: closed-form motions that pass a surface by a chosen
// small depth, and the criteria for the engine's result.
namespace graze::testing {

using Real = long double;

/// Records touches and the first crossing, at which it stops.
struct Witness : Observer {
    int crossings = 0, wanted = 1;
    double time = 0, rate = 0;
    std::vector<double> before, touches;
    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::touch) {
            touches.push_back(contact.time);
            return;
        }
        ++crossings;
        time = contact.time;
        rate = contact.rate_before;
        before.assign(contact.before.begin(), contact.before.end());
    }
    bool stop() override { return crossings >= wanted; }
    void clear() {
        crossings = 0;
        touches.clear();
    }
};

/// Simulations of one model at many tolerances.
class Bench {
public:
    Bench(const Model& model, double from, double to, int count) {
        for (int i = 0; i < count; ++i) {
            const double tolerance = from * std::pow(to / from, count > 1 ? i / (count - 1.0) : 0);
            simulations_.push_back(std::make_unique<Simulation>(System(model), std::vector<Probe>{},
                                                                std::vector<Expression>{}, with_tolerance(tolerance)));
            jets_.push_back(std::make_unique<JetSet>(*simulations_.back(), LaneKind::single));
        }
    }
    const Simulation& draw(Random& random) {
        drawn_ = static_cast<std::size_t>(random.integer(0, static_cast<int>(simulations_.size()) - 1));
        return *simulations_[drawn_];
    }
    double tolerance() const { return simulations_[drawn_]->options().tolerance; }
    Outcome run(std::span<const double> parameters, std::span<const double> state, double end_time, Witness& witness,
                std::size_t mode = 0) {
        witness.clear();
        Trajectory trajectory(*simulations_[drawn_], parameters, borrowed(witness));
        trajectory.start(state, mode, 0, end_time);
        graze::run(trajectory, *jets_[drawn_]);
        steps = trajectory.steps();
        return trajectory.outcome();
    }
    std::size_t steps = 0;

private:
    std::vector<std::unique_ptr<Simulation>> simulations_;
    std::vector<std::unique_ptr<JetSet>> jets_;
    std::size_t drawn_ = 0;
};

struct Peak {
    Real time, height, curvature; ///< height > 0 is beyond the surface; curvature > 0
};

/// The allowed error of the engine, as a distance from the surface.
struct Band {
    Real contact; ///< a peak beyond the surface by more must cause a contact, which must be within this distance of the
                  ///< surface
    Real touch;   ///< a peak within this distance of the surface must be reported, as contact or as touch
};

/// Returns the accuracy that a tolerance promises for a motion of this size: a tenth of the tolerance, plus round-off
/// of the initial values and of each step.
inline Band band_of(double tolerance, Real size, std::size_t steps) {
    return {size * (0.1L * tolerance + (64 + 4 * Real(steps)) * epsilon), size * (0.1L * tolerance + 4 * epsilon)};
}

/// Counts the results for motions with given peaks of depth.
struct Tally {
    long cases = 0, contacts = 0, inside_band = 0, missed = 0, invented = 0, inaccurate = 0, silent = 0, ended = 0;
    double worst = 0; ///< smallest multiple of the band for which all results are right
    std::string first_failure;

    template <class Depth>
    void judge(const Witness& witness, const Outcome& outcome, const std::vector<Peak>& peaks, const Depth& depth,
               Band limits, Real time_noise, const std::string& label) {
        const Real band = limits.contact;
        ++cases;
        const auto fail = [&](long& count, const char* what) {
            if (count++ == 0 || first_failure.empty())
                first_failure += fmt::format("{}: {}\n", what, label);
        };
        if (outcome.ending != Ending::end_time && outcome.ending != Ending::stopped)
            return fail(ended, outcome.detail.c_str());
        const bool contact = witness.crossings >= witness.wanted;
        const Real until = contact ? Real(witness.time) : 1e300L;
        contacts += contact;
        for (const Peak& peak : peaks) {
            const Real blur = std::sqrt(4 * band / peak.curvature) + time_noise;
            if (peak.time > until + blur)
                break;
            // The motion must not be accepted beyond its first penetration.
            if (peak.height > 0 && peak.time < until - blur) {
                worst = std::max(worst, static_cast<double>(peak.height / band));
                if (peak.height > band)
                    return fail(missed, "missed");
            }
            if (std::abs(peak.height) <= limits.touch) {
                ++inside_band;
                bool seen = contact && std::abs(until - peak.time) <= blur;
                for (const double touch : witness.touches)
                    seen = seen || std::abs(touch - peak.time) <= blur;
                if (!seen)
                    return fail(silent, "neither touch nor contact");
            }
        }
        if (!contact)
            return;
        const auto [value, slope] = depth(until);
        const Real excess = std::abs(value) - time_noise * std::abs(slope);
        if (excess > 0)
            worst = std::max(worst, static_cast<double>(excess / band));
        if (excess > band)
            return fail(value < 0 && -value > band ? invented : inaccurate, "contact away from the surface");
    }
    void expect_clean(long least_cases) const {
        ::testing::Test::RecordProperty("worst", std::to_string(worst));
        EXPECT_GE(cases, least_cases);
        EXPECT_EQ(missed, 0) << first_failure;
        EXPECT_EQ(invented, 0) << first_failure;
        EXPECT_EQ(inaccurate, 0) << first_failure;
        EXPECT_EQ(silent, 0) << first_failure;
        EXPECT_EQ(ended, 0) << first_failure;
        EXPECT_GT(contacts, cases / 20);
        EXPECT_LT(contacts, cases - cases / 20);
        EXPECT_GT(inside_band, 0);
    }
};

struct Jet2 {
    Real value, slope, curvature;
};

/// Returns the maxima of a function in (0, end), whose distances are at least `spacing`.
template <class Function>
std::vector<Peak> maxima(const Function& f, Real end, Real spacing) {
    std::vector<Peak> peaks;
    const auto count = static_cast<std::size_t>(std::ceil(end / spacing)) + 1;
    const Real h = end / Real(count);
    Real last = f(0).slope;
    for (std::size_t i = 1; i <= count; ++i) {
        const Real slope = f(h * Real(i)).slope;
        if (last > 0 && slope <= 0) {
            const Real t = root_in(
                [&](Real s) {
                    const Jet2 jet = f(s);
                    return std::pair(jet.slope, jet.curvature);
                },
                h * Real(i - 1), h * Real(i));
            const Jet2 jet = f(t);
            peaks.push_back({t, jet.value, std::abs(jet.curvature)});
        }
        last = slope;
    }
    return peaks;
}

/// Returns a random depth of either sign, with a scale-invariant distribution.
inline double draw_depth(Random& random) {
    return random.log_uniform(1e-13, 1e-1) * (random.chance(0.5) ? 1 : -1);
}

} // namespace graze::testing
