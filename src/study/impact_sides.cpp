#include "study/impact_sides.hpp"

#include "record/local_polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

namespace graze {

namespace {

constexpr std::size_t rows_of_side = 5; ///< few enough to follow a curve, enough not to amplify noise much

/// Times and rows between two impacts that are nearest to one of them.
using NearRows = std::deque<std::pair<double, std::vector<double>>>;

std::vector<double> continued(const NearRows& near, std::size_t first, std::size_t last, double time) {
    if (first >= last)
        return {};
    std::vector<double> places, samples(last - first);
    for (std::size_t i = first; i < last; ++i)
        places.push_back(near[i].first - time);
    const double scale = std::max(std::abs(places.front()), std::abs(places.back()));
    for (double& place : places)
        place /= scale;
    const LocalPolynomial parabola(places, std::min<std::size_t>(2, places.size() - 1));
    std::vector<double> values(near[first].second.size(), 0);
    for (std::size_t c = 0; c < values.size(); ++c) {
        for (std::size_t i = first; i < last; ++i)
            samples[i - first] = near[i].second[c];
        for (std::size_t k = 0; k <= parabola.degree(); ++k)
            values[c] += parabola.coefficient(k, samples.data()) * parabola.at_zero(k);
    }
    return values;
}

/// The rows between two impacts; only those near its ends are kept.
struct Stretch {
    NearRows head, tail;
};

std::vector<double> at_end(const Stretch& stretch, std::size_t transition, double time) {
    const std::size_t count = stretch.tail.size(), last = count > transition ? count - transition : 0;
    return continued(stretch.tail, last > rows_of_side ? last - rows_of_side : 0, last, time);
}

std::vector<double> at_begin(const Stretch& stretch, std::size_t transition, double time) {
    const std::size_t count = stretch.head.size();
    return continued(stretch.head, transition, std::min(count, transition + rows_of_side), time);
}

} // namespace

std::vector<ImpactSides> impact_sides(SampleSource& record, const std::vector<RecordedImpact>& impacts,
                                      std::size_t transition) {
    std::vector<Stretch> stretches(impacts.size() + 1);
    std::size_t next = 0; // stretch, and the impact at its end
    Samples samples;
    double before = 0, spacing = 0;
    std::vector<double> row;
    while (record.read(samples))
        for (std::size_t i = 0; i < samples.rows(); ++i) {
            const double time = samples.times[i];
            spacing = spacing > 0 || i == 0 ? spacing : time - before;
            before = time;
            while (next < impacts.size() && time >= impacts[next].time)
                ++next;
            const auto unsure = [&](std::size_t impact) {
                // Twice the error of the time, but less than to the rows on both sides of an impact without
                // displacement.
                const double margin = std::min(2 * impacts[impact].time_error, 0.4 * spacing) + 1e-6 * spacing;
                return std::abs(time - impacts[impact].time) <= margin;
            };
            if ((next < impacts.size() && unsure(next)) || (next > 0 && unsure(next - 1)))
                continue;
            row.clear();
            for (const std::vector<double>& values : samples.values)
                row.push_back(values[i]);
            Stretch& stretch = stretches[next];
            if (next > 0 && stretch.head.size() < transition + rows_of_side)
                stretch.head.emplace_back(time, row);
            stretch.tail.emplace_back(time, row);
            if (stretch.tail.size() > transition + rows_of_side)
                stretch.tail.pop_front();
        }
    std::vector<ImpactSides> result;
    for (std::size_t k = 0; k < impacts.size(); ++k) {
        ImpactSides sides{k, at_end(stretches[k], transition, impacts[k].time),
                          at_begin(stretches[k + 1], transition, impacts[k].time)};
        if (sides.before.empty())
            sides.before = sides.after;
        if (sides.after.empty())
            sides.after = sides.before;
        if (!sides.before.empty())
            result.push_back(std::move(sides));
    }
    return result;
}

} // namespace graze
