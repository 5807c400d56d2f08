#include "graze/design/value_map.hpp"

#include "base/thread_team.hpp"
#include "base/turns.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>

namespace graze {

namespace {

double spread_over(double least, double greatest, std::size_t i, std::size_t points) {
    return i + 1 == points ? greatest
                           : least + (greatest - least) * (static_cast<double>(i) / static_cast<double>(points - 1));
}

LocatedValueOptions with_map(LocatedValueOptions options) {
    options.map = true;
    return options;
}

MappedValue mapped(const TripPoint& trip, LocatedValue& located, std::span<const double> values) {
    MappedValue result;
    result.x = values[0];
    result.y = values.size() > 1 ? values[1] : 0;
    const LocatedSolution solution = located(values);
    result.found = solution.found;
    result.problem = solution.problem;
    if (!solution.found)
        return result;
    result.value = solution.value;
    result.admissible = solution.admissible;
    if (solution.map)
        result.outcome = verdict_of(*solution.map).outcome;
    else if (solution.admissible)
        result.outcome = class_at(moved_to(trip, solution.orbit)).outcome;
    return result;
}

/// Side of a tile, in points: the points of a tile are solved for from the device in its middle, so that the path from
/// the trip point to it is computed only once.
constexpr std::size_t tile = 8;

/// Finds the device in the middle of a tile, and a solver that starts there.
void begin_tile(const TripPoint& trip, LocatedValue& located, std::span<const double> values,
                const MapSettings& settings, std::optional<TripPoint>& middle, std::optional<LocatedValue>& near) {
    const LocatedSolution solution = located(values);
    if (!solution.found || !solution.admissible)
        return;
    middle = moved_to(trip, solution.orbit);
    try {
        near.emplace(middle->system, middle->point, middle->control, located.others(), with_map(settings.solver));
    } catch (const InputError&) { // the trip value is not determined there
        middle.reset();
    }
}

/// Runs numbered pieces of work on threads, each with a solver of its own.
class MapWork {
public:
    MapWork(const TripPoint& trip, std::vector<ParameterId> others, const MapSettings& settings)
        : trip_(&trip), others_(std::move(others)), settings_(&settings) {}

    template <class Work>
    void each(std::size_t count, const Work& work) {
        constexpr std::size_t enough = 8; // pieces for which a thread is worth its start
        const std::size_t jobs = std::clamp<std::size_t>(count / enough, 1, static_cast<std::size_t>(settings_->jobs));
        team_.run(jobs, [&](bool calling) {
            LocatedValue located(trip_->system, trip_->point, trip_->control, others_, with_map(settings_->solver));
            for (std::size_t i; !team_.is_stopped() && (i = next_++) < count;) {
                if (interrupted_ && interrupted_())
                    return team_.stop();
                work(located, i);
                const std::size_t done = ++done_;
                if (calling && progress_)
                    progress_(done);
            }
        });
    }
    bool stopped() const { return team_.is_stopped(); }

private:
    const TripPoint* trip_;
    std::vector<ParameterId> others_;
    const MapSettings* settings_;
    std::atomic<std::size_t> next_{0}, done_{0};
    Turns turns_;
    std::function<bool()> interrupted_ = turns_.asking(settings_->interrupted);
    std::function<void(std::size_t)> progress_ = turns_.taking(settings_->progress);
    ThreadTeam team_;
};

/// Finds the limits of tuning from the nominal position outwards: a missing solution, or the end of the range.
void set_axis_limits(Tuning& tuning, const DesignDimension& stop, std::size_t nominal) {
    const auto problem_at = [&](const TuningPoint& point) -> std::string {
        if (!point.found || !point.admissible)
            return point.problem.empty() ? "the model would not come there" : point.problem;
        // The ends themselves are found again up to round-off.
        const double rounding = 1e-9 * (stop.greatest - stop.least);
        const bool beyond = point.position < stop.least - rounding || point.position > stop.greatest + rounding;
        return beyond ? "the stop's range ends" : "";
    };
    const auto reach = [&](std::ptrdiff_t way, std::string& ends) {
        ends = "the stop's range ends";
        auto at = tuning.points.begin() + static_cast<std::ptrdiff_t>(nominal);
        for (const auto last = way < 0 ? tuning.points.begin() : tuning.points.end() - 1; at != last; at += way)
            if (const std::string problem = problem_at(at[way]); !problem.empty()) {
                ends = problem;
                break;
            }
        return at->value;
    };
    tuning.least = reach(-1, tuning.ends_below);
    tuning.greatest = reach(1, tuning.ends_above);
}

} // namespace

void MapSettings::validate() const {
    constexpr std::size_t most = 10'000;
    if (points < 2 || points > most)
        throw InputError(fmt::format("{} points are out of range", points), fmt::format("choose from 2 to {}", most));
    if (jobs < 1)
        throw InputError(fmt::format("{} jobs are out of range", jobs), "give at least one");
    solver.validate();
}

std::vector<MappedValue> value_curve(const TripPoint& trip, const DesignDimension& dimension,
                                     const MapSettings& settings) {
    settings.validate();
    std::vector<MappedValue> result(settings.points);
    MapWork work(trip, {dimension.parameter}, settings);
    work.each(settings.points, [&](LocatedValue& located, std::size_t i) {
        const double value[] = {spread_over(dimension.least, dimension.greatest, i, settings.points)};
        result[i] = mapped(trip, located, value);
    });
    if (work.stopped())
        result.clear();
    return result;
}

std::vector<MappedValue> value_plane(const TripPoint& trip, const DesignDimension& across, const DesignDimension& up,
                                     const MapSettings& settings) {
    settings.validate();
    const std::size_t points = settings.points, tiles = (points + tile - 1) / tile;
    std::vector<MappedValue> result(points * points);
    const std::vector<ParameterId> others{across.parameter, up.parameter};
    const auto values_at = [&](std::size_t i, std::size_t j) {
        return std::array{spread_over(across.least, across.greatest, i, points),
                          spread_over(up.least, up.greatest, j, points)};
    };
    MapWork work(trip, others, settings);
    work.each(tiles * tiles, [&](LocatedValue& located, std::size_t t) {
        const std::size_t left = t % tiles * tile, low = t / tiles * tile;
        const std::size_t right = std::min(points, left + tile), high = std::min(points, low + tile);
        std::optional<TripPoint> middle;
        std::optional<LocatedValue> near;
        if (tiles > 1)
            begin_tile(trip, located, values_at((left + right) / 2, (low + high) / 2), settings, middle, near);
        for (std::size_t j = low; j < high; ++j)
            for (std::size_t i = left; i < right; ++i) {
                MappedValue& one = result[j * points + i];
                const auto values = values_at(i, j);
                if (near)
                    one = mapped(*middle, *near, values);
                if (!one.found) // from the trip point the reason of a failure is more specific
                    one = mapped(trip, located, values);
            }
    });
    if (work.stopped())
        result.clear();
    return result;
}

Tuning tuning_curve(const TripPoint& trip, const DesignDimension& stop, const MapSettings& settings) {
    settings.validate();
    Tuning tuning;
    // Trip values between those at the ends of the stop's range, or at the last admissible devices.
    double least = trip.value(), greatest = trip.value();
    for (const MappedValue& one : value_curve(trip, stop, settings))
        if (one.found && one.admissible) {
            least = std::min(least, one.value);
            greatest = std::max(greatest, one.value);
        }
    LocatedValue located(trip.system, trip.point, stop.parameter, {trip.control}, settings.solver);
    if (!(least < greatest))
        throw InputError(fmt::format("the trip value does not depend on '{}'", stop.name), "adjust another dimension");
    std::size_t nominal = 0;
    for (std::size_t i = 0; i < settings.points; ++i) {
        TuningPoint& point = tuning.points.emplace_back();
        point.value = spread_over(least, greatest, i, settings.points);
        if (std::abs(point.value - trip.value()) < std::abs(tuning.points[nominal].value - trip.value()))
            nominal = i;
        const double wanted[] = {point.value};
        const LocatedSolution solution = located(wanted);
        point.found = solution.found;
        point.admissible = solution.admissible;
        point.problem = solution.problem;
        if (solution.found)
            point.position = solution.value;
    }
    set_axis_limits(tuning, stop, nominal);
    return tuning;
}

} // namespace graze
