#include "sweep/quasi_periodic.hpp"

#include "base/special_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace graze {

namespace {

constexpr std::size_t fewest_returns_on_torus = 200;
constexpr double least_extent_at_returns =
    1e-3; ///< least extent at returns relative to that of the motion; smaller: at rest
/// Distance from an earlier return, relative to the extent at returns, below which a recurrence is examined.
constexpr double back = 1e-4;
/// Factor by which the distance from an earlier return shrinks if the motion approaches a long orbit.
constexpr double shrinking_ratio = 0.9;
/// Distance at which the motion has arrived at the orbit.
constexpr double arrived_distance = 1e-9;
constexpr std::size_t fewest_back = 8; ///< fewest returns that show a period longer than half of the observation

/// Returns the values of a state at all returns.
std::vector<double> values_of(const VisitedStates& visited, std::size_t state) {
    std::vector<double> values;
    for (std::size_t k = 0; k < visited.returns(); ++k)
        values.push_back(visited.values[k * visited.periods.size() + state]);
    return values;
}

/// Returns functions of the states whose averages are compared: for each, one number for each return.
std::vector<std::vector<double>> observables(const VisitedStates& visited, std::span<const double> extents,
                                             bool& moving) {
    const std::size_t states = visited.periods.size(), returns = visited.returns();
    std::vector<std::vector<double>> all, coordinates;
    for (std::size_t i = 0; i < states; ++i) {
        const std::vector<double> values = values_of(visited, i);
        if (visited.periods[i] > 0) {
            for (int harmonic = 1; harmonic <= 2; ++harmonic) {
                std::vector<double> cosine(returns), sine(returns);
                for (std::size_t k = 0; k < returns; ++k) {
                    const double angle = harmonic * 2 * std::numbers::pi * values[k] / visited.periods[i];
                    cosine[k] = std::cos(angle);
                    sine[k] = std::sin(angle);
                }
                const auto [low, high] = std::ranges::minmax_element(sine);
                moving = moving || *high - *low > least_extent_at_returns;
                all.push_back(std::move(cosine));
                all.push_back(std::move(sine));
            }
            continue;
        }
        const auto [low, high] = std::ranges::minmax(values);
        if (!(high - low > least_extent_at_returns * extents[i]))
            continue;
        moving = true;
        std::vector<double> coordinate(returns);
        for (std::size_t k = 0; k < returns; ++k)
            coordinate[k] = (2 * values[k] - low - high) / (high - low);
        coordinates.push_back(std::move(coordinate));
    }
    // Squares and products distinguish a spiral that contracts from a closed curve.
    for (std::size_t i = 0; i < coordinates.size(); ++i)
        for (std::size_t j = i; j < std::min(coordinates.size(), i + 2); ++j) {
            std::vector<double> product(returns);
            for (std::size_t k = 0; k < returns; ++k)
                product[k] = coordinates[i][k] * coordinates[j][k];
            all.push_back(std::move(product));
        }
    all.insert(all.end(), coordinates.begin(), coordinates.end());
    return all;
}

/// Returns whether the extent of a state differs between the halves of the returns by so much that the motion grows or
/// shrinks: averages of exponential growth are even, since all values except the last ones are small.
bool changes_size(const VisitedStates& visited) {
    constexpr double most = 3;
    const std::size_t half = visited.returns() / 2;
    for (std::size_t i = 0; i < visited.periods.size(); ++i) {
        if (visited.periods[i] > 0)
            continue;
        const std::vector<double> values = values_of(visited, i);
        const auto range = [](std::span<const double> part) {
            const auto [low, high] = std::ranges::minmax(part);
            return high - low;
        };
        const double older = range(std::span(values).first(half)), newer = range(std::span(values).last(half));
        if (!(newer <= most * older && older <= most * newer))
            return true;
    }
    return false;
}

/// Averages of quasi-periodic motions converge faster than any power of time if the weights vanish smoothly at the
/// ends.
double weighted_average(std::span<const double> values) {
    double sum = 0, weights = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(values.size());
        const double weight = std::exp(-1 / (t * (1 - t)));
        sum += weight * values[k];
        weights += weight;
    }
    return sum / weights;
}

/// Returns the largest distance of two returns in any state, relative to its extent.
double distance_of_returns(const VisitedStates& visited, std::span<const double> extents, std::size_t a,
                           std::size_t b) {
    const std::size_t states = visited.periods.size();
    double largest = 0;
    for (std::size_t i = 0; i < states; ++i) {
        double difference = std::abs(visited.values[a * states + i] - visited.values[b * states + i]);
        if (visited.periods[i] > 0)
            difference = std::min(difference, visited.periods[i] - difference);
        const double scale = visited.periods[i] > 0 ? visited.periods[i] : extents[i];
        largest = std::max(largest, scale > 0 ? difference / scale : 0);
    }
    return largest;
}

/// Returns whether the motion has returned to an earlier state, or comes closer to it each time: its period is only
/// longer than those searched.
bool comes_back(const VisitedStates& visited, std::span<const double> extents) {
    const std::size_t last = visited.returns() - 1;
    for (std::size_t lag = 1; lag <= last / 2; ++lag) {
        const double now = distance_of_returns(visited, extents, last, last - lag);
        if (now > back)
            continue;
        double newer = 0, older = 0;
        for (std::size_t k = 0; k < lag && k < last / 2; ++k) {
            newer = std::max(newer, distance_of_returns(visited, extents, last - k, last - k - lag));
            older = std::max(older, distance_of_returns(visited, extents, lag + k, k));
        }
        if (newer < arrived_distance || newer < shrinking_ratio * older)
            return true;
    }
    // Periods beyond half of the returns are observed only in part: all observed returns must agree.
    for (std::size_t lag = last / 2 + 1; lag + fewest_back <= last; ++lag) {
        double largest = 0;
        for (std::size_t k = lag; k <= last && largest < arrived_distance; ++k)
            largest = std::max(largest, distance_of_returns(visited, extents, k, k - lag));
        if (largest < arrived_distance)
            return true;
    }
    return false;
}

/// Returns the smallest distance between returns with a common lag of few returns. Chaos in narrow bands has averages
/// as even as these bands are narrow.
double closest_lag(const VisitedStates& visited, std::span<const double> extents) {
    constexpr std::size_t most = 96;
    double closest = std::numeric_limits<double>::infinity();
    for (std::size_t lag = 1; lag <= most && lag < visited.returns(); ++lag) {
        double square = 0;
        for (std::size_t k = lag; k < visited.returns(); ++k)
            square += std::pow(distance_of_returns(visited, extents, k, k - lag), 2);
        closest = std::min(closest, std::sqrt(square / static_cast<double>(visited.returns() - lag)));
    }
    return closest;
}

} // namespace

double unevenness(const VisitedStates& visited, std::span<const double> extents) {
    if (visited.returns() < fewest_returns_on_torus || changes_size(visited))
        return infinity;
    bool moving = false;
    double largest = 0;
    for (const std::vector<double>& values : observables(visited, extents, moving)) {
        const std::span<const double> all(values);
        const std::size_t half = all.size() / 2;
        largest = std::max(largest, std::abs(weighted_average(all.first(half)) - weighted_average(all.last(half))));
    }
    const double closest = closest_lag(visited, extents);
    return moving && closest > 0 && !comes_back(visited, extents) ? largest / closest : infinity;
}

} // namespace graze
