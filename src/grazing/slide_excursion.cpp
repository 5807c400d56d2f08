#include "grazing/slide_excursion.hpp"

#include "base/concatenated.hpp"
#include "flow/guard.hpp"
#include "flow/lie_derivative.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

namespace graze {

namespace {

constexpr double small_change = 1e-6; // relative tolerance; touches are located to about 1e-10

/// The difference of the field of an excursion from the sliding field, with its Lie brackets along the sliding field.
struct SlideDifference {
    std::array<Eigen::VectorXd, 4> brackets; ///< the difference, and its first three brackets
    Eigen::MatrixXd derivatives;             ///< Jacobian of the difference, states x states
};

SlideDifference difference_at(const System& system, const TouchState& touch, std::size_t mode) {
    Model model = system.model(); // a copy, whose expression graph may grow
    const std::size_t n = system.states();
    const auto sliding = model.expand(model.modes[touch.mode].rates), other = model.expand(model.modes[mode].rates);
    std::vector<Expression> bracket, outputs;
    for (std::size_t i = 0; i < n; ++i)
        bracket.push_back(other[i] - sliding[i]);
    const auto of_difference = sparse_jacobian(bracket, SymbolIndex(model.state_symbols()));
    SlideDifference result;
    for (std::size_t order = 0; order < result.brackets.size(); ++order) {
        outputs.insert(outputs.end(), bracket.begin(), bracket.end());
        const auto along = lie_derivatives(model, bracket, sliding), back = lie_derivatives(model, sliding, bracket);
        for (std::size_t i = 0; i < n; ++i)
            bracket[i] = along[i] - back[i];
    }
    for (const JacobianEntry& entry : of_difference)
        outputs.push_back(entry.value);
    const auto values = Function(model.inputs(), outputs)(concatenated(touch.state, touch.parameters));
    std::size_t place = 0;
    for (Eigen::VectorXd& one : result.brackets) {
        one = Eigen::Map<const Eigen::VectorXd>(values.data() + place, index(n));
        place += n;
    }
    result.derivatives = Eigen::MatrixXd::Zero(index(n), index(n));
    for (const JacobianEntry& entry : of_difference)
        result.derivatives(index(entry.row), index(entry.column)) = values[place++];
    return result;
}

/// Returns the smallest direction, in scaled states, along which one function grows by 1 and another is constant.
/// @param grows, constant gradients of the functions
Eigen::VectorXd direction_of(const Eigen::VectorXd& grows, const Eigen::VectorXd& constant,
                             const Eigen::VectorXd& scales) {
    const Eigen::VectorXd one = grows.cwiseProduct(scales), other = constant.cwiseProduct(scales);
    const Eigen::VectorXd along = one - other * (one.dot(other) / other.squaredNorm());
    return along.cwiseProduct(scales) / along.dot(one);
}

/// Returns why the jumps at both ends of the excursion are not negligible, or why it does not end in the slide; empty
/// otherwise.
std::string problem_of_ends(const System& system, const TouchState& touch, const TouchSizes& sizes,
                            const ContactChain& chain) {
    constexpr double later = 1e-3; // share of the time scale: where the slide is possible again
    const Model& model = system.model();
    const std::size_t mode = chain.modes.front(), surface = *chain.slid_along;
    const Transition* const back = model.find_transition(mode, surface);
    if (back == nullptr)
        return fmt::format("nothing happens at event '{}' in mode '{}'", model.events[surface].name,
                           model.modes[mode].name);
    const auto which = static_cast<std::size_t>(back - model.transitions.data());
    std::vector<double> inputs = concatenated(touch.state, touch.parameters), conditions, work(system.workspace());
    const std::vector<double> field = system.mode(touch.mode).rates(inputs);
    for (std::size_t i = 0; i < system.states(); ++i)
        inputs[i] += later * sizes.time() * field[i];
    const auto* const chosen = chosen_alternative(system, which, inputs, conditions, work);
    if (chosen == nullptr || chosen->mode != touch.mode || system.transition(which).following)
        return fmt::format("in mode '{}' the event '{}' does not lead back to mode '{}'", model.modes[mode].name,
                           model.events[surface].name, model.modes[touch.mode].name);
    const TouchGeometry beside = TouchFunctions(system, mode, surface).at(touch.state, touch.parameters);
    for (const std::size_t contact : {chain.contacts.front(), which})
        if (!is_identity_on_surface(system, model.transitions[contact].jump, touch, beside, sizes))
            return fmt::format("the jump '{}' changes states on the surface",
                               model.jumps[model.transitions[contact].jump].name);
    return {};
}

} // namespace

ContactEffect slide_excursion(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                              const TouchSizes& sizes, const ContactChain& chain) {
    const System& system = functions.system();
    const Model& model = system.model();
    const Eigen::Index n = index(system.states());
    const std::size_t mode = chain.modes.front(), surface = *chain.slid_along;
    const SlideDifference difference = difference_at(system, touch, mode);
    const auto& [value, first, second, third] = difference.brackets;
    const std::string &own = model.modes[touch.mode].name, &name = model.modes[mode].name;
    ContactEffect result;
    const auto fail = [&](std::string reason) {
        result.reason = std::move(reason);
        return result;
    };
    const Eigen::VectorXd& units = sizes.scales();
    const auto size = [&](const Eigen::VectorXd& change) { return change.cwiseQuotient(units).norm(); };
    const auto scaled = [&](const Eigen::MatrixXd& matrix) {
        return (units.cwiseInverse().asDiagonal() * matrix * units.asDiagonal()).norm();
    };
    if (!difference.derivatives.allFinite() || !third.allFinite() || !second.allFinite() ||
        !(size(value) * sizes.time() <= small_change))
        return fail(fmt::format("the vector field of mode '{}' is different at the touch", name));
    const double a = geometry.acceleration;
    const std::vector<double> of_surface = system.event(surface)(concatenated(touch.state, touch.parameters));
    const Eigen::VectorXd edge = geometry.gradient.head(n),
                          off = Eigen::Map<const Eigen::VectorXd>(of_surface.data() + 1, n),
                          by_edge = second / a,                               // M
        by_surface = difference.derivatives * direction_of(off, edge, units); // N
    const Eigen::MatrixXd rest = difference.derivatives - by_edge * edge.transpose() - by_surface * off.transpose();
    const double edge_size = edge.cwiseAbs().dot(units), off_size = off.cwiseAbs().dot(units);
    if (!(scaled(rest) <= small_change * scaled(difference.derivatives)) ||
        !(size(first) * sizes.time() <= small_change * size(by_edge) * edge_size))
        return fail(fmt::format("the field of mode '{}' is not that of mode '{}' wherever sliding ends", name, own));
    const double fall = -off.dot(by_edge); // the surface's function has the rate -fall h
    if (!(fall > small_change * size(by_edge) * off_size))
        return fail(
            fmt::format("mode '{}' does not come back to the surface of event '{}'", name, model.events[surface].name));
    result.reason = problem_of_ends(system, touch, sizes, chain);
    const Eigen::VectorXd bend = third / (3 * a) + fall * by_surface;
    constexpr double of_times = 4.5; // integral of t (a t^2/2 - d) from -T to 2 T, per d^2/a
    result.gain = of_times / a * (bend + by_edge * (off.dot(bend) / fall));
    return result;
}

} // namespace graze
