#pragma once

#include "graze/tape/jet.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// What the watched events of a mode do along an arc: the series of their functions, step by step.
class WatchedSeries {
public:
    struct Step {
        double time = 0;   ///< at which it begins, after the arc's start
        double length = 0; ///< with the sign of the arc's duration
    };

    /// Forgets all. @param events how many there are
    void begin(std::size_t events) {
        events_ = events;
        steps_.clear();
        coefficients_.clear();
    }
    /// Takes the series of the next step from a jet at its start, lane 0, before it is known how long the step is.
    void note(const Jet& jet) {
        const auto width = static_cast<std::size_t>(jet.width());
        terms_ = static_cast<std::size_t>(jet.order()) + 1;
        std::size_t to = events_ * terms_ * steps_.size();
        coefficients_.resize(to + events_ * terms_);
        for (std::size_t w = 0; w < events_; ++w) {
            const double* from = jet.output(w);
            for (std::size_t k = 0; k < terms_; ++k)
                coefficients_[to++] = from[k * width];
        }
    }
    /// And how long it is.
    void end_step(double time, double length) { steps_.push_back({time, length}); }

    std::span<const Step> steps() const { return steps_; }
    /// Coefficients of an event's function in powers of the time since the step's beginning.
    std::span<const double> of(std::size_t step, std::size_t event) const {
        return std::span(coefficients_).subspan((step * events_ + event) * terms_, terms_);
    }

private:
    std::size_t events_ = 0, terms_ = 0;
    std::vector<Step> steps_;
    std::vector<double> coefficients_; ///< [step][event][power]
};

} // namespace graze
