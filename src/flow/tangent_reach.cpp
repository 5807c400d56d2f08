#include "graze/flow/tangent_reach.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// What is so small against anything a double can hold that nothing may be said of its relative accuracy.
constexpr double nothing = 1e-200;

/// Size of one series at a distance.
double size_of(const double* c, std::size_t width, std::size_t order, double step) {
    const double size = std::abs(c[0]) + step * (std::abs(c[width]) + step * std::abs(c[2 * width]));
    if (size > 0)
        return size;
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
            const double* series = jet.state(i) + 1;
            for (std::size_t lane = 0; lane < count; ++lane) {
                const double* c = series + lane;
                const double last =
                    power * std::max(std::abs(c[(order - 1) * width]), reach * std::abs(c[order * width]));
                const double size = last > 0 ? size_of(c, width, order, reach) : 1;
                if (last > worst * size && size > nothing)
                    worst = last / size;
            }
        }
        if (!(worst > tolerance))
            break;
        reach *= std::pow(tolerance / worst, root);
    }
    return std::isfinite(reach) && reach > 0 ? reach : step;
}

} // namespace graze
