#include "branch/torus_beyond.hpp"

#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// The passage of a motion beside a tongue along the curve of its orbits.
class SlowPassage {
public:
    SlowPassage(const LockedCurve& curve, double parameter, double across)
        : curve_(curve), parameter_(parameter), across_(across) {
        constexpr std::size_t parts = 16;
        times_.push_back(0);
        for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
            const double length = (curve.points[i + 1].along - curve.points[i].along) / parts;
            for (std::size_t part = 0; part < parts; ++part) {
                const double from = static_cast<double>(part) / parts, step = 1.0 / parts;
                const double slowness =
                    (1 / speed(i, from) + 4 / speed(i, from + 0.5 * step) + 1 / speed(i, from + step)) / 6;
                times_.push_back(times_.back() + length * slowness);
                if (!((times_.back() - times_[times_.size() - 2]) * times_[1] > 0)) {
                    times_.clear();
                    return;
                }
            }
        }
        parts_ = parts;
    }

    /// False where the motion does not come all around.
    bool is_defined() const { return !times_.empty() && std::isfinite(times_.back()); }
    /// Returns once around returns of the orbit, negative for passages against the curve.
    double whole() const { return times_.back(); }
    /// Returns the unknowns of the motion at a share of the time of the passage.
    std::vector<double> at(double share) const {
        const double time = share * whole(), sign = whole() < 0 ? -1 : 1;
        const auto next = std::ranges::upper_bound(times_, sign * time, {}, [&](double one) { return sign * one; });
        const auto place = static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(next - times_.begin() - 1, 0, static_cast<std::ptrdiff_t>(times_.size()) - 2));
        const double within = (time - times_[place]) / (times_[place + 1] - times_[place]);
        return beside(place / parts_, (static_cast<double>(place % parts_) + within) / static_cast<double>(parts_));
    }

private:
    /// Returns a point of the cubic between an orbit of the curve and the next.
    std::vector<double> between(std::size_t i, double f) const {
        const LockedPoint &first = curve_.points[i], &second = curve_.points[i + 1];
        const double g = 1 - f, length = second.along - first.along;
        return numbers_of(g * g * (1 + 2 * f) * vector_of(first.u) + f * f * (3 - 2 * f) * vector_of(second.u) +
                          length * f * g * (g * vector_of(first.tangent) - f * vector_of(second.tangent)));
    }
    /// Returns where the motion passes such a point.
    std::vector<double> beside(std::size_t i, double f) const {
        std::vector<double> u = between(i, f);
        const double off = across_ * (parameter_ - u.back());
        entries_of(u) += off * ((1 - f) * vector_of(curve_.points[i].drift.across) +
                                f * vector_of(curve_.points[i + 1].drift.across));
        return u;
    }
    double speed(std::size_t i, double f) const {
        const double drift = (1 - f) * curve_.points[i].drift.along + f * curve_.points[i + 1].drift.along;
        return drift * (parameter_ - between(i, f).back());
    }

    const LockedCurve& curve_;
    double parameter_, across_;
    std::size_t parts_ = 1;
    std::vector<double> times_; ///< at equal parts of each step along the curve
};

} // namespace

std::optional<std::vector<double>> torus_beyond(const TorusProblem& problem, const LockedCurve& curve,
                                                const Resonance& resonance, double parameter, double across) {
    const SlowPassage passage(curve, parameter, across);
    if (!passage.is_defined())
        return std::nullopt;
    const std::size_t returns = resonance.denominator, actives = problem.setting().active.size(),
                      samples = 4 * problem.terms();
    std::vector<double> u(problem.unknowns(), 0.0);
    for (std::size_t k = 0; k < samples; ++k) {
        const double turns = static_cast<double>(k) / static_cast<double>(samples),
                     arcs = turns * static_cast<double>(returns);
        const auto arc = std::min(static_cast<std::size_t>(arcs), returns - 1);
        const std::vector<double> orbit = passage.at(arcs - static_cast<double>(arc));
        const std::size_t first = arc * curve.shift % returns * actives;
        const Eigen::VectorXd functions = circle_functions(problem.harmonics(), turns);
        for (std::size_t term = 0; term < problem.terms(); ++term)
            for (std::size_t a = 0; a < actives; ++a)
                u[problem.place_of(term, a)] +=
                    (term == 0 ? 1 : 2) / static_cast<double>(samples) * functions[index(term)] * orbit[first + a];
    }
    const auto q = static_cast<double>(returns);
    u[problem.rotation_place()] = resonance.value() + 1 / (q * q * passage.whole());
    u[problem.parameter_place()] = parameter;
    return u;
}

double harmonics_beyond(const LockedCurve& curve, const Resonance& resonance, double parameter, double tail) {
    const double middle = 0.5 * (curve.least() + curve.greatest()), half = 0.5 * (curve.greatest() - curve.least()),
                 off = std::abs(parameter - middle) / half, decay = off - std::sqrt(off * off - 1);
    return static_cast<double>(resonance.denominator) * (std::log(tail) / std::log(decay) + 1);
}

} // namespace graze
