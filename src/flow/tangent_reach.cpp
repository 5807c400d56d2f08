#include "flow/tangent_reach.hpp"

#include "graze/flow/step_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace graze {

namespace {

/// Derivatives may shorten a step to this fraction before other sizes than their own are used.
constexpr double little_shorter = 0.8;

/// Excess of rates above which floors are worth computing, for each order: a step shortened to `little_shorter` removes
/// as much.
struct FloorsWorth {
    double of[highest_order + 1] = {1};
    constexpr FloorsWorth() {
        for (int k = 1; k <= highest_order; ++k)
            of[k] = of[k - 1] / little_shorter;
    }
};
constexpr FloorsWorth floors_worth;

/// Returns the size of a series whose first three terms are zero.
double size_of_all(const double* c, std::size_t width, std::size_t order, double step) {
    double sum = 0;
    for (std::size_t k = order + 1; k-- > 0;)
        sum = sum * step + std::abs(c[k * width]);
    return sum;
}

/// Differences between the slopes of derivatives' polynomials and the variational equations at the end of a part of the
/// step.
class Misfit {
public:
    Misfit(const TangentEndpoints& places, double tolerance)
        : places_(places), order_(static_cast<std::size_t>(places.here.order())), width_(places.here.width()),
          tolerance_(tolerance) {}

    /// Returns the largest difference, in units of the allowance; stops early at any difference above `enough`.
    double after(double step, double enough = std::numeric_limits<double>::infinity()) {
        places_.evaluate_at(step);
        return compare(step, enough);
    }
    /// The same at the current end, with floors.
    double above(std::span<const double> floors, double step) {
        floors_ = floors;
        return compare(step, std::numeric_limits<double>::infinity());
    }
    /// Allows from now on differences that are due to round-off.
    /// @param known a bound of the round-off, or empty
    void measure_noise(double step, std::span<const double> known);

private:
    double compare(double step, double enough) const;
    double excess(std::size_t i, std::size_t lane, double apart, double size, double length) const;
    double difference(std::size_t i, std::size_t l) const {
        return std::abs(places_.slopes[i * width_ + l] - places_.there.state(i)[width_ + l]);
    }

    const TangentEndpoints& places_;
    std::size_t order_, width_;
    double tolerance_;
    std::span<const double> floors_;
    std::vector<double> noise_; ///< round-off of rates, states x count; empty before it is measured
};

double Misfit::compare(double step, double enough) const {
    const double length = std::abs(step);
    const EndAllowance allowed{StepCheck::allowance * tolerance_, 0, StepCheck::smallest_size};
    double most = 0;
    std::size_t i = 0;
    while (most <= enough && (i = places_.here.find_misfit(places_.there, allowed, length, places_.sums, places_.slopes,
                                                           i)) < places_.states) {
        const double *c = places_.here.state(i), *rates = places_.there.state(i) + width_;
        const double *ends = &places_.sums[i * width_], *slopes = &places_.slopes[i * width_];
        for (std::size_t l = 0; l < places_.count; ++l) {
            const double apart = length * std::abs(slopes[l] - rates[l]),
                         size = StepCheck::size_over(c[l], c[width_ + l], ends[l], rates[l], length);
            if (!(apart <= allowed.rates * size))
                most = std::max(most, excess(i, l, apart, size, length));
        }
        ++i;
    }
    return most;
}

/// Returns a difference in units of the allowance, if it exceeds what the sizes at the ends allow.
double Misfit::excess(std::size_t i, std::size_t lane, double apart, double size, double length) const {
    if (!floors_.empty()) {
        size = std::max(size, floors_[i * width_ + lane]);
        if (apart <= StepCheck::allowance * tolerance_ * size)
            return 0;
    }
    size = std::max(size, size_of_all(places_.here.state(i) + lane, width_, order_, length));
    const double noise = noise_.empty() ? 0 : length * noise_[i * places_.count + lane],
                 ratio = apart / ((StepCheck::allowance * tolerance_ + TangentCheck::round_off) * size + noise);
    return std::isnan(ratio) ? std::numeric_limits<double>::infinity() : ratio;
}

/// Close to the start the polynomials are exact, so differences between slopes and rates there are round-off of
/// cancelling terms, such as those of a coupling that a symmetry makes zero; the results do not show the size of these
/// terms.
void Misfit::measure_noise(double step, std::span<const double> known) {
    constexpr double near = 0x1p-24, spread = 100; // a random sample may be small by chance
    const std::size_t count = places_.count;
    noise_.assign(places_.states * count, 0.0);
    for (std::size_t i = 0; i < places_.states && !known.empty(); ++i)
        std::copy_n(&known[i * width_], count, &noise_[i * count]);
    for (const double share : {near, 1.7 * near, 3.1 * near}) {
        places_.evaluate_at(share * step);
        for (std::size_t i = 0; i < places_.states; ++i)
            for (std::size_t l = 0; l < count; ++l)
                if (const double noise = spread * difference(i, l); std::isfinite(noise))
                    noise_[i * count + l] = std::max(noise_[i * count + l], noise);
    }
}

} // namespace

double tangent_reach(const TangentSeries& series, double tolerance, double step, const TangentFloors& floors) {
    double reach = step, worst = series.tails(reach, {});
    if (!(worst > tolerance))
        return step;
    const double root = 1.0 / (series.order() - 1);
    // Sizes shrink with the step: iterate a few times, aiming slightly below the allowance.
    constexpr double aim = 0.98;
    const auto shorten = [&](std::span<const double> least, double shortest) {
        for (int round = 0; round < 6 && worst > tolerance; ++round) {
            reach *= std::pow(aim * tolerance / worst, root);
            if (reach < shortest)
                return;
            worst = series.tails(reach, least);
        }
    };
    shorten({}, little_shorter * step); // below this, other sizes are used
    if (!(reach >= little_shorter * step)) {
        const std::span<const double> least = floors();
        reach = step;
        worst = series.tails(reach, least);
        shorten(least, 0);
    }
    return std::isfinite(reach) && reach > 0 ? reach : step;
}

double follow_tangents(const TangentEndpoints& places, double tolerance, double step, const TangentFloors& floors,
                       const TangentFloors& noise) {
    constexpr int most_halvings = TangentCheck::most_halvings;
    Misfit misfit(places, tolerance);
    const double much = floors_worth.of[places.here.order()];
    const double most = misfit.after(step, much);
    if (most <= 1 || (most > much && misfit.above(floors(), step) <= 1))
        return step;
    misfit.measure_noise(step, noise());
    double part = step, first = 0;
    for (int halving = 0; halving <= most_halvings; ++halving, part *= 0.5) {
        const double here = misfit.after(part);
        if (here <= 1)
            return part;
        if (halving == most_halvings && !std::isfinite(here))
            return std::numeric_limits<double>::quiet_NaN();
        if (halving == 0)
            first = here;
        else if (halving == most_halvings && here > TangentCheck::least_gain * first)
            break;
        else if (halving == most_halvings)
            return part;
    }
    misfit.after(step);
    return step;
}

} // namespace graze
