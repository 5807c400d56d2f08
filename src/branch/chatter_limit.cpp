#include "graze/branch/chatter_limit.hpp"

#include "base/concatenated.hpp"
#include "base/special_numbers.hpp"
#include "branch/accumulating_orbit.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace graze {

SelfSimilarContacts self_similar_contacts(double restitution) {
    if (!(restitution > 0 && restitution < 1))
        throw InputError(fmt::format("a restitution of {:.6g} lets no contacts accumulate", restitution),
                         "it must lie between 0 and 1");
    const double e = restitution;
    double rho = std::sqrt(e); // the polynomial is negative at 0 and positive from here on
    constexpr int iterations = 60;
    for (int i = 0; i < iterations; ++i) {
        const double value = rho * rho * (2 + rho) - e * (1 + 2 * rho), slope = 4 * rho + 3 * rho * rho - 2 * e;
        const double step = value / slope;
        rho -= step;
        if (std::abs(step) < std::numeric_limits<double>::epsilon() * rho)
            break;
    }
    return {e, rho, std::pow(rho, 5) / (e * e), (1 - rho) * (2 + rho) / 6};
}

namespace {

struct Extrapolated {
    double value = 0, error = 0;
    double amplified = 1; ///< amplification of independent noise of the sequence
};

/// Richardson extrapolation of a sequence whose error terms decrease by known factors, with an error estimate from the
/// differences of its last values and levels.
Extrapolated extrapolate(std::vector<double> values, std::span<const double> factors) {
    // Estimates the error of the last values from their differences.
    const auto spread = [](const std::vector<double>& row, double factor) {
        double greatest = 0;
        for (std::size_t k = row.size() - std::min<std::size_t>(row.size(), 3); k + 1 < row.size(); ++k)
            greatest = std::max(greatest, std::abs(row[k + 1] - row[k]));
        return greatest / (1 - factor);
    };
    constexpr double safety = 4;
    Extrapolated best{values.back(), std::numeric_limits<double>::infinity(), 1};
    double amplified = 1;
    for (const double factor : factors) {
        if (values.size() < 3)
            break;
        for (std::size_t k = values.size() - 1; k > 0; --k)
            values[k] += (values[k] - values[k - 1]) * factor / (1 - factor);
        values.erase(values.begin());
        const double error = safety * spread(values, factor) + 16 * epsilon * std::abs(values.back());
        amplified *= std::sqrt(1 + factor * factor) / (1 - factor);
        if (error < best.error)
            best = {values.back(), error, amplified};
    }
    return best;
}

void require_ladder(std::span<const SpecialPoint> grazings) {
    if (grazings.size() < 2)
        throw InputError("a ladder of fewer than two grazings has no limit", "go on to the next grazing");
    for (const SpecialPoint& one : grazings)
        if (one.type != PointType::grazing || one.at_end || one.event != grazings.front().event)
            throw InputError("the points of a ladder are not all touches of one event",
                             "give grazings, each with one contact more than the one before");
}

/// Computes the limit from solutions with more and more simulated contacts before the self-similar remainder; each
/// solution starts from the previous one.
class ApproachToLimit {
public:
    explicit ApproachToLimit(AccumulatingOrbit orbit) : orbit_(std::move(orbit)) {}

    /// Tries several initial numbers of contacts: more contacts need a better guess but give a better first solution.
    /// @param state near the state of accumulation
    bool run(double guess, std::size_t contacts, const std::vector<double>& state, ChatterLimit& limit) {
        std::size_t followed = 0;
        for (const std::size_t number : numbers_near(contacts)) {
            if (!orbit_.begin(guess, number, state, limit.problem))
                return false;
            if (!orbit_.solve())
                continue;
            refine(limit);
            followed = std::max(followed, orbit_.contacts_of_solution());
            const auto orbit = limit.direct ? orbit_.orbit_for_output(limit.gap) : std::nullopt;
            if (!orbit)
                continue;
            limit.orbit = *orbit;
            limit.orbit.parameters[orbit_.along().place()] = limit.direct->first;
            return true;
        }
        limit.direct.reset();
        limit.problem = followed == 0
                            ? "no orbit with accumulating contacts was found"
                            : fmt::format("an orbit with accumulating contacts was followed over {} of them before the "
                                          "rest, which is too few to tell the limit",
                                          followed);
        return false;
    }

private:
    static std::vector<std::size_t> numbers_near(std::size_t contacts) {
        std::vector<std::size_t> numbers;
        for (const std::size_t more : {0U, 4U, 8U, 16U, 32U, 64U, 128U})
            numbers.push_back(std::max<std::size_t>(contacts, 4) + more);
        for (std::size_t fewer = numbers.front() - 1; fewer > 1; --fewer)
            numbers.push_back(fewer);
        return numbers;
    }

    /// Adds contacts to a solution as long as the error estimate decreases.
    void refine(ChatterLimit& limit) {
        constexpr std::size_t most_contacts = 80, fewest = 6;
        values_.clear();
        noise_.clear();
        limit.direct.reset();
        std::vector<std::pair<double, double>> estimates;
        double least = std::numeric_limits<double>::infinity();
        while (values_.size() < most_contacts && orbit_.has_solution()) {
            values_.push_back(orbit_.parameter());
            noise_.push_back(orbit_.uncertainty());
            limit.contacts = orbit_.contacts();
            if (values_.size() >= fewest) {
                estimates.push_back(estimate(limit.contacts));
                const auto one = consistent_estimate(estimates);
                if (one.second < least)
                    limit.direct = one;
                least = std::min(least, one.second);
                // From here on round-off dominates.
                if (noise_.back() > least)
                    break;
            }
            orbit_.add_contacts(stride(limit.contacts));
            orbit_.solve();
        }
    }

    /// Returns the last estimate; its error is the largest of the last errors plus the spread of the last estimates,
    /// since a single error may be small by chance.
    static std::pair<double, double> consistent_estimate(const std::vector<std::pair<double, double>>& estimates) {
        constexpr std::size_t compared = 3;
        if (estimates.size() < compared)
            return {estimates.back().first, std::numeric_limits<double>::infinity()};
        double error = 0, low = estimates.back().first, high = low;
        for (std::size_t k = estimates.size() - compared; k < estimates.size(); ++k) {
            error = std::max(error, estimates[k].second);
            low = std::min(low, estimates[k].first);
            high = std::max(high, estimates[k].first);
        }
        return {estimates.back().first, error + (high - low)};
    }

    /// Returns the number of contacts to add: as many as halve the remaining distance, which near a restitution of 1
    /// are many.
    static std::size_t stride(const SelfSimilarContacts& known) {
        constexpr double most = 100;
        const double halving = std::log(0.5) / std::log(known.times * known.ratio);
        return static_cast<std::size_t>(std::clamp(std::round(halving), 1.0, most));
    }

    std::pair<double, double> estimate(const SelfSimilarContacts& one) const {
        const auto more = static_cast<double>(stride(one));
        const SelfSimilarContacts known{one.restitution, std::pow(one.times, more), std::pow(one.ratio, more),
                                        one.speed};
        const double first = known.times * known.ratio;
        const std::array factors{first, first * known.times, first * known.times * known.times};
        const Extrapolated result = extrapolate(values_, factors);
        constexpr std::size_t used = 4; // number of values that enter one extrapolated value
        const auto first_used = noise_.end() - static_cast<std::ptrdiff_t>(std::min(noise_.size(), used));
        return {result.value, result.error + result.amplified * *std::max_element(first_used, noise_.end())};
    }

    AccumulatingOrbit orbit_;
    std::vector<double> values_, noise_; ///< values of the parameter, and their round-off
};

} // namespace

ChatterLimit chatter_limit(const System& system, std::span<const SpecialPoint> grazings, ParameterId along,
                           double tolerance) {
    require_ladder(grazings);
    ChatterLimit limit;
    std::vector<double> values;
    for (const SpecialPoint& one : grazings)
        values.push_back(one.parameter);
    // Aitken extrapolation of the last three grazings, while the ratio is unknown.
    double guess = values.back();
    if (values.size() > 2) {
        const double last = values.back() - values[values.size() - 2],
                     before = values[values.size() - 2] - values[values.size() - 3];
        if (std::abs(last) < std::abs(before))
            guess += last * last / (before - last);
    }
    const auto contacts = grazings.size() - 1;
    const SpecialPoint& last = grazings.back();
    const Orbit& orbit = last.solution.orbit;
    std::vector<double> touch = orbit.starts[last.segment];
    ModeFlow flow(system, tolerance);
    flow.set_parameters(orbit.parameters);
    if (flow.run(orbit.signature[last.segment].mode, touch, last.time) != ModeFlow::Ending::done) {
        limit.problem = "the last grazing cannot be followed";
        return limit;
    }
    ApproachToLimit approach(
        AccumulatingOrbit(system, orbit, orbit.signature[last.segment].mode, last.event, along, tolerance));
    if (!approach.run(guess, contacts, touch, limit))
        return limit;
    const double ratio = limit.contacts.ratio;
    const std::array factors{ratio, ratio * limit.contacts.times, ratio * limit.contacts.times * limit.contacts.times};
    if (values.size() > 3) {
        const Extrapolated result = extrapolate(values, factors);
        limit.extrapolated = {result.value, result.error};
    }
    return limit;
}

ChatterLimit chatter_limit_near(const System& system, const Orbit& known, std::size_t event, ParameterId along,
                                double tolerance) {
    const Model& model = system.model();
    validate_orbit(model, known);
    const auto contact = std::find_if(known.signature.rbegin(), known.signature.rend(), [&](const Segment& one) {
        return ends_by_transition(one) && model.transitions[one.index].event == event;
    });
    if (contact == known.signature.rend())
        throw InputError("the orbit has no contact at this event", "choose the event at which contacts accumulate");
    std::vector<double> state = known.starts.front();
    if (known.symmetry) // the image of the image is the state itself
        state = system.symmetry(*known.symmetry).map(concatenated(state, known.parameters));
    ChatterLimit limit;
    constexpr std::size_t contacts = 8;
    ApproachToLimit(AccumulatingOrbit(system, known, contact->mode, event, along, tolerance))
        .run(known.parameters[along.place()], contacts, state, limit);
    return limit;
}

} // namespace graze
