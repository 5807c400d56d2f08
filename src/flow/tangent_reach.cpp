#include "graze/flow/tangent_reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace graze {

namespace {

/// What is so small against anything a double can hold that nothing may be said of its relative accuracy.
constexpr double nothing = 1e-200;
constexpr std::size_t most_lanes = 32;

/// Size of a series whose first three terms are zero.
double size_of_all(const double* c, std::size_t width, std::size_t order, double step) {
    double sum = 0;
    for (std::size_t k = order + 1; k-- > 0;)
        sum = sum * step + std::abs(c[k * width]);
    return sum;
}

} // namespace

double tangent_reach(const Jet& jet, std::size_t states, std::size_t count, double tolerance, double step) {
    const auto order = static_cast<std::size_t>(jet.order()), width = static_cast<std::size_t>(jet.width());
    const double root = 1.0 / static_cast<double>(order - 1);
    double reach = step;
    // Sizes shrink with the step: a few rounds.
    for (int round = 0; round < 6; ++round) {
        double power = 1, worst = 0;
        for (std::size_t k = 1; k < order; ++k)
            power *= reach;
        for (std::size_t i = 0; i < states; ++i) {
            const double* c = jet.state(i) + 1;
            std::array<double, most_lanes> sizes, lasts;
            for (std::size_t l = 0; l < count; ++l) {
                sizes[l] = std::abs(c[l]) + reach * (std::abs(c[width + l]) + reach * std::abs(c[2 * width + l]));
                lasts[l] =
                    power * std::max(std::abs(c[(order - 1) * width + l]), reach * std::abs(c[order * width + l]));
            }
            for (std::size_t l = 0; l < count; ++l) {
                const double size = sizes[l] > 0 || lasts[l] == 0 ? sizes[l] : size_of_all(c + l, width, order, reach);
                if (lasts[l] > worst * size && size > nothing)
                    worst = lasts[l] / size;
            }
        }
        if (!(worst > tolerance))
            break;
        reach *= std::pow(tolerance / worst, root);
    }
    return std::isfinite(reach) && reach > 0 ? reach : step;
}

} // namespace graze
