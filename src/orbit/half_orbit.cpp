#include "orbit/newton.hpp"

#include "base/concatenated.hpp"
#include "flow/cyclic.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/shooting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Returns the largest difference of two states, relative to the extent of each state along the orbit.
double distance(std::span<const double> a, std::span<const double> b, const OrbitEquations& equations,
                std::span<const double> periods) {
    double result = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (equations.model().states[i].drifting)
            continue;
        const double difference = without_turns(a[i] - b[i], periods[i]);
        result = std::max(result, std::abs(difference) / equations.scales()[static_cast<Eigen::Index>(i)]);
    }
    return result;
}

bool is_smooth(const Orbit& orbit) {
    return std::ranges::none_of(orbit.signature, ends_by_transition);
}

/// Cuts an orbit without contacts after half its period, within its middle segment, and appends the state there to its
/// starts. @return false where the orbit has no middle segment or the symmetry changes the mode
bool cut_in_half(const Simulation& simulation, Orbit& orbit, const Symmetry& symmetry) {
    const std::size_t mode = orbit.signature[0].mode, count = orbit.segments() / 2 + 1;
    if (orbit.segments() % 2 == 0 || symmetry.modes[mode] != mode)
        return false;
    double left = 0.5 * orbit.return_time();
    orbit.signature.resize(count);
    orbit.starts.resize(count);
    orbit.durations.resize(count);
    for (std::size_t k = 0; k + 1 < count; ++k)
        left -= orbit.durations[k];
    orbit.durations.back() = left;
    ModeFlow flow = flow_of(simulation);
    flow.set_parameters(orbit.parameters);
    std::vector<double> state = orbit.starts.back();
    if (!(left > 0) || flow.run(mode, state, left) != ModeFlow::Ending::done)
        return false;
    orbit.starts.push_back(std::move(state));
    return true;
}

/// True when the symmetry maps the event that ends segment `from` to the event that ends segment `to`.
bool maps_end_to(const System& system, const Orbit& orbit, std::size_t symmetry, std::size_t from, std::size_t to) {
    try {
        return image_of(system, symmetry, orbit.signature[from], orbit) == orbit.signature[to];
    } catch (const InputError&) { // the event has no image
        return false;
    }
}

/// True when the second half of an orbit's segments is the image of the first half and vice versa. Both directions are
/// checked because a map may be a symmetry in one mode only, as for a clock that is reset.
bool repeats_as_image(const Orbit& orbit, std::size_t index, const OrbitEquations& equations,
                      std::span<const double> periods, double tolerance) {
    const Symmetry& symmetry = equations.model().symmetries[index];
    const Function& map = equations.system().symmetry(index).map;
    const std::size_t half = orbit.segments() / 2;
    if (orbit.segments() % 2 != 0)
        return false;
    const auto maps_start_to = [&](std::size_t from, std::size_t to) {
        return symmetry.modes[orbit.signature[from].mode] == orbit.signature[to].mode &&
               distance(map(concatenated(orbit.starts[from], orbit.parameters)), orbit.starts[to], equations,
                        periods) <= tolerance;
    };
    for (std::size_t k = 0; k < half; ++k)
        if (orbit.signature[k].end != orbit.signature[k + half].end ||
            (!ends_by_transition(orbit.signature[k]) && orbit.signature[k].index != orbit.signature[k + half].index) ||
            std::abs(orbit.durations[k] - orbit.durations[k + half]) > tolerance * orbit.period() ||
            !maps_start_to(k + half, k) || !maps_start_to(k, k + half))
            return false;
    for (std::size_t k = 0; k < half; ++k)
        if (!maps_end_to(equations.system(), orbit, index, k, k + half) ||
            !maps_end_to(equations.system(), orbit, index, k + half, k))
            return false;
    return true;
}

} // namespace

std::optional<Orbit> half_of(const OrbitEquations& equations, const Orbit& orbit, double tolerance) {
    const Model& model = equations.model();
    if (orbit.symmetry || orbit.cycle)
        return std::nullopt;
    const std::vector<double> periods = equations.system().periods()(orbit.parameters);
    for (std::size_t index = 0; index < model.symmetries.size(); ++index) {
        const Symmetry& symmetry = model.symmetries[index];
        const Function& map = equations.system().symmetry(index).map;
        Orbit half = orbit;
        half.symmetry = index;
        if (repeats_as_image(orbit, index, equations, periods, tolerance)) {
            half.signature.resize(orbit.segments() / 2);
            half.starts.resize(orbit.segments() / 2);
            half.durations.resize(orbit.segments() / 2);
            return half;
        }
        if (is_smooth(orbit) && cut_in_half(equations.simulation(), half, symmetry)) {
            const std::vector<double> middle = map(concatenated(half.starts.back(), orbit.parameters));
            if (distance(middle, orbit.starts[0], equations, periods) < tolerance) {
                half.starts.pop_back();
                return half;
            }
        }
    }
    return std::nullopt;
}

std::optional<Orbit> half_orbit(const System& system, const Orbit& orbit, double tolerance) {
    validate_orbit(system.model(), orbit);
    if (!(tolerance > 0) || !std::isfinite(tolerance))
        throw InputError(fmt::format("the tolerance {} is not positive", tolerance), "give a positive one");
    if (system.model().symmetries.empty() || orbit.symmetry)
        return std::nullopt;
    const Simulation simulation(system);
    return half_of(Shooting(simulation, orbit, {}), orbit, tolerance);
}

} // namespace graze
