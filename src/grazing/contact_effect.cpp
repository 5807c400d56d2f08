#include "grazing/contact_effect.hpp"

#include "base/concatenated.hpp"
#include "flow/lie_derivative.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace graze {

namespace {

constexpr double small_change = 1e-6; // relative tolerance; touches are located to about 1e-10

/// The vector field of another mode minus that of the touching mode, at a touch, with derivatives.
struct FieldDifference {
    Eigen::VectorXd value, second; ///< difference, and its second derivative along the field of the touching mode
    double jerk = 0;               ///< third time derivative of the touched function
    Eigen::MatrixXd derivatives;   ///< Jacobian of the difference, states x states
    Eigen::MatrixXd of_field;      ///< Jacobian of the touching mode's field
};

/// Computes the difference at a touch. @param mode the other mode
FieldDifference difference_of(const System& system, const TouchState& touch, std::size_t mode) {
    Model model = system.model();
    const std::size_t n = system.states();
    const auto own = model.expand(model.modes[touch.mode].rates), other = model.expand(model.modes[mode].rates);
    std::vector<Expression> outputs;
    for (std::size_t i = 0; i < n; ++i)
        outputs.push_back(other[i] - own[i]);
    const std::vector<Expression> difference = outputs;
    const std::vector<Expression> second = lie_derivatives(model, lie_derivatives(model, difference, own), own);
    outputs.insert(outputs.end(), second.begin(), second.end());
    const SymbolIndex states(model.state_symbols());
    const auto of_difference = sparse_jacobian(difference, states), of_field = sparse_jacobian(own, states);
    for (const auto* entries : {&of_difference, &of_field})
        for (const JacobianEntry& entry : *entries)
            outputs.push_back(entry.value);
    std::vector<Expression> rate{model.expand(model.events[touch.event].function)};
    for (int order = 0; order < 3; ++order)
        rate = lie_derivatives(model, rate, own);
    outputs.push_back(rate.front());
    const auto values = Function(model.inputs(), outputs)(concatenated(touch.state, touch.parameters));
    FieldDifference result;
    result.value = Eigen::Map<const Eigen::VectorXd>(values.data(), index(n));
    result.second = Eigen::Map<const Eigen::VectorXd>(values.data() + n, index(n));
    result.derivatives = result.of_field = Eigen::MatrixXd::Zero(index(n), index(n));
    std::size_t place = 2 * n;
    for (const JacobianEntry& entry : of_difference)
        result.derivatives(index(entry.row), index(entry.column)) = values[place++];
    for (const JacobianEntry& entry : of_field)
        result.of_field(index(entry.row), index(entry.column)) = values[place++];
    result.jerk = values[place];
    return result;
}

/// Derivatives at a touch of the field F, of the jump J and of the touched function.
struct Derivatives {
    Eigen::VectorXd curve;       ///< derivative of F along F
    Eigen::MatrixXd of_field;    ///< Jacobian of F, states x states
    Eigen::MatrixXd of_jump;     ///< Jacobian of J minus the identity
    Eigen::VectorXd second_jump; ///< second derivative of J along F
    double jerk = 0;             ///< third time derivative of the touched function
};

Derivatives derivatives_at(const System& system, const TouchState& touch, std::size_t transition) {
    Model model = system.model();
    const std::size_t n = system.states();
    const std::vector<Expression> field = model.expand(model.modes[touch.mode].rates),
                                  jump = model.expand(
                                      std::vector<Expression>(model.jumps[model.transitions[transition].jump].map));
    std::vector<Expression> outputs = lie_derivatives(model, field, field);
    const std::vector<Expression> second = lie_derivatives(model, lie_derivatives(model, jump, field), field);
    outputs.insert(outputs.end(), second.begin(), second.end());
    std::vector<Expression> rate{model.expand(model.events[touch.event].function)};
    for (int order = 0; order < 3; ++order)
        rate = lie_derivatives(model, rate, field);
    outputs.push_back(rate.front());
    const SymbolIndex states(model.state_symbols());
    const auto of_field = sparse_jacobian(field, states), of_jump = sparse_jacobian(jump, states);
    for (const auto* entries : {&of_field, &of_jump})
        for (const JacobianEntry& entry : *entries)
            outputs.push_back(entry.value);
    const auto values = Function(model.inputs(), outputs)(concatenated(touch.state, touch.parameters));

    Derivatives result;
    result.curve = Eigen::Map<const Eigen::VectorXd>(values.data(), index(n));
    result.second_jump = Eigen::Map<const Eigen::VectorXd>(values.data() + n, index(n));
    result.jerk = values[2 * n];
    result.of_field = Eigen::MatrixXd::Zero(index(n), index(n));
    result.of_jump = -Eigen::MatrixXd::Identity(index(n), index(n));
    std::size_t place = 2 * n + 1;
    for (const JacobianEntry& entry : of_field)
        result.of_field(index(entry.row), index(entry.column)) = values[place++];
    for (const JacobianEntry& entry : of_jump)
        result.of_jump(index(entry.row), index(entry.column)) += values[place++];
    return result;
}

/// Returns why the jumps into the sliding mode and back are not negligible; empty if they are.
std::string problem_of_effect(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                              const TouchSizes& sizes, std::span<const std::size_t> contacts,
                              const Eigen::VectorXd& gain) {
    const System& system = functions.system();
    const Eigen::VectorXd& units = sizes.scales();
    for (const std::size_t contact : contacts) {
        const std::size_t jump = system.model().transitions[contact].jump;
        std::string refused =
            fmt::format("the jump '{}' changes states on the surface", system.model().jumps[jump].name);
        if (!is_identity_on_surface(system, jump, touch, geometry, sizes))
            return refused;
        if (system.jump(jump).identity || contact != contacts.front())
            continue;
        // Sliding begins away from the touch, where the jump has an effect of order d.
        const auto by_square = next_order_of_impact(functions, touch, geometry, sizes, contact);
        if (!by_square)
            return fmt::format("the jump '{}' has no derivatives at the touch", system.model().jumps[jump].name);
        if (!((2 * geometry.acceleration * *by_square).cwiseQuotient(units).norm() <=
              small_change * gain.cwiseQuotient(units).norm()))
            return refused;
    }
    return {};
}

} // namespace

bool is_identity_on_surface(const System& system, std::size_t jump, const TouchState& touch,
                            const TouchGeometry& geometry, const TouchSizes& sizes) {
    const System::CompiledJump& compiled = system.jump(jump);
    if (compiled.identity)
        return true;
    const Eigen::Index n = index(touch.state.size());
    const std::vector<double> entries = compiled.jacobian(concatenated(touch.state, touch.parameters));
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(n, n);
    for (const std::size_t i : compiled.changed)
        change(index(i), index(i)) = -1;
    for (std::size_t k = 0; k < compiled.entries.size(); ++k)
        if (index(compiled.entries[k].column) < n)
            change(index(compiled.entries[k].row), index(compiled.entries[k].column)) += entries[k];
    change -= change * sizes.off_surface(geometry) * geometry.gradient.head(n).transpose();
    const Eigen::VectorXd& units = sizes.scales();
    return (units.cwiseInverse().asDiagonal() * change * units.asDiagonal()).norm() <= small_change;
}

/// The motion reaches the surface at the time -s/a - j s^2/(6 a^3), with j the third rate of the function. There K = J
/// - 1, which is zero on the touching states, shifts it. The shift is carried by the field to time 0 and compared
/// there. All terms are expanded to order s^2; the motion lies off the surface by the depth s^2/(2 a).
std::optional<Eigen::VectorXd> next_order_of_impact(const TouchFunctions& functions, const TouchState& touch,
                                                    const TouchGeometry& geometry, const TouchSizes& sizes,
                                                    std::size_t transition) {
    const Derivatives at = derivatives_at(functions.system(), touch, transition);
    const double a = geometry.acceleration;
    const Eigen::VectorXd first = at.of_jump * geometry.field; // derivative of K along F
    const Eigen::VectorXd bent =
        (at.second_jump - at.curve) / 2; // second derivative of K along the motion, divided by 2
    const Eigen::VectorXd carried = at.of_field * first;
    const Eigen::VectorXd result = -first * (at.jerk / (6 * a * a * a)) + (bent - carried) / (a * a) -
                                   at.of_jump * sizes.off_surface(geometry) / (2 * a);
    return result.allFinite() ? std::optional(result) : std::nullopt;
}

ContactEffect compliant_contact(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                                const TouchSizes& sizes, std::size_t mode) {
    const Eigen::Index n = index(touch.state.size());
    const FieldDifference difference = difference_of(functions.system(), touch, mode);
    const std::string& name = functions.system().model().modes[mode].name;
    ContactEffect result;
    const auto fail = [&](std::string reason) {
        result.reason = std::move(reason);
        return result;
    };
    const Eigen::VectorXd& units = sizes.scales();
    const double force = (difference.value.cwiseQuotient(units) * sizes.time()).norm();
    if (!difference.derivatives.allFinite() || !difference.second.allFinite() || !(force <= small_change))
        return fail(fmt::format("the vector field of mode '{}' is different at the touch", name));
    const double a = geometry.acceleration;
    const Eigen::VectorXd gradient = geometry.gradient.head(n), rate_gradient = geometry.rate_gradient.head(n);
    const Eigen::VectorXd damping = difference.derivatives * geometry.field / a;
    const Eigen::VectorXd stiffness = difference.derivatives * sizes.off_surface(geometry);
    const Eigen::MatrixXd rest =
        units.cwiseInverse().asDiagonal() *
        (difference.derivatives - stiffness * gradient.transpose() - damping * rate_gradient.transpose()) *
        units.asDiagonal();
    const Eigen::MatrixXd whole = units.cwiseInverse().asDiagonal() * difference.derivatives * units.asDiagonal();
    if (!(whole.norm() > 0))
        return fail("the contact changes nothing");
    if (!(rest.norm() <= small_change * whole.norm()))
        return fail(fmt::format("the field of mode '{}' is not that of mode '{}' wherever the surface is touched", name,
                                functions.system().model().modes[touch.mode].name));
    if (!(std::abs(gradient.dot(damping)) <= small_change))
        return fail(fmt::format("mode '{}' changes the rate of event '{}'", name,
                                functions.system().model().events[touch.event].name));
    const Eigen::VectorXd bracket = difference.second - 2 * a * (difference.of_field * damping);
    // Coefficients of T^3, with T half the time beyond the surface. Damping acts also on the shift of the end time of
    // the contact: the event function a (t^2 - T^2)/2 is corrected there by its third rate and by the gain.
    const Eigen::VectorXd by_force = -a * stiffness + bracket / 3;
    const double late = difference.jerk / 3 + gradient.dot(by_force) + 2 * a / 3 * rate_gradient.dot(damping);
    const Eigen::VectorXd by_time = by_force - late * damping;
    result.gain = by_time * std::pow(2 / a, 1.5);
    return result;
}

ContactEffect sliding_contact(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                              const TouchSizes& sizes, std::size_t mode, std::span<const std::size_t> contacts) {
    const Eigen::Index n = index(touch.state.size());
    const Model& model = functions.system().model();
    const FieldDifference difference = difference_of(functions.system(), touch, mode);
    const std::string &name = model.modes[mode].name, &own = model.modes[touch.mode].name;
    ContactEffect result;
    const auto fail = [&](std::string reason) {
        result.reason = std::move(reason);
        return result;
    };
    const Eigen::VectorXd& units = sizes.scales();
    if (!difference.derivatives.allFinite() || !difference.second.allFinite() || !difference.of_field.allFinite() ||
        !std::isfinite(difference.jerk) ||
        !((difference.value.cwiseQuotient(units) * sizes.time()).norm() <= small_change))
        return fail(fmt::format("the vector field of mode '{}' is different at the touch", name));
    const double a = geometry.acceleration;
    const Eigen::VectorXd gradient = geometry.gradient.head(n), rate_gradient = geometry.rate_gradient.head(n);
    const Eigen::VectorXd slowing = difference.derivatives * geometry.field / a; // M
    const Eigen::VectorXd off = difference.derivatives * sizes.off_surface(geometry);
    const auto scaled = [&](const Eigen::MatrixXd& matrix) {
        return (units.cwiseInverse().asDiagonal() * matrix * units.asDiagonal()).norm();
    };
    if (!(scaled(difference.derivatives - off * gradient.transpose() - slowing * rate_gradient.transpose()) <=
          small_change * scaled(difference.derivatives)))
        return fail(
            fmt::format("the field of mode '{}' is not that of mode '{}' wherever the surface is touched", name, own));
    // Second derivative of D, on the surface.
    const Eigen::VectorXd bend = difference.second - a * off - difference.jerk * slowing;
    const double terms = gradient.cwiseAbs().dot(difference.second.cwiseAbs() + a * off.cwiseAbs() +
                                                 std::abs(difference.jerk) * slowing.cwiseAbs());
    if (!(std::abs(gradient.dot(slowing) + 1) <= small_change) ||
        !(std::abs(gradient.dot(bend)) <= small_change * (terms + std::abs(a) / sizes.time())))
        return fail(
            fmt::format("mode '{}' does not stay on the surface of event '{}'", name, model.events[touch.event].name));
    result.gain = -slowing;
    result.reason = problem_of_effect(functions, touch, geometry, sizes, contacts, result.gain);
    const Eigen::VectorXd by_time =
        bend / 6 - a / 3 * (rate_gradient.dot(slowing) * slowing + difference.of_field * slowing);
    result.next = by_time * std::pow(2 / a, 1.5);
    return result;
}

} // namespace graze
