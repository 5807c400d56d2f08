#include "grazing/compliant_contact.hpp"

#include "grazing/field_difference.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

CompliantContact compliant_contact(const TouchFunctions& functions, const TouchState& touch,
                                   const TouchGeometry& geometry, const TouchSizes& sizes, std::size_t mode) {
    constexpr double small = 1e-6;
    const Eigen::Index n = index(touch.state.size());
    const FieldDifference difference = difference_of(functions.system(), touch, mode);
    const std::string& name = functions.system().model().modes[mode].name;
    CompliantContact result;
    const auto fail = [&](std::string reason) {
        result.reason = std::move(reason);
        return result;
    };
    const Eigen::VectorXd& units = sizes.scales();
    const double force = (difference.value.cwiseQuotient(units) * sizes.time()).norm();
    if (!difference.derivatives.allFinite() || !difference.second.allFinite() || !(force <= small))
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
    if (!(rest.norm() <= small * whole.norm()))
        return fail(fmt::format("the field of mode '{}' is not that of mode '{}' wherever the surface is touched", name,
                                functions.system().model().modes[touch.mode].name));
    if (!(std::abs(gradient.dot(damping)) <= small))
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

} // namespace graze
