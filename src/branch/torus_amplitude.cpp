#include "branch/torus_amplitude.hpp"

#include "base/special_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// How far the return of small circles is from linear.
class Departure {
public:
    Departure(const TorusSetting& setting, const SignatureReturn::Image& at, double parameter, const TurningPair& pair)
        : setting_(setting), at_(at), parameter_(parameter), vector_(pair.vector),
          scales_(setting.scales(setting.active)),
          matrix_(scales_.cwiseInverse().asDiagonal() * at.derivatives(setting.active, setting.active) *
                  scales_.asDiagonal()) {}

    /// Returns the largest difference around a circle, relative to its size; infinite where motions do not return.
    double operator()(double amplitude) const {
        constexpr int angles = 8;
        double largest = 0;
        for (int k = 0; k < angles; ++k) {
            const Eigen::VectorXd off =
                amplitude * (std::polar(1.0, 2 * std::numbers::pi * k / angles) * vector_).real();
            std::vector<double> state = at_.motion.starts[0];
            for (std::size_t a = 0; a < setting_.active.size(); ++a)
                state[setting_.active[a]] += off[index(a)] * scales_[index(a)];
            const auto image = setting_.back->follow(state, parameter_, at_.motion.durations);
            if (!image)
                return infinity;
            const Eigen::VectorXd moved = (vector_of(image->after) - vector_of(at_.after))(setting_.active);
            largest = std::max(largest, (moved.cwiseQuotient(scales_) - matrix_ * off).norm() / amplitude);
        }
        return std::isfinite(largest) ? largest : infinity;
    }

private:
    const TorusSetting& setting_;
    const SignatureReturn::Image& at_;
    double parameter_;
    Eigen::VectorXcd vector_;
    Eigen::VectorXd scales_;
    Eigen::MatrixXd matrix_;
};

} // namespace

std::optional<double> amplitude_of_tori(const TorusSetting& setting, const SignatureReturn::Image& at, double parameter,
                                        const TurningPair& pair) {
    constexpr double linear = 0.5, factor = 2, smallest = 1e-12, largest = 1e24;
    const Departure departure(setting, at, parameter, pair);
    double amplitude = 1;
    while (amplitude > smallest && departure(amplitude) > linear)
        amplitude /= factor;
    // Scales below the round-off of the states: there the difference is noise.
    if (amplitude <= smallest) {
        amplitude = 1;
        while (amplitude < largest && departure(amplitude) > linear)
            amplitude *= factor;
    }
    while (amplitude < largest && departure(factor * amplitude) <= linear)
        amplitude *= factor;
    return amplitude < largest ? std::optional(amplitude) : std::nullopt;
}

bool scale_by_amplitude(TorusSetting& setting, const SignatureReturn::Image& at, double parameter,
                        const TurningPair& pair) {
    constexpr double least = 1e-2, greatest = 1e2; // extents along the orbit serve between these
    constexpr double moved = 1e-3;                 // share of the vector below which a state is not moved
    const auto amplitude = amplitude_of_tori(setting, at, parameter, pair);
    if (!amplitude || (*amplitude >= least && *amplitude <= greatest))
        return false;
    const Eigen::VectorXd shares = pair.vector.cwiseAbs() / pair.vector.cwiseAbs().maxCoeff();
    for (std::size_t a = 0; a < setting.active.size(); ++a)
        if (shares[index(a)] > moved)
            setting.scales[index(setting.active[a])] *= *amplitude * shares[index(a)];
    return true;
}

} // namespace graze
