#pragma once

#include "cvodes_peer.hpp"
#include "motion.hpp"

#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace peers {

/// A motion with derivatives in long double, by a Runge-Kutta method of order eight at tolerances that only this
/// precision allows, independent of graze and CVODES. Surfaces are detected at the ends of the short steps and located
/// by Newton's method.
class Reference {
public:
    using Real = long double;

    Reference(const Motion<Real>& motion, Real longest_step)
        : motion_(&motion), count_(motion.states()), longest_(longest_step), work_(3 * count_) {}

    void run(const std::vector<double>& start, std::size_t mode, Real end) {
        begin(start, mode);
        advance(end);
    }

    /// Starts at time 0.
    void begin(const std::vector<double>& start, std::size_t mode) {
        all_.assign(count_ * (count_ + 2), 0);
        std::copy(start.begin(), start.end(), all_.begin());
        for (std::size_t j = 0; j < count_; ++j)
            all_[(j + 1) * count_ + j] = 1;
        mode_ = mode;
        time_ = 0;
        meetings.clear();
    }
    void advance(Real end) {
        namespace odeint = boost::numeric::odeint;
        auto controlled = odeint::make_controlled(tolerance, tolerance, longest_, Method());
        Real step = longest_ / 100;
        while (time_ < end) {
            step = std::min(step, end - time_);
            const bool is_last = step == end - time_;
            const std::vector<Real> before = distances();
            if (controlled.try_step([this](const auto& x, auto& rate, Real) { rates(x, rate); }, all_, time_, step) ==
                odeint::fail)
                continue;
            const std::size_t surface = met_since(before);
            if (surface < before.size())
                meet(surface);
            else if (is_last)
                break;
        }
    }

    Real state(std::size_t i) const { return all_[i]; }
    Real derivative(std::size_t i, std::size_t input) const { return all_[(input + 1) * count_ + i]; }
    std::vector<Meeting> meetings;

private:
    using Vector = std::vector<Real>;
    using Method = boost::numeric::odeint::runge_kutta_fehlberg78<Vector, Real>;
    static constexpr Real tolerance = 1e-17L;

    void rates(const Vector& x, Vector& rate) {
        columns_.clear();
        column_rates_.clear();
        for (std::size_t j = 1; j < count_ + 2; ++j) {
            columns_.push_back(&x[j * count_]);
            column_rates_.push_back(&rate[j * count_]);
        }
        motion_->rates(mode_, x.data(), rate.data());
        motion_->derivative_rates(mode_, x.data(), columns_, column_rates_);
    }
    Vector distances() const {
        Vector values(motion_->surfaces(mode_));
        motion_->distances(mode_, all_.data(), values.data());
        return values;
    }
    /// Returns the first surface that was crossed since `before`, or the number of surfaces if there was none.
    std::size_t met_since(const Vector& before) const {
        const Vector now = distances();
        std::size_t met = now.size();
        Real first = 2;
        for (std::size_t i = 0; i < now.size(); ++i) {
            // An arc may begin on a surface, where round-off decides on which side.
            const Real share = before[i] / (before[i] - now[i]);
            if (now[i] < 0 && before[i] > -tolerance && share < first) {
                met = i;
                first = share;
            }
        }
        return met;
    }
    void meet(std::size_t surface) {
        constexpr int iterations = 8;
        Vector rate(all_.size());
        for (int i = 0; i < iterations; ++i) {
            motion_->rates(mode_, all_.data(), rate.data());
            const Real step = -distances()[surface] / motion_->gradient_times(mode_, surface, rate.data());
            if (std::abs(step) < 1e-19L)
                break;
            method_.do_step([this](const auto& x, auto& out, Real) { rates(x, out); }, all_, time_, step);
            time_ += step;
        }
        meetings.push_back({static_cast<double>(time_), mode_, surface});
        std::vector<Real*> columns;
        for (std::size_t j = 1; j < count_ + 2; ++j)
            columns.push_back(&all_[j * count_]);
        mode_ = cross_with_derivatives<Real>(*motion_, mode_, surface, all_.data(), columns, work_.data());
    }

    const Motion<Real>* motion_;
    std::size_t count_, mode_ = 0;
    Real longest_, time_ = 0;
    Vector work_, all_;
    Method method_;
    std::vector<const Real*> columns_;
    std::vector<Real*> column_rates_;
};

} // namespace peers
