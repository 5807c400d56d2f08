#include "graze/grazing/cycle_map.hpp"

#include "base/decompositions.hpp"
#include "base/linear_systems.hpp"
#include "base/special_numbers.hpp"
#include "flow/cyclic.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "grazing/return_map.hpp"
#include "orbit/certify.hpp"
#include "orbit/newton.hpp"
#include "orbit/shooting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// A minimum of an event function below this share of its size counts as a touch.
constexpr double touching = 1e-7;

Eigen::VectorXd active_part(const std::vector<std::size_t>& active, const Eigen::VectorXd& all) {
    Eigen::VectorXd result(index(active.size()));
    for (std::size_t i = 0; i < active.size(); ++i)
        result[index(i)] = all[index(active[i])];
    return result;
}

/// Returns the eigenvalues except the smallest, which is the zero eigenvalue of the projection.
std::vector<std::complex<double>> multipliers_of(const CycleMap& map) {
    const Eigen::Map<const Eigen::VectorXd> scales = vector_of(map.scales);
    const Eigen::MatrixXd scaled = scales.cwiseInverse().asDiagonal() * matrix_of(map) * scales.asDiagonal();
    const Eigen::VectorXcd values = eigenvalues_or_nan(scaled);
    std::vector<std::complex<double>> result(values.begin(), values.end());
    std::ranges::sort(result, [](const auto& one, const auto& other) {
        return std::abs(one) != std::abs(other) ? std::abs(one) > std::abs(other) : one.imag() > other.imag();
    });
    if (!result.empty())
        result.pop_back();
    return result;
}

/// Sets the derivatives of the orbit without contact with respect to the parameter, unless a multiplier is 1.
void add_parameter(CycleMap& map, const ReturnMap& back, double explicit_rate) {
    constexpr double singular = 1e-9;
    const Eigen::MatrixXd matrix = matrix_of(map);
    const Eigen::Map<const Eigen::VectorXd> scales = vector_of(map.scales);
    const Eigen::MatrixXd system = Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()) -
                                   Eigen::MatrixXd(scales.cwiseInverse().asDiagonal() * matrix * scales.asDiagonal());
    const FullLU<double> factored(system);
    if (!(factored.reciprocal_condition() > singular))
        return;
    const Eigen::VectorXd steady =
        factored.solve(active_part(map.active, back.parameter).cwiseQuotient(scales)).cwiseProduct(scales);
    map.steady = numbers_of(steady);
    map.clearance_rate = vector_of(map.gradient).dot(steady) + explicit_rate;
}

/// Sets the next order of the cycle map. After an impact the shift is of order s, so its square counts around the
/// orbit; after sliding the square is negligible.
void add_next_order(CycleMap& map, const OrbitEquations& equations, const OrbitEvaluation& at, const ReturnMap& back,
                    const TouchFunctions& functions) {
    const Eigen::Index n = back.matrix.rows();
    const Eigen::Map<const Eigen::VectorXd> first = vector_of(map.contact.direction),
                                            second = vector_of(map.contact.second);
    if (map.contact.order == MapOrder::linear) {
        const Eigen::VectorXd gained = back.matrix * second;
        map.second = numbers_of(active_part(map.active, gained));
        map.second_clearance = back.geometry.gradient.head(n).dot(gained);
    } else if (const auto gain = second_return(equations, at, back, functions, first, second)) {
        map.second = numbers_of(active_part(map.active, gain->second));
        map.second_clearance = gain->value;
    }
}

bool is_same_place(const std::vector<double>& one, const std::vector<double>& other, const OrbitEquations& equations,
                   const OrbitEvaluation& at) {
    constexpr double near = 1e-4;
    return std::ranges::all_of(at.active, [&](std::size_t i) {
        return equations.model().states[i].drifting ||
               std::abs(without_turns(one[i] - other[i], at.periods[i])) < near * at.scales[index(i)];
    });
}

/// Evaluates the equations at an orbit. @return false where they are not defined
bool evaluate(Shooting& shooting, const Orbit& orbit, OrbitEvaluation& at) {
    return shooting.evaluate(shooting.unknowns_of(orbit), at);
}

/// Sets the times in one period of the whole orbit at which it touches the event's surface and has contacts there.
void add_times(CycleMap& map, const System& system, const Orbit& orbit) {
    const Orbit whole = whole_orbit(system, orbit);
    map.period = orbit.period();
    double touched = map.touch.time;
    for (std::size_t s = 0; s < map.touch.segment; ++s)
        touched += orbit.durations[s];
    const auto since = [&](double time) { return within_period(time - touched, map.period); };
    const auto event_at_end = [&](std::size_t s) -> std::optional<std::size_t> {
        const Segment& segment = whole.signature[s];
        if (!ends_by_transition(segment) || is_identity_transition(system, segment.index))
            return std::nullopt;
        return system.model().transitions[segment.index].event;
    };
    map.touch_times = {0};
    if (orbit.symmetry) {
        // The image of the touch may be one of the same event.
        const std::size_t mode = orbit.signature[map.touch.segment].mode;
        const Transition* contact = system.model().find_transition(mode, map.touch.event);
        if (contact) {
            const auto index = static_cast<std::size_t>(contact - system.model().transitions.data());
            const Segment image = image_of(system, *orbit.symmetry, {mode, SegmentEnd::event, index}, orbit);
            if (system.model().transitions[image.index].event == map.touch.event)
                map.touch_times.push_back(0.5 * map.period);
        }
    }
    double time = 0;
    for (std::size_t s = 0; s < whole.segments(); ++s) {
        time += whole.durations[s];
        const bool is_touch = map.touch.at_end && s % orbit.segments() == map.touch.segment;
        if (!is_touch && event_at_end(s) == map.touch.event)
            map.contact_times.push_back(since(time));
    }
}

Simulation simulation_of(const System& system, const CycleMapOptions& options) {
    return Simulation(system, {}, {}, integration(options.tolerance));
}

/// Returns the touches of an orbit, each once.
std::vector<OrbitTouch> touches_in(Shooting& shooting, const OrbitEvaluation& at, const Orbit& orbit) {
    const System& system = shooting.system();
    const Certificate certificate = certify(shooting, at);
    std::vector<OrbitTouch> found;
    for (std::size_t s = 0; s < orbit.segments(); ++s) {
        const Segment& segment = orbit.signature[s];
        // A contact slower than this share of the typical speed is a touch.
        if (segment.end == SegmentEnd::event && !is_identity_transition(system, segment.index) &&
            std::abs(certificate.approach_speeds[s]) < touching * shooting.typical_rate(at, s))
            found.push_back({s, system.model().transitions[segment.index].event, orbit.durations[s], true});
    }
    for (const OrbitMinimum& one : certificate.minima)
        if (std::abs(one.value) < touching * one.size)
            found.push_back({one.segment, one.event, one.time, false});
    // The minimum may lie just beyond the end of the arc; its value differs by the square of the rate.
    constexpr double slow = 1e-4;
    for (const EndValue& one : certificate.end_values) {
        double size = 0;
        for (const OrbitMinimum& other : certificate.minima)
            if (other.segment == one.segment && other.event == one.event)
                size = std::max(size, other.size);
        const double rate = shooting.typical_rate(at, one.segment, one.event);
        if (std::abs(one.rate) < slow * rate &&
            std::abs(one.value) < touching * std::max(size, rate * orbit.return_time()))
            found.push_back({one.segment, one.event, orbit.durations[one.segment], false});
    }
    if (found.size() < 2)
        return found;
    std::vector<OrbitTouch> result;
    std::vector<std::vector<double>> places;
    for (const OrbitTouch& one : found) {
        const TouchFunctions functions(system, orbit.signature[one.segment].mode, one.event);
        const ReturnMap back = return_map(shooting, at, one, functions, std::nullopt);
        if (back.touch.state.empty() || std::ranges::any_of(places, [&](const std::vector<double>& place) {
                return is_same_place(place, back.touch.state, shooting, at);
            }))
            continue;
        places.push_back(back.touch.state);
        result.push_back(one);
    }
    return result;
}

} // namespace

Eigen::MatrixXd matrix_of(const CycleMap& map) {
    const Eigen::Index n = index(map.active.size());
    return Eigen::Map<const RowMajor>(map.matrix.data(), n, n);
}

ScaledCycleMap::ScaledCycleMap(const CycleMap& map) : matrix(matrix_of(map)) {
    const Eigen::Index n = matrix.rows();
    const Eigen::Map<const Eigen::VectorXd> scales = vector_of(map.scales);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
            matrix(i, j) = matrix(i, j) * scales[j] / scales[i];
    impact = vector_of(map.impact).cwiseQuotient(scales);
    gradient = vector_of(map.gradient).cwiseProduct(scales);
}

std::vector<OrbitTouch> touches_of(const System& system, const Orbit& orbit, const CycleMapOptions& options) {
    validate_orbit(system.model(), orbit);
    const Simulation simulation = simulation_of(system, options);
    Shooting shooting(simulation, orbit, {});
    OrbitEvaluation at = shooting.evaluation();
    return evaluate(shooting, orbit, at) ? touches_in(shooting, at, orbit) : std::vector<OrbitTouch>{};
}

CycleMap cycle_map_of(const OrbitEquations& equations, const OrbitEvaluation& at, const OrbitTouch& touch,
                      std::optional<std::size_t> free, AskedContacts asked, bool next_order) {
    const TouchFunctions functions(equations.system(), equations.signature()[touch.segment].mode, touch.event);
    return cycle_map_of(equations, at, touch, functions, free, asked, next_order);
}

CycleMap cycle_map_of(const OrbitEquations& equations, const OrbitEvaluation& at, const OrbitTouch& touch,
                      const TouchFunctions& functions, std::optional<std::size_t> free, AskedContacts asked,
                      bool next_order) {
    const System& system = equations.system();
    CycleMap map;
    map.touch = touch;
    map.half = equations.symmetry().has_value();
    map.time = equations.orbit_of(at.unknowns).return_time();
    const ReturnMap back = return_map(equations, at, touch, functions, free);
    map.reason = back.reason;
    if (!map.reason.empty())
        return map;
    map.contact = local_map(functions, back.touch, asked);
    map.reason = map.contact.reason;
    const Eigen::Index n = index(system.states());
    map.active = at.active;
    map.scales = numbers_of(active_part(map.active, at.scales.head(n)));
    for (const std::size_t i : map.active)
        for (const std::size_t j : map.active)
            map.matrix.push_back(back.matrix(index(i), index(j)));
    map.gradient = numbers_of(active_part(map.active, back.geometry.gradient.head(n)));
    map.multipliers = multipliers_of(map);
    if (free)
        add_parameter(map, back, back.geometry.gradient[n + index(equations.free()[*free].place())]);
    if (!map.contact.exists())
        return map;
    const Eigen::Map<const Eigen::VectorXd> gained = vector_of(map.contact.direction);
    const TouchGeometry& here = back.geometry;
    const Eigen::VectorXd shift = here.field * (here.rate_gradient.head(n).dot(gained) / here.acceleration);
    map.impact = numbers_of(active_part(map.active, gained - shift));
    if (next_order && !map.contact.second.empty() && !touch.at_end)
        add_next_order(map, equations, at, back, functions);
    return map;
}

CycleMap cycle_map(const System& system, const Orbit& orbit, const OrbitTouch& touch, const CycleMapOptions& options) {
    validate_orbit(system.model(), orbit);
    require_index(touch.segment, orbit.segments(), "segment");
    require_index(touch.event, system.model().events.size(), "event");
    if (!std::isfinite(touch.time))
        throw InputError("the time of the touch is not finite", "give the time since the segment's start");
    const Simulation simulation = simulation_of(system, options);
    std::vector<ParameterId> free;
    if (options.parameter)
        free.push_back(*options.parameter);
    Shooting shooting(simulation, orbit, free);
    OrbitEvaluation at = shooting.evaluation();
    if (!evaluate(shooting, orbit, at)) {
        CycleMap map;
        map.touch = touch;
        map.reason = at.problem.empty() ? "the orbit cannot be followed" : at.problem;
        return map;
    }
    CycleMap map = cycle_map_of(shooting, at, touch, options.parameter ? std::optional<std::size_t>(0) : std::nullopt,
                                AskedContacts::all, options.next_order);
    map.touches = std::max<std::size_t>(1, touches_in(shooting, at, orbit).size());
    if (map.exists() || map.contact.ends)
        add_times(map, system, orbit);
    return map;
}

std::vector<double> CycleMap::image(std::span<const double> state, double clearance) const {
    if (!exists())
        throw InputError("there is no map of the cycle: " + (reason.empty() ? contact.reason : reason),
                         "check exists() first");
    if (state.size() != active.size() || !std::isfinite(clearance) ||
        !std::ranges::all_of(state, [](double one) { return std::isfinite(one); }))
        throw InputError(fmt::format("{} states and the clearance {} do not fit the map", state.size(), clearance),
                         fmt::format("give {} finite numbers and one", active.size()));
    const Eigen::Map<const Eigen::VectorXd> x = vector_of(state), g = vector_of(gradient), b = vector_of(impact);
    const double depth = std::max(0.0, -(clearance + g.dot(x)));
    Eigen::VectorXd after = matrix_of(*this) * (x + b * contact.by_depth(depth));
    if (!second.empty())
        after += vector_of(second) * contact.second_by_depth(depth);
    return numbers_of(after);
}

bool CycleMap::is_at_touch(double time, double period) const {
    const auto distance = [&](const std::vector<double>& times) {
        double least = infinity;
        for (const double one : times)
            least = std::min(least, std::abs(without_turns(time - one, period)));
        return least;
    };
    return contact_times.empty() || distance(touch_times) < distance(contact_times);
}

std::vector<double> CycleMap::projections(std::size_t count) const {
    constexpr std::size_t most = 10'000'000;
    if (count > most)
        throw InputError(fmt::format("{} projections are too many", count), fmt::format("ask for up to {}", most));
    std::vector<double> result;
    if (!exists())
        return result;
    const Eigen::MatrixXd once = matrix_of(*this);
    const Eigen::Map<const Eigen::VectorXd> g = vector_of(gradient);
    Eigen::VectorXd vector = vector_of(impact);
    for (std::size_t k = 0; k < count; ++k) {
        vector = (once * vector).eval();
        result.push_back(g.dot(vector));
    }
    return result;
}

/// Computed as minus the determinant of (1 - sign P, P B; g, 0), in scaled rows and columns.
double CycleMap::sum_of_projections(int sign) const {
    if (!exists() || active.empty())
        return 0;
    const Eigen::Index n = index(active.size());
    const Eigen::Map<const Eigen::VectorXd> units = vector_of(scales);
    const Eigen::MatrixXd once = units.cwiseInverse().asDiagonal() * matrix_of(*this) * units.asDiagonal();
    const Eigen::VectorXd gained = once * vector_of(impact).cwiseQuotient(units),
                          row = vector_of(gradient).cwiseProduct(units);
    const double size = gained.norm(), steepness = row.norm();
    if (!(size > 0) || !(steepness > 0))
        return 0;
    Eigen::MatrixXd bordered(n + 1, n + 1);
    bordered << Eigen::MatrixXd::Identity(n, n) - sign * once, gained / size, row.transpose() / steepness, 0.0;
    return -FullLU<double>(bordered).determinant() * size * steepness;
}

} // namespace graze
