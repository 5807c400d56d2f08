#pragma once

#include "graze/tape/jet.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// The series of the watched event functions of a mode along an arc, step by step.
class WatchedSeries {
public:
    struct Step {
        double time = 0;   ///< time of its beginning since the start of the arc
        double length = 0; ///< with the sign of the arc's duration
    };

    /// Clears the series. @param events number of watched events
    void begin(std::size_t events) {
        events_ = events;
        steps_.clear();
        coefficients_.clear();
    }
    /// Stores the series of the next step from lane 0 of a jet at its start; the length of the step follows by
    /// `end_step`.
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
    /// Stores the beginning and length of the step.
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
