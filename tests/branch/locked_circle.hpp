// A map whose tongue is known in closed form: on the circle |z| = 1, to which distances from it decay, the angle
// advances by 2 pi (2/5 + p/10) + e sin(5 angle). An orbit of five returns is at each angle, at its own p.

#pragma once

#include "branch/torus_problem.hpp"
#include "graze/branch/torus.hpp"
#include "maps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace graze::testing {

class LockedCircle {
public:
    explicit LockedCircle(double e)
        : e_(e), model_(map_of(e)), simulation_(System(model_)), orbit_(fixed_point(model_, {1, 0})) {
        setting.active = {0, 1};
        setting.scales = Eigen::VectorXd::Ones(3);
        setting.parameter_scale = 0.1;
        setting.parameter = model_.independent_parameter("p");
        setting.back = std::make_shared<SignatureReturn>(simulation_, orbit_, setting.parameter, setting.scales);
        circle = {{0}, 0.4, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    }

    double parameter_at(double angle) const { return -e_ * std::sin(5 * angle) / (0.2 * std::numbers::pi); }

    TorusSetting setting;
    Torus circle;

private:
    static Model map_of(double e) {
        const std::string size = "(1 + (1 - x^2 - y^2)/4)",
                          turn = fmt::format("(2*pi*(0.4 + 0.1*p) + {}*(5*x^4*y - 10*x^2*y^3 + y^5))", e);
        return map_model("p = 0", {size + "*(x*cos" + turn + " - y*sin" + turn + ")",
                                   size + "*(x*sin" + turn + " + y*cos" + turn + ")"});
    }

    double e_;
    Model model_;
    Simulation simulation_;
    Orbit orbit_;
};

} // namespace graze::testing
