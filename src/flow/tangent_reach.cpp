#include "graze/flow/tangent_reach.hpp"

#include "graze/flow/step_check.hpp"
#include "graze/symbolic/require.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace graze {

namespace {

/// Share of a step that derivatives are content with before other sizes than their own are asked for.
constexpr double little_shorter = 0.8;

/// Excess of rates over what is allowed from which on floors are worth asking for: so much is what a step of that share
/// would take away.
double worth_floors(int order) {
    double excess = 1;
    for (int k = 0; k < order; ++k)
        excess /= little_shorter;
    return excess;
}

void require_lanes(const Jet& jet, std::size_t states, std::size_t count) {
    require_index(count, static_cast<std::size_t>(jet.width()), "number of derivatives");
    if (states > 0)
        static_cast<void>(jet.state(states - 1)); // which there must be
}

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
    Misfit(const Jet& jet, Jet& next, std::size_t states, std::size_t count, double tolerance, std::span<double> times,
           std::span<double> sums, std::span<double> slopes)
        : jet_(jet), next_(next), states_(states), count_(count), order_(static_cast<std::size_t>(jet.order())),
          width_(static_cast<std::size_t>(jet.width())), tolerance_(tolerance), times_(times), sums_(sums),
          slopes_(slopes) {}

    /// The largest, in units of what is allowed; or, where that is so much that it no longer matters by how much, any.
    double after(double step, double enough = std::numeric_limits<double>::infinity()) {
        evaluate(step);
        return here(step, enough);
    }
    /// The same where what is there has been evaluated.
    double here(double step, double enough = std::numeric_limits<double>::infinity()) const {
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
    void evaluate(double step) {
        std::fill(times_.begin(), times_.end(), step);
        jet_.evaluate_states(times_, sums_, slopes_);
        next_.begin(sums_);
    }
    double difference(std::size_t i, std::size_t l) const {
        return std::abs(slopes_[i * width_ + l + 1] - next_.state(i)[width_ + 1 + l]);
    }

    const Jet& jet_;
    Jet& next_;
    std::size_t states_, count_, order_, width_;
    double tolerance_;
    std::span<double> times_, sums_, slopes_;
    std::span<const double> floors_;
    std::vector<double> noise_; ///< of rates, states x count; none before it is measured
};

double Misfit::compare(double step, double enough) const {
    const double length = std::abs(step);
    const EndAllowance allowed{StepCheck::allowance * tolerance_, 0, StepCheck::smallest_size};
    const std::span<const Series> here = jet_.series(), there = next_.series();
    double most = 0;
    std::size_t i = 0;
    while (most <= enough &&
           (i = jet_.find_tangent_misfit(next_, allowed, states_, count_, length, sums_, slopes_, i)) < states_) {
        const double *c = here[i].first, *rates = there[i].first + width_;
        const double *ends = &sums_[i * width_], *slopes = &slopes_[i * width_];
        for (std::size_t l = 1; l <= count_; ++l) {
            const double apart = length * std::abs(slopes[l] - rates[l]),
                         size = StepCheck::size_over(c[l], c[width_ + l], ends[l], rates[l], length);
            if (!(apart <= allowed.rates * size))
                most = std::max(most, excess(i, l, apart, size, length));
        }
        ++i;
    }
    return most;
}

/// A difference in units of what is allowed, where it exceeds what the ends of the step allow. @param lane of the jet
double Misfit::excess(std::size_t i, std::size_t lane, double apart, double size, double length) const {
    if (!floors_.empty()) {
        size = std::max(size, floors_[i * width_ + lane]);
        if (apart <= StepCheck::allowance * tolerance_ * size)
            return 0;
    }
    size = std::max(size, size_of_all(jet_.series()[i].first + lane, width_, order_, length));
    const double noise = noise_.empty() ? 0 : length * noise_[i * count_ + lane - 1],
                 ratio = apart / ((StepCheck::allowance * tolerance_ + TangentCheck::round_off) * size + noise);
    return std::isnan(ratio) ? std::numeric_limits<double>::infinity() : ratio;
}

/// Next to the start polynomials are exact, so that what is between slopes and rates there is round-off: of terms that
/// cancel, such as those of a coupling that a symmetry makes zero, beside which nothing shows how large they are.
void Misfit::measure_noise(double step, std::span<const double> known) {
    constexpr double near = 0x1p-24, spread = 100; // what is random is small now and then
    noise_.assign(states_ * count_, 0.0);
    for (std::size_t i = 0; i < states_ && !known.empty(); ++i)
        std::copy_n(&known[i * width_ + 1], count_, &noise_[i * count_]);
    for (const double share : {near, 1.7 * near, 3.1 * near}) {
        evaluate(share * step);
        for (std::size_t i = 0; i < states_; ++i)
            for (std::size_t l = 0; l < count_; ++l)
                if (const double noise = spread * difference(i, l); std::isfinite(noise))
                    noise_[i * count_ + l] = std::max(noise_[i * count_ + l], noise);
    }
}

} // namespace

double tangent_reach(const Jet& jet, std::size_t states, std::size_t count, double tolerance, double step,
                     const TangentFloors& floors) {
    require_lanes(jet, states, count);
    const double root = 1.0 / (jet.order() - 1);
    double reach = step, worst = jet.tangent_tails(states, count, reach, {});
    if (!(worst > tolerance))
        return step;
    // Sizes shrink with the step: a few rounds, each of which aims at a little less than what is allowed.
    constexpr double aim = 0.98;
    const auto shorten = [&](std::span<const double> least, double shortest) {
        for (int round = 0; round < 6 && worst > tolerance; ++round) {
            reach *= std::pow(aim * tolerance / worst, root);
            if (reach < shortest)
                return;
            worst = jet.tangent_tails(states, count, reach, least);
        }
    };
    shorten({}, floors ? little_shorter * step : 0); // below, other sizes decide
    if (floors && !(reach >= little_shorter * step)) {
        const std::span<const double> least = floors();
        require_room(least.size(), states * static_cast<std::size_t>(jet.width()), "floors of derivatives");
        reach = step;
        worst = jet.tangent_tails(states, count, reach, least);
        shorten(least, 0);
    }
    return std::isfinite(reach) && reach > 0 ? reach : step;
}

double follow_tangents(const Jet& jet, Jet& next, std::size_t states, std::size_t count, double tolerance, double step,
                       std::span<double> times, std::span<double> sums, std::span<double> slopes,
                       const TangentFloors& floors, const TangentFloors& noise, bool seen) {
    require_lanes(jet, states, count);
    require_room(times.size(), static_cast<std::size_t>(jet.width()), "times");
    constexpr int most_halvings = TangentCheck::most_halvings;
    Misfit misfit(jet, next, states, count, tolerance, times, sums, slopes);
    const double much = floors ? worth_floors(jet.order()) : std::numeric_limits<double>::infinity();
    const double most = seen ? misfit.here(step, much) : misfit.after(step, much);
    if (most <= 1)
        return step;
    if (floors && most > much) {
        const std::span<const double> least = floors();
        require_room(least.size(), states * static_cast<std::size_t>(jet.width()), "floors of derivatives");
        if (misfit.above(least, step) <= 1)
            return step;
    }
    const std::span<const double> known = noise ? noise() : std::span<const double>{};
    if (noise)
        require_room(known.size(), states * static_cast<std::size_t>(jet.width()), "round-off of rates");
    misfit.measure_noise(step, known);
    double part = step, first = 0;
    for (int halving = 0; halving <= most_halvings; ++halving, part *= 0.5) {
        const double here = misfit.after(part);
        if (here <= 1)
            return part;
        if (halving == 0)
            first = here;
        else if (halving == most_halvings && std::isfinite(here) && here > TangentCheck::least_gain * first)
            break;
        else if (halving == most_halvings)
            return part;
    }
    misfit.after(step);
    return step;
}

} // namespace graze
