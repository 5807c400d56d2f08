#include "grazing/sliding_contact.hpp"

#include "grazing/field_difference.hpp"
#include "grazing/next_order.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

namespace {

constexpr double small = 1e-6; // relative tolerance; touches are located to about 1e-10

/// True when a jump leaves all states of the surface near the touch unchanged, to first order.
bool is_identity_on_surface(const System& system, std::size_t jump, const TouchState& touch,
                            const TouchGeometry& geometry, const TouchSizes& sizes) {
    const System::CompiledJump& compiled = system.jump(jump);
    if (compiled.identity)
        return true;
    const Eigen::Index n = index(touch.state.size());
    std::vector<double> inputs = touch.state;
    inputs.insert(inputs.end(), touch.parameters.begin(), touch.parameters.end());
    const std::vector<double> entries = compiled.jacobian(inputs);
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(n, n);
    for (const std::size_t i : compiled.changed)
        change(index(i), index(i)) = -1;
    for (std::size_t k = 0; k < compiled.entries.size(); ++k)
        if (index(compiled.entries[k].column) < n)
            change(index(compiled.entries[k].row), index(compiled.entries[k].column)) += entries[k];
    change -= change * sizes.off_surface(geometry) * geometry.gradient.head(n).transpose();
    const Eigen::VectorXd& units = sizes.scales();
    return (units.cwiseInverse().asDiagonal() * change * units.asDiagonal()).norm() <= small;
}

/// Returns why the jumps into the sliding mode and back are not negligible; empty if they are.
std::string problem_of(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                       const TouchSizes& sizes, std::span<const std::size_t> contacts, const Eigen::VectorXd& gain) {
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
              small * gain.cwiseQuotient(units).norm()))
            return refused;
    }
    return {};
}

} // namespace

SlidingContact sliding_contact(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                               const TouchSizes& sizes, std::size_t mode, std::span<const std::size_t> contacts) {
    const Eigen::Index n = index(touch.state.size());
    const Model& model = functions.system().model();
    const FieldDifference difference = difference_of(functions.system(), touch, mode);
    const std::string &name = model.modes[mode].name, &own = model.modes[touch.mode].name;
    SlidingContact result;
    const auto fail = [&](std::string reason) {
        result.reason = std::move(reason);
        return result;
    };
    const Eigen::VectorXd& units = sizes.scales();
    if (!difference.derivatives.allFinite() || !difference.second.allFinite() || !difference.of_field.allFinite() ||
        !std::isfinite(difference.jerk) || !((difference.value.cwiseQuotient(units) * sizes.time()).norm() <= small))
        return fail(fmt::format("the vector field of mode '{}' is different at the touch", name));
    const double a = geometry.acceleration;
    const Eigen::VectorXd gradient = geometry.gradient.head(n), rate_gradient = geometry.rate_gradient.head(n);
    const Eigen::VectorXd slowing = difference.derivatives * geometry.field / a; // M
    const Eigen::VectorXd off = difference.derivatives * sizes.off_surface(geometry);
    const auto scaled = [&](const Eigen::MatrixXd& matrix) {
        return (units.cwiseInverse().asDiagonal() * matrix * units.asDiagonal()).norm();
    };
    if (!(scaled(difference.derivatives - off * gradient.transpose() - slowing * rate_gradient.transpose()) <=
          small * scaled(difference.derivatives)))
        return fail(
            fmt::format("the field of mode '{}' is not that of mode '{}' wherever the surface is touched", name, own));
    // Second derivative of D, on the surface.
    const Eigen::VectorXd bend = difference.second - a * off - difference.jerk * slowing;
    const double terms = gradient.cwiseAbs().dot(difference.second.cwiseAbs() + a * off.cwiseAbs() +
                                                 std::abs(difference.jerk) * slowing.cwiseAbs());
    if (!(std::abs(gradient.dot(slowing) + 1) <= small) ||
        !(std::abs(gradient.dot(bend)) <= small * (terms + std::abs(a) / sizes.time())))
        return fail(
            fmt::format("mode '{}' does not stay on the surface of event '{}'", name, model.events[touch.event].name));
    result.gain = -slowing;
    result.reason = problem_of(functions, touch, geometry, sizes, contacts, result.gain);
    const Eigen::VectorXd by_time =
        bend / 6 - a / 3 * (rate_gradient.dot(slowing) * slowing + difference.of_field * slowing);
    result.next = by_time * std::pow(2 / a, 1.5);
    return result;
}

} // namespace graze
