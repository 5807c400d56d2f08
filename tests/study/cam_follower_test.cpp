// The shipped cam and follower: the speeds of lifting off, impacts that accumulate, folds and flips in closed form.

#include "study/study_fixture.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace graze::cam_follower_test {

using namespace graze::testing;
using std::numbers::pi;
using ::testing::HasSubstr;

/// Impacts after lifting off, from the closed form of flights, in extended precision.
class Impacts {
public:
    using Real = long double;
    Impacts(Real e, Real kappa, Real omega)
        : e_(e), kappa_(kappa), omega_(omega), angle_(-std::acos(1 / (omega * omega - kappa))) {}

    /// Follows the impacts until none is faster than 1e-16. @return false where the cam falls away before, a turn after
    /// the lift-off
    bool accumulate() {
        const Real end = angle_ + 2 * std::numbers::pi_v<Real>;
        flight(first_flight());
        while (speed_ > 1e-16L) {
            if (!(force() > 0) || angle_ > end)
                return false;
            const Real guess = 2 * speed_ / force();
            // Where no short flight comes back Newton's method finds another zero, or none.
            if (!flight(guess < 0.3L ? zero_near(guess) : first_flight()))
                return false;
        }
        return true;
    }
    const std::vector<Real>& times() const { return times_; } ///< since the lift-off
    Real time() const { return time_; }

private:
    Real force() const { return 1 + (kappa_ - omega_ * omega_) * std::cos(angle_); }
    /// Derivatives of the gap after an impact: the first is the speed, and no digits are lost in short flights.
    std::array<Real, 64> derivatives() const {
        std::array<Real, 64> all{};
        const Real c = std::cos(angle_), s = std::sin(angle_);
        const std::array<Real, 4> cam{c, -s, -c, s};
        Real even = -1 - kappa_ * c, odd = -kappa_ * (speed_ - omega_ * s), power = omega_;
        all[1] = speed_;
        for (std::size_t k = 2; k < all.size(); ++k) {
            power *= omega_;
            Real& own = k % 2 == 0 ? even : odd;
            all[k] = own - power * cam[k % 4];
            own *= -kappa_;
        }
        return all;
    }
    Real gap(Real t) const { // by the time
        const auto d = derivatives();
        Real sum = 0;
        for (std::size_t k = d.size(); k-- > 1;)
            sum = (sum * t + d[k]) / static_cast<Real>(k);
        return sum;
    }
    Real rate(Real t) const {
        const auto d = derivatives();
        Real sum = 0;
        for (std::size_t k = d.size(); k-- > 1;)
            sum = sum * t / static_cast<Real>(k) + d[k];
        return sum;
    }
    Real zero_near(Real t) const {
        for (int i = 0; i < 30; ++i) // of the gap, which is t gap(t)
            t -= t * gap(t) / rate(t);
        return t;
    }
    Real first_flight() const {
        constexpr Real step = 0.01L;
        Real low = step;
        while (gap(low + step) > 0)
            low += step;
        return zero_near(low + step / 2);
    }
    bool flight(Real t) {
        const Real hit = rate(t);
        time_ += t;
        angle_ += omega_ * t;
        times_.push_back(time_);
        speed_ = -e_ * hit;
        return t > 0 && hit < 0;
    }

    Real e_, kappa_, omega_, angle_, speed_ = 0, time_ = 0;
    std::vector<Real> times_;
};

/// Orbits with one impact in n turns. The follower leaves the cam with the velocity r (1/kappa + cos(theta)), r =
/// sqrt(kappa) tan(sqrt(kappa) T/2), T = 2 pi n/omega, and meets it with the opposite one.
struct OneImpact {
    double e, kappa;
    int n = 1;

    double ratio() const { return (1 - e) / (1 + e); }
    double time(double omega) const { return 2 * pi * n / omega; }
    /// r, and r/kappa.
    double rise(double omega) const {
        const double s = std::sqrt(kappa);
        return kappa > 0 ? s * std::tan(s * time(omega) / 2) : 0;
    }
    double fall(double omega) const { return kappa > 0 ? rise(omega) / kappa : time(omega) / 2; }
    /// -omega sin(theta) = ratio (r cos(theta) + r/kappa) has solutions above the speed at which this is zero.
    double margin(double omega) const { return std::hypot(omega, ratio() * rise(omega)) - ratio() * fall(omega); }
    /// The angle of the impact of the orbit that is stable at the fold.
    double angle(double omega) const {
        const double a = ratio() * rise(omega), size = std::hypot(omega, a);
        return std::atan2(omega, a) + std::acos(std::min(1.0, ratio() * fall(omega) / size)) - pi;
    }
    /// Trace of the derivative of the return to the impact, by the implicit function theorem.
    double trace(double omega) const {
        const double t = time(omega), s = std::sqrt(kappa), angle_here = angle(omega), x = std::cos(angle_here),
                     cam = -omega * std::sin(angle_here), out = fall(omega) + rise(omega) * x;
        const double cosine = std::cos(s * t), sine = std::sin(s * t), per_speed = kappa > 0 ? sine / s : t;
        const double slope = -out - cam; // rate of the gap before the impact
        const double by_angle = std::sin(angle_here) * (cosine - 1) / slope,
                     by_speed = -per_speed / slope; // of the time
        return 1 + omega * by_angle - (1 + e) * omega * std::cos(angle_here) * omega * by_speed -
               e * (cosine - (1 + kappa * x) * by_speed);
    }
    template <class Function>
    static double zero(double low, double high, const Function& function) {
        const bool rises = function(low) < 0;
        for (int i = 0; i < 200; ++i)
            ((function((low + high) / 2) < 0) == rises ? low : high) = (low + high) / 2;
        return low;
    }
    double fold() const {
        return zero(std::max(0.3, std::sqrt(kappa) * 2.0 * n * (1 + 1e-9)), 5, [&](double w) { return margin(w); });
    }
    double flip() const {
        return zero(fold() * (1 + 1e-9), 2 * fold(), [&](double w) { return 1 + trace(w) + e * e; });
    }
};

class CamFollower : public StudyFixture {};

/// The contact force 1 + (kappa - omega^2) cos(theta) stays positive up to omega = sqrt(1 + kappa).
TEST_F(CamFollower, LiftsOffAtTheSpeedAndAngleOfTheClosedForm) {
    for (const double kappa : {0.0, 0.2, 1.5})
        for (const double share : {1 - 1e-9, 1 + 1e-9, 1.1, 1.7}) {
            const double omega = share * std::sqrt(1 + kappa);
            const Model model = shipped_with("cam-follower", {{"kappa", kappa}, {"omega", omega}});
            Experiment experiment(model, with_tolerance(1e-15));
            experiment.run_from({-1, 0, pi}, *model.find_mode("free-cam"), 2 * pi / omega);
            const auto& contacts = experiment.recorder.contacts();
            EXPECT_EQ(contacts.empty(), share < 1) << kappa << ' ' << omega;
            if (contacts.empty())
                continue;
            EXPECT_EQ(experiment.label(0), "free-cam:cam-opens");
            const double angle = std::remainder(contacts[0].after[2], 2 * pi);
            EXPECT_NEAR(std::cos(angle), 1 / (omega * omega - kappa), 1e-13);
            EXPECT_LT(angle, 0);
        }
}

/// Every impact of a turn, and when the follower is at rest on the cam.
TEST_F(CamFollower, ImpactsAccumulateAsInExtendedPrecision) {
    for (const double omega : {1.15, 1.2, 1.4}) {
        const Model model = shipped_with("cam-follower", {{"omega", omega}});
        Experiment experiment(model, with_tolerance(1e-15));
        experiment.run_from({-1, 0, pi}, *model.find_mode("free-cam"), 4 * pi / omega);
        const auto& contacts = experiment.recorder.contacts();
        Impacts known(0.4L, 0.2L, omega);
        ASSERT_TRUE(known.accumulate());
        ASSERT_GT(contacts.size(), 14U);
        // A gap is known to some epsilon, the time of an impact to that divided by its speed.
        for (std::size_t i = 0; i < 12; ++i)
            EXPECT_NEAR(contacts[i + 1].contact.time - contacts[0].contact.time, static_cast<double>(known.times()[i]),
                        1e-13 + 8 * epsilon / std::abs(contacts[i + 1].contact.rate_before))
                << omega << ' ' << i;
        expect_complete(run(fmt::format(R"(name = "s"
model = "cam-follower"
[runs.orbit]
kind = "orbit"
set = {{ omega = {:.17g} }}
)",
                                        omega)));
        const ResultFile file(path_, ResultFile::Access::read);
        const auto found = file.orbits("orbit", false).at(0).point.solution;
        ASSERT_EQ(found.orbit.segments(), 2U);
        EXPECT_NEAR(found.orbit.period(), 2 * pi / omega, 1e-12);
        for (std::size_t s = 0; s < 2; ++s)
            if (found.orbit.signature[s].end == SegmentEnd::chatter) {
                EXPECT_NEAR(found.orbit.durations[s], static_cast<double>(known.time()), 1e-9) << omega;
            }
    }
}

/// Orbits whose impacts accumulate begin where the follower lifts off, and end where impacts last until the cam falls
/// away again.
TEST_F(CamFollower, AccumulationsBeginAndEndWhereTheClosedFormsDo) {
    expect_complete(run(R"(name = "s"
model = "cam-follower"
[runs.chatter]
kind = "continue"
along = { omega = [1, 1.5] }
[runs.onsets]
kind = "curve"
start = { run = "chatter", point = "CH1" }
along = { kappa = [0, 0.6], omega = [0.5, 3] }
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto first = file.orbit("chatter", std::string("DZ1")), last = file.orbit("chatter", std::string("CH1"));
    ASSERT_TRUE(first);
    // The flight takes a time that goes with the root of the distance; what is left of it bounds the accuracy.
    EXPECT_NEAR(first->point.parameter, std::sqrt(1.2), 1e-7);
    EXPECT_THAT(first->point.detail, HasSubstr("no longer leaves the surface"));
    const auto onset = [](long double kappa) {
        long double low = std::sqrt(1 + kappa) * 1.01L, high = 2 * low;
        for (int i = 0; i < 60; ++i) {
            const long double middle = (low + high) / 2;
            (Impacts(0.4L, kappa, middle).accumulate() ? low : high) = middle;
        }
        return static_cast<double>(low);
    };
    ASSERT_TRUE(last);
    EXPECT_NEAR(last->point.parameter, onset(0.2L), 1e-9);
    for (const auto& [label, kappa] : {std::pair{"EP1", 0.6L}, std::pair{"EP2", 0.0L}}) {
        const auto end = file.orbit("onsets", std::string(label));
        ASSERT_TRUE(end) << label;
        const Model model = shipped_with("cam-follower");
        const std::vector<double>& at = end->point.solution.orbit.parameters;
        EXPECT_NEAR(at[model.independent_parameter("kappa").place()], static_cast<double>(kappa), 1e-12);
        EXPECT_NEAR(at[model.independent_parameter("omega").place()], onset(kappa), 1e-9);
    }
}

/// One impact in each turn, from the fold to the flip. Without spring the follower is a bouncing ball, whose fold is at
/// omega^2 = pi (1 - e)/(1 + e).
TEST_F(CamFollower, BouncesBetweenTheFoldAndTheFlipOfTheClosedForms) {
    for (const double kappa : {0.0, 0.2, 0.7}) {
        const OneImpact known{0.4, kappa};
        const double start = 0.5 * (known.fold() + known.flip()), angle = known.angle(start);
        expect_complete(run(fmt::format(R"(name = "s"
model = "cam-follower"
set = {{ kappa = {}, omega = {:.17g} }}
[runs.one]
kind = "orbit"
from = {{ x = {:.17g}, v = {:.17g}, theta = {:.17g} }}
[runs.branch]
kind = "continue"
start = {{ run = "one" }}
along = {{ omega = [0.9, 3.2] }}
)",
                                        kappa, start, std::cos(angle),
                                        known.fall(start) + known.rise(start) * std::cos(angle), angle)));
        const ResultFile file(path_, ResultFile::Access::read);
        const auto one = file.orbits("one", false).at(0).point.solution;
        ASSERT_EQ(one.orbit.segments(), 1U);
        ASSERT_EQ(one.multipliers.size(), 2U);
        EXPECT_NEAR(std::abs(one.multipliers[0] * one.multipliers[1]), 0.16, 1e-11);
        EXPECT_NEAR((one.multipliers[0] + one.multipliers[1]).real(), known.trace(start), 1e-10);
        const auto fold = file.orbit("branch", std::string("SN1")), flip = file.orbit("branch", std::string("PD1"));
        ASSERT_TRUE(fold);
        EXPECT_NEAR(fold->point.parameter, known.fold(), 1e-11);
        ASSERT_TRUE(flip);
        EXPECT_NEAR(flip->point.parameter, known.flip(), 1e-11);
        if (kappa == 0) {
            EXPECT_NEAR(fold->point.parameter, std::sqrt(pi * 0.6 / 1.4), 1e-11);
        }
    }
}

} // namespace graze::cam_follower_test
