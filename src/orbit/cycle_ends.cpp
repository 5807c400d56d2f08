#include "orbit/cycle_ends.hpp"

#include "base/decompositions.hpp"
#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

/// The first or the last turn of an orbit beside its cycle, as a guess of the cycle.
Orbit turn_of(const Orbit& orbit, bool last) {
    const auto count = static_cast<std::ptrdiff_t>(orbit.cycle.value()),
               first = last ? static_cast<std::ptrdiff_t>(orbit.segments()) - count : 0;
    Orbit turn;
    turn.parameters = orbit.parameters;
    turn.signature.assign(orbit.signature.begin() + first, orbit.signature.begin() + first + count);
    turn.starts.assign(orbit.starts.begin() + first, orbit.starts.begin() + first + count);
    turn.durations.assign(orbit.durations.begin() + first, orbit.durations.begin() + first + count);
    return turn;
}

} // namespace

CycleEnds::CycleEnds(const Simulation& simulation, const Orbit& orbit, std::vector<ParameterId> free)
    : free_(std::move(free)), cycle_(simulation, turn_of(orbit, false), free_) {
    find_cycle(simulation, orbit);
}

/// Finds the cycle from the turn beside it that leads to it.
void CycleEnds::find_cycle(const Simulation& simulation, const Orbit& orbit) {
    constexpr double near = 0.3; // in units of the scales
    const auto is_near = [&](const SaddleCycle& cycle) {
        return cycle.length_of(cycle.from_cycle(orbit.starts.front())) < near;
    };
    const bool found = cycle_.follow(orbit.parameters);
    if (found && is_near(cycle_))
        return;
    SaddleCycle other(simulation, turn_of(orbit, true), free_);
    if (other.follow(orbit.parameters) && (!found || is_near(other)))
        cycle_ = std::move(other);
    else if (!found)
        problem_ = cycle_.problem();
}

void CycleEnds::set_scales(const Eigen::VectorXd& scales) {
    if (!problem_.empty())
        return;
    cycle_.set_scales(scales);
    reference_ = cycle_.unstable_direction().cwiseQuotient(scales).normalized();
    across_ = orthogonal_complement(reference_).transpose();
}

bool CycleEnds::set_parameters(std::span<const double> parameters) {
    if (reference_.size() > 0)
        problem_ = cycle_.follow(parameters) ? "" : cycle_.problem();
    return problem_.empty();
}

/// Rows that vanish along the unstable direction, with a smooth dependence on it; zero in the last row.
Eigen::MatrixXd CycleEnds::by_begin() const {
    const Eigen::VectorXd& scales = cycle_.scales();
    const Eigen::Index n = scales.size();
    const Eigen::VectorXd direction = cycle_.unstable_direction().cwiseQuotient(scales);
    const Eigen::MatrixXd rows = across_ - (across_ * direction) * reference_.transpose() / reference_.dot(direction);
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
    result.topRows(n - 1) = scales.head(n - 1).asDiagonal() * rows * scales.cwiseInverse().asDiagonal();
    return result;
}

Eigen::MatrixXd CycleEnds::by_end() const {
    const Eigen::Index n = cycle_.scales().size();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
    const Eigen::RowVectorXd& coordinate = cycle_.unstable_coordinate();
    const double along_reference = coordinate * cycle_.scales().cwiseProduct(reference_);
    result.row(n - 1) = cycle_.scales()[n - 1] / along_reference * coordinate;
    return result;
}

CycleEnds::Equations CycleEnds::equations(std::span<const double> begin, std::span<const double> end,
                                          const Eigen::MatrixXd& period_rates) const {
    const Eigen::VectorXd from_begin = cycle_.from_cycle(begin), from_end = cycle_.from_cycle(end);
    Equations result{{}, by_begin(), by_end(), {}};
    result.values = result.by_begin * from_begin + result.by_end * from_end;
    // Whole periods that are left out depend on the parameters too.
    const auto changes = [&](const Eigen::VectorXd& from, std::span<const double> state) {
        Eigen::MatrixXd by = -cycle_.state_by_parameters();
        for (Eigen::Index i = 0; i < from.size(); ++i)
            if (!period_rates.row(i).isZero(0)) {
                const auto place = static_cast<std::size_t>(i);
                const double period = cycle_.periods()[place];
                by.row(i) -=
                    std::round((state[place] - cycle_.state()[place] - from[i]) / period) * period_rates.row(i);
            }
        return by;
    };
    result.by_parameters = result.by_begin * changes(from_begin, begin) + result.by_end * changes(from_end, end);
    return result;
}

EndDistances CycleEnds::distances(std::span<const double> begin, std::span<const double> end) const {
    return {cycle_.length_of(cycle_.from_cycle(begin)), cycle_.length_of(cycle_.from_cycle(end))};
}

namespace {

/// How many turns to add (positive) or to leave out at the beginning and at the end of an orbit.
struct TurnChange {
    std::ptrdiff_t begin = 0, end = 0;
};

TurnChange change_of_turns(const CycleEnds& ends, const Orbit& orbit, std::span<const double> end) {
    static constexpr double most = 200; // at once
    const SaddleCycle& cycle = ends.cycle();
    const EndDistances is = ends.distances(orbit.starts.front(), end), wanted = cycle.wanted_distances();
    // With the number of turns that is returned a distance is at most the wanted one, and a turn nearer at the least.
    const auto turns = [](double ratio, double rate) {
        const double count = std::isfinite(std::log(ratio)) ? std::log(ratio) / rate : 0;
        return static_cast<std::ptrdiff_t>(std::ceil(std::clamp(count, -most, most)));
    };
    TurnChange change{turns(is.departure / wanted.departure, cycle.growth()),
                      turns(is.approach / wanted.approach, cycle.decay())};
    // One turn beside the cycle stays at either end.
    const auto superfluous = [&](bool last) {
        const std::size_t count = cycle.segments();
        std::ptrdiff_t result = 0;
        for (std::size_t first = count; first + 2 * count <= orbit.segments(); first += count, ++result) {
            const auto place = static_cast<std::ptrdiff_t>(last ? orbit.segments() - first - count : first);
            if (!std::equal(orbit.signature.begin() + place,
                            orbit.signature.begin() + place + static_cast<std::ptrdiff_t>(count),
                            cycle.orbit().signature.begin()))
                break;
        }
        return result;
    };
    change.begin = std::max(change.begin, -superfluous(false));
    change.end = std::max(change.end, -superfluous(true));
    return change;
}

void add_before(const SaddleCycle& cycle, Orbit& orbit, std::ptrdiff_t turns) {
    const double multiplier = cycle.unstable_multiplier();
    Eigen::VectorXd off =
        cycle.unstable_direction() * cycle.unstable_coordinate().dot(cycle.from_cycle(orbit.starts.front()));
    for (; turns > 0; --turns) {
        off /= multiplier;
        const SaddleCycle::Turn turn = cycle.turn_from(off);
        const Signature& signature = cycle.orbit().signature;
        orbit.signature.insert(orbit.signature.begin(), signature.begin(), signature.end());
        orbit.starts.insert(orbit.starts.begin(), turn.starts.begin(), turn.starts.end());
        orbit.durations.insert(orbit.durations.begin(), turn.durations.begin(), turn.durations.end());
    }
}

/// @param end last state of the orbit
void add_after(const SaddleCycle& cycle, Orbit& orbit, std::span<const double> end, std::ptrdiff_t turns) {
    Eigen::VectorXd off = cycle.from_cycle(end);
    for (; turns > 0; --turns) {
        off -= cycle.unstable_direction() * cycle.unstable_coordinate().dot(off);
        const SaddleCycle::Turn turn = cycle.turn_from(off);
        const Signature& signature = cycle.orbit().signature;
        orbit.signature.insert(orbit.signature.end(), signature.begin(), signature.end());
        orbit.starts.insert(orbit.starts.end(), turn.starts.begin(), turn.starts.end());
        orbit.durations.insert(orbit.durations.end(), turn.durations.begin(), turn.durations.end());
        off = turn.off;
    }
}

/// Leaves out what a list has too much at its ends, or fills it up.
template <class List>
void fit(List& list, std::ptrdiff_t before, std::ptrdiff_t after, const typename List::value_type& added) {
    const auto count = [](std::ptrdiff_t size) { return static_cast<std::size_t>(size); };
    list.erase(list.end() - std::max<std::ptrdiff_t>(-after, 0), list.end());
    list.erase(list.begin(), list.begin() + std::max<std::ptrdiff_t>(-before, 0));
    list.insert(list.begin(), count(std::max<std::ptrdiff_t>(before, 0)), added);
    list.insert(list.end(), count(std::max<std::ptrdiff_t>(after, 0)), added);
}

} // namespace

OrbitDirection TurnsChanged::of(OrbitDirection direction) const {
    const std::vector<double> nothing(orbit.starts.front().size(), 0.0);
    fit(direction.starts, before, after, nothing);
    fit(direction.durations, before, after, 0.0);
    return direction;
}

TurnsChanged with_suitable_turns(const CycleEnds& ends, const Orbit& orbit, std::span<const double> end) {
    const SaddleCycle& cycle = ends.cycle();
    const TurnChange change = change_of_turns(ends, orbit, end);
    const auto count = static_cast<std::ptrdiff_t>(cycle.segments());
    TurnsChanged result{orbit, change.begin * count, change.end * count};
    const std::ptrdiff_t before = std::min<std::ptrdiff_t>(result.before, 0),
                         after = std::min<std::ptrdiff_t>(result.after, 0);
    fit(result.orbit.signature, before, after, {});
    fit(result.orbit.starts, before, after, {});
    fit(result.orbit.durations, before, after, {});
    add_after(cycle, result.orbit, end, change.end);
    add_before(cycle, result.orbit, change.begin);
    return result;
}

bool turns_need_renewal(const CycleEnds& ends, const Orbit& orbit, std::span<const double> end) {
    constexpr std::ptrdiff_t superfluous = 3;
    const TurnChange change = change_of_turns(ends, orbit, end);
    return change.begin > 0 || change.end > 0 || change.begin <= -superfluous || change.end <= -superfluous;
}

} // namespace graze
