#include "graze/flow/step_size.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "tape/kernel_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// With higher orders, coefficients near a singularity would leave the range of doubles.
constexpr int highest_order_chosen = 20;

} // namespace

void require_tolerance(double tolerance) {
    if (!(tolerance > 0))
        throw InputError(fmt::format("the tolerance {} is not positive", tolerance),
                         fmt::format("choose one from {} to {}", smallest_tolerance, largest_tolerance));
}

void require_order(int order) {
    if (order < 4 || order > highest_order)
        throw InputError(fmt::format("the order {} is out of range", order),
                         fmt::format("choose 4 to {}, or 0 to let the tolerance decide", highest_order));
}

int order_for_tolerance(double tolerance) {
    require_tolerance(tolerance);
    const double bounded = std::clamp(tolerance, smallest_tolerance, largest_tolerance);
    return std::clamp(static_cast<int>(std::ceil(1 - 0.55 * std::log(bounded))), 4, highest_order_chosen);
}

StepSize::StepSize(int order, double tolerance)
    : order_(static_cast<std::size_t>(order)),
      log_tolerance_(std::log2(std::clamp(tolerance, smallest_tolerance, largest_tolerance))) {
    require_order(order);
    require_tolerance(tolerance);
}

/// Returns the logarithm to base 2 of the least step over which any term equals one of the first terms before it, or
/// `known` if that is less; most terms are excluded without computing logarithms.
double StepSize::logarithm_of_change(const Series& c, double known) const {
    constexpr std::size_t terms = 3; // number of terms that measure the size
    constexpr double surely = 1 - 1e-9, tiny = 1e-290, huge = std::numeric_limits<double>::infinity();
    double least = known, ratio = std::exp2(-least);
    for (std::size_t j = 0; j < std::min(terms, order_); ++j) {
        const double first = std::abs(c[j]);
        if (!(first > 0 && first < huge))
            continue;
        double reached = first; // coefficient of this order with which a term equals the earlier one at the least step
        for (std::size_t k = j + 1; k <= order_; ++k) {
            const double size = std::abs(c[k]);
            reached *= ratio;
            if (!(size > 0 && size < huge) || (size < surely * reached && reached > tiny))
                continue;
            const double distance = static_cast<double>(k - j);
            if (const double change = (std::log2(first) - std::log2(size)) / distance; change < least) {
                least = change;
                ratio = std::exp2(-least);
                reached = size;
            }
        }
    }
    return least;
}

double StepSize::operator()(std::span<const Series> states, double previous) const {
    if (previous > 0)
        return step_for(states, previous);
    // Without a previous step the sizes of states that start at zero are unknown: begin with a step over which each
    // state changes by about its own size.
    double least = infinity; // logarithm of that step to base 2
    for (const Series& c : states)
        least = std::min(least, logarithm_of_change(c, least));
    double reference = std::isfinite(least) ? std::exp2(least) : 1;
    for (int sweep = 0; sweep < 3; ++sweep) {
        const double step = step_for(states, reference);
        if (!std::isfinite(step))
            return step;
        reference = step;
    }
    return reference;
}

double StepSize::polynomial_step(const Series& c, double size) const {
    std::size_t degree = order_;
    while (degree > 0 && c[degree] == 0)
        --degree;
    if (degree == 0 || size == 0)
        return std::numeric_limits<double>::infinity();
    return std::pow(size / std::abs(c[degree]), 1.0 / static_cast<double>(degree));
}

double StepSize::step_for(std::span<const Series> states, double reference) const {
    double step = 0;
    baseline::kernels(LaneKind::single)
        .steps({states.data(), states.size(), nullptr, 0}, order(), log_tolerance_, &reference, &step);
    if (std::isinf(step))
        for (const Series& c : states)
            step = std::min(step, polynomial_step(c, size_of(c, reference)));
    return step;
}

double StepSize::with_floors(std::span<const Series> states, double previous, std::span<const double> floors) const {
    require_room(floors.size(), states.size(), "floors of series");
    const double tolerance = std::exp2(log_tolerance_);
    double at_last = infinity, at_before = infinity; // powers of the step
    for (std::size_t i = 0; i < states.size(); ++i) {
        const double size = tolerance * std::max(size_of(states[i], previous), floors[i]);
        if (const double last = std::abs(states[i][order_]); !(last <= 0))
            at_last = std::min(at_last, size / last);
        if (const double before = std::abs(states[i][order_ - 1]); !(before <= 0))
            at_before = std::min(at_before, size / before);
    }
    return std::min(std::pow(at_last, 1.0 / static_cast<double>(order_)),
                    std::pow(at_before, 1.0 / static_cast<double>(order_ - 1)));
}

double StepSize::size_of(const Series& c, double reference) const {
    double size = std::abs(c[0]) + reference * (std::abs(c[1]) + reference * std::abs(c[2]));
    if (size == 0)
        for (std::size_t k = order_ + 1; k-- > 0;)
            size = size * reference + std::abs(c[k]);
    return size;
}

double StepSize::radius(std::span<const Series> states) const {
    double radius = std::numeric_limits<double>::infinity();
    for (const Series& c : states) {
        const double last = std::abs(c[order_]), before = std::abs(c[order_ - 1]);
        if (last > 0 && before > 0)
            radius = std::min(radius, before / last);
    }
    return radius;
}

} // namespace graze
