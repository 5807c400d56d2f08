#include "flow/tangent_reach.hpp"

#include "graze/base/require.hpp"
#include "graze/flow/step_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace graze {

namespace {

/// Share of a step that derivatives are content with before other sizes than their own are asked for.
constexpr double little_shorter = 0.8;

/// Excess of rates over what is allowed from which on floors are worth asking for, for each order: so much is what a
/// step of that share would take away.
struct FloorsWorth {
    double of[highest_order + 1] = {1};
    constexpr FloorsWorth() {
        for (int k = 1; k <= highest_order; ++k)
            of[k] = of[k - 1] / little_shorter;
    }
};
constexpr FloorsWorth floors_worth;

/// Size of a series whose first three terms are zero.
double size_of_all(const double* c, std::size_t width, std::size_t order, double step) {
    double sum = 0;
    for (std::size_t k = order + 1; k-- > 0;)
        sum = sum * step + std::abs(c[k * width]);
    return sum;
}

/// Differences between the slopes of derivatives' polynomials and what the variational equations say, after part of a
/// step.
class Misfit {
public:
    Misfit(const TangentPlaces& places, double tolerance)
        : places_(places), order_(static_cast<std::size_t>(places.here.order())), width_(places.here.width()),
          tolerance_(tolerance) {}

    /// The largest, in units of what is allowed; or, where that is so much that it no longer matters by how much, any.
    double after(double step, double enough = std::numeric_limits<double>::infinity()) {
        places_.look(step);
        return compare(step, enough);
    }
    /// The same as before, where floors allow more.
    double above(std::span<const double> floors, double step) {
        floors_ = floors;
        return compare(step, std::numeric_limits<double>::infinity());
    }
    /// From now on differences are allowed that there are for no other reason than round-off.
    /// @param known what of it is known, or none
    void measure_noise(double step, std::span<const double> known);

private:
    double compare(double step, double enough) const;
    double excess(std::size_t i, std::size_t lane, double apart, double size, double length) const;
    double difference(std::size_t i, std::size_t l) const {
        return std::abs(places_.slopes[i * width_ + l] - places_.there.state(i)[width_ + l]);
    }

    const TangentPlaces& places_;
    std::size_t order_, width_;
    double tolerance_;
    std::span<const double> floors_;
    std::vector<double> noise_; ///< of rates, states x count; none before it is measured
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

/// A difference in units of what is allowed, where it exceeds what the ends of the step allow.
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

/// Next to the start polynomials are exact, so that what is between slopes and rates there is round-off: of terms that
/// cancel, such as those of a coupling that a symmetry makes zero, beside which nothing shows how large they are.
void Misfit::measure_noise(double step, std::span<const double> known) {
    constexpr double near = 0x1p-24, spread = 100; // what is random is small now and then
    const std::size_t count = places_.count;
    noise_.assign(places_.states * count, 0.0);
    for (std::size_t i = 0; i < places_.states && !known.empty(); ++i)
        std::copy_n(&known[i * width_], count, &noise_[i * count]);
    for (const double share : {near, 1.7 * near, 3.1 * near}) {
        places_.look(share * step);
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
    // Sizes shrink with the step: a few rounds, each of which aims at a little less than what is allowed.
    constexpr double aim = 0.98;
    const auto shorten = [&](std::span<const double> least, double shortest) {
        for (int round = 0; round < 6 && worst > tolerance; ++round) {
            reach *= std::pow(aim * tolerance / worst, root);
            if (reach < shortest)
                return;
            worst = series.tails(reach, least);
        }
    };
    shorten({}, little_shorter * step); // below, other sizes decide
    if (!(reach >= little_shorter * step)) {
        const std::span<const double> least = floors();
        reach = step;
        worst = series.tails(reach, least);
        shorten(least, 0);
    }
    return std::isfinite(reach) && reach > 0 ? reach : step;
}

double follow_tangents(const TangentPlaces& places, double tolerance, double step, const TangentFloors& floors,
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
