#include "graze/grazing/discontinuity_map.hpp"

#include "base/enumerator_name.hpp"
#include "base/linear_systems.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "grazing/contact_effect.hpp"
#include "grazing/return_map.hpp"
#include "grazing/slide_excursion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

void require_fitting(const System& system, const TouchState& touch) {
    require_index(touch.mode, system.model().modes.size(), "mode");
    require_index(touch.event, system.model().events.size(), "event");
    const auto is_finite = [](double value) { return std::isfinite(value); };
    if (touch.state.size() != system.states() || touch.scales.size() != system.states() ||
        touch.parameters.size() != system.parameters() || !std::ranges::all_of(touch.state, is_finite) ||
        !std::ranges::all_of(touch.parameters, is_finite) ||
        !std::ranges::all_of(touch.scales, [](double size) { return size > 0 && size < 1e300; }))
        throw InputError(fmt::format("a touch has {} states, {} sizes and {} parameters that do not fit the model",
                                     touch.state.size(), touch.scales.size(), touch.parameters.size()),
                         fmt::format("give {} finite states, as many positive sizes, and {} parameters",
                                     system.states(), system.parameters()));
}

/// Returns a gain of the states with round-off remnants set to zero.
std::vector<double> without_remnants(const Eigen::VectorXd& gain, const Eigen::VectorXd& scales) {
    constexpr double remnant = 1e-13;
    const Eigen::VectorXd sizes = gain.cwiseQuotient(scales).cwiseAbs();
    std::vector<double> result;
    for (Eigen::Index i = 0; i < gain.size(); ++i)
        result.push_back(sizes[i] > remnant * sizes.maxCoeff() ? gain[i] : 0);
    return result;
}

/// Returns why a state is not a proper touch; empty if it is.
std::string problem_of(const System& system, const TouchState& touch, const TouchGeometry& geometry,
                       const TouchSizes& sizes) {
    constexpr double degenerate = 1e-9;
    const std::string& name = system.model().events[touch.event].name;
    const Eigen::Index n = index(touch.state.size());
    const double terms = geometry.rate_gradient.head(n).cwiseAbs().dot(geometry.field.cwiseAbs());
    if (!geometry.gradient.allFinite() || !geometry.rate_gradient.allFinite() || !geometry.field.allFinite() ||
        !std::isfinite(geometry.acceleration))
        return fmt::format("the rates of event '{}' are not finite at the touch", name);
    if (!(std::abs(geometry.acceleration) > degenerate * terms))
        return fmt::format("event '{}' is touched without acceleration: the tangency is degenerate", name);
    if (geometry.acceleration < 0)
        return fmt::format("the function of event '{}' has a maximum, not a minimum, at the touch", name);
    if (!sizes.is_zero(geometry.value, geometry.gradient))
        return fmt::format("the state is not on the surface of event '{}'", name);
    if (!sizes.is_zero_rate(geometry.rate, geometry.gradient, geometry.field))
        return fmt::format("the surface of event '{}' is reached with nonzero speed", name);
    return {};
}

/// Moves a touch, known only to the accuracy of an orbit, exactly to zero value and zero rate of the event function by
/// minimum-norm Newton steps in scaled states: for a stiff contact the inaccuracy would be a force.
void project_onto_touch(const TouchFunctions& functions, TouchState& touch, TouchGeometry& geometry) {
    constexpr int iterations = 3;
    const Eigen::Index n = index(touch.state.size());
    const Eigen::Map<const Eigen::VectorXd> scales = vector_of(touch.scales);
    for (int iteration = 0; iteration < iterations; ++iteration) {
        Eigen::MatrixXd rows(2, n);
        rows.row(0) = geometry.gradient.head(n).cwiseProduct(scales).transpose();
        rows.row(1) = geometry.rate_gradient.head(n).cwiseProduct(scales).transpose();
        Eigen::Vector2d lack(-geometry.value, -geometry.rate);
        for (Eigen::Index i = 0; i < 2; ++i) {
            const double size = rows.row(i).norm();
            rows.row(i) /= size;
            lack[i] /= size;
        }
        const Eigen::VectorXd step = shortest_solution(rows, lack);
        if (!step.allFinite())
            return;
        for (Eigen::Index i = 0; i < n; ++i)
            touch.state[static_cast<std::size_t>(i)] += step[i] * scales[i];
        geometry = functions.at(touch.state, touch.parameters);
    }
}

/// Sets the map of a slide that the motion leaves for a short time.
void add_excursion(DiscontinuityMap& map, const TouchFunctions& functions, const TouchGeometry& geometry,
                   const TouchSizes& sizes, const ContactChain& chain) {
    const ContactEffect effect = slide_excursion(functions, map.touch, geometry, sizes, chain);
    map.reason = effect.reason;
    if (!map.reason.empty())
        return;
    map.order = MapOrder::quadratic;
    map.direction = without_remnants(effect.gain, sizes.scales());
    const Model& model = functions.system().model();
    const Transition* const back = model.find_transition(chain.modes.front(), *chain.slid_along);
    map.contacts.push_back(static_cast<std::size_t>(back - model.transitions.data()));
    constexpr double times = 3; // the time from the edge to the touch
    map.time = times / map.acceleration;
}

} // namespace

std::string_view name_of(MapOrder order) {
    constexpr std::string_view names[] = {"none", "square-root", "three-halves", "linear", "quadratic"};
    return enumerator_name(names, order, "none");
}

double DiscontinuityMap::by_depth(double depth) const {
    return order == MapOrder::square_root    ? std::sqrt(2 * acceleration * depth)
           : order == MapOrder::three_halves ? depth * std::sqrt(depth)
           : order == MapOrder::linear       ? depth
           : order == MapOrder::quadratic    ? depth * depth
                                             : 0;
}

double DiscontinuityMap::second_by_depth(double depth) const {
    return order == MapOrder::square_root ? 2 * acceleration * depth
           : order == MapOrder::linear    ? depth * std::sqrt(depth)
                                          : 0;
}

DiscontinuityMap discontinuity_map(const System& system, const TouchState& touch) {
    require_fitting(system, touch);
    return local_map(TouchFunctions(system, touch.mode, touch.event), touch, AskedContacts::all);
}

DiscontinuityMap local_map(const TouchFunctions& functions, const TouchState& touch, AskedContacts asked) {
    const System& system = functions.system();
    DiscontinuityMap map;
    map.touch = touch;
    const Eigen::Index n = index(system.states());
    TouchGeometry geometry = functions.at(touch.state, touch.parameters);
    const TouchSizes sizes(touch, geometry);
    if (asked == AskedContacts::rigid_beside)
        project_onto_touch(functions, map.touch, geometry);
    map.reason = problem_of(system, touch, geometry, sizes);
    if (!map.reason.empty())
        return map;
    project_onto_touch(functions, map.touch, geometry);
    map.acceleration = geometry.acceleration;
    map.gradient = numbers_of(geometry.gradient.head(n));
    map.rate_gradient = numbers_of(geometry.rate_gradient.head(n));
    map.field = numbers_of(geometry.field);
    const ContactChain chain = follow_contact(functions, map.touch, geometry, sizes);
    map.contacts = chain.contacts;
    map.restitution = chain.restitution;
    map.time = chain.time;
    map.reason = chain.reason;
    map.ends = chain.ends;
    if (chain.slid_along && asked == AskedContacts::all)
        add_excursion(map, functions, geometry, sizes, chain);
    if (!map.reason.empty() || map.exists())
        return map;
    if (!sizes.is_zero_gain(chain.gain)) {
        map.order = MapOrder::square_root;
        map.direction = without_remnants(chain.gain, sizes.scales());
        if (chain.contacts.size() == 1 && asked == AskedContacts::all)
            if (const auto second = next_order_of_impact(functions, map.touch, geometry, sizes, chain.contacts.front()))
                map.second = numbers_of(*second);
        return map;
    }
    if (chain.modes.size() != 2 || !chain.only_changes_modes) {
        map.reason = "to first order the contact changes nothing";
        return map;
    }
    if (asked != AskedContacts::all) {
        map.reason = "the contact is not rigid";
        return map;
    }
    const bool slides = !chain.leaves_by_surface;
    const std::size_t mode = chain.modes.front();
    const ContactEffect effect = slides ? sliding_contact(functions, map.touch, geometry, sizes, mode, chain.contacts)
                                        : compliant_contact(functions, map.touch, geometry, sizes, mode);
    map.reason = effect.reason;
    if (!map.reason.empty())
        return map;
    map.order = slides ? MapOrder::linear : MapOrder::three_halves;
    map.direction = without_remnants(effect.gain, sizes.scales());
    if (slides)
        map.second = without_remnants(effect.next, sizes.scales());
    return map;
}

} // namespace graze
