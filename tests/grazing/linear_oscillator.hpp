// Linear oscillators with one and two degrees of freedom that touch a stop, with closed forms.

#pragma once

#include "orbit/orbits.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <string>

namespace graze::testing {

/// q'' + C q' + K q = f cos(omega t), with a stop at q_1 = sigma that the steady motion just reaches for force = 1.
struct LinearOscillator {
    Eigen::MatrixXd damping, stiffness;
    Eigen::VectorXd force;
    double omega = 1, restitution = 0.8;
    double length = 1, clock = 1; ///< units of length and time
    double wall = 0; ///< amplitude of a moving frame of reference, in which the stop oscillates; 0: frame at rest

    std::size_t degrees() const { return static_cast<std::size_t>(force.size()); }
    Eigen::VectorXcd amplitude() const {
        const std::complex<double> i(0, 1);
        const Eigen::MatrixXcd dynamic =
            (stiffness - omega * omega * Eigen::MatrixXd::Identity(force.size(), force.size()))
                .cast<std::complex<double>>() +
            i * omega * damping.cast<std::complex<double>>();
        return dynamic.fullPivLu().solve(force.cast<std::complex<double>>());
    }
    double stop() const { return std::abs(amplitude()[0]); }
    double period() const { return 2 * std::numbers::pi / omega; }
    /// Returns the matrix of (q, q') over one period: exp(A T).
    Eigen::MatrixXd return_map() const {
        const Eigen::Index n = force.size();
        Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * n, 2 * n);
        a.topRightCorner(n, n).setIdentity();
        a.bottomLeftCorner(n, n) = -stiffness;
        a.bottomRightCorner(n, n) = -damping;
        // Scaling and squaring of a Taylor series.
        constexpr int squarings = 16, terms = 20;
        const Eigen::MatrixXd small = a * period() / std::pow(2.0, squarings);
        Eigen::MatrixXd term = Eigen::MatrixXd::Identity(2 * n, 2 * n), sum = term;
        for (int k = 1; k <= terms; ++k) {
            term = (term * small / static_cast<double>(k)).eval();
            sum += term;
        }
        for (int k = 0; k < squarings; ++k)
            sum = (sum * sum).eval();
        return sum;
    }
    /// Returns the change of the clearance k periods after an impact of unit speed at the stop, which subtracts 1 + e
    /// from q_1'.
    double projection(int k) const {
        Eigen::VectorXd state = Eigen::VectorXd::Zero(2 * force.size());
        state[force.size()] = -(1 + restitution);
        const Eigen::MatrixXd once = return_map();
        for (int i = 0; i < k; ++i)
            state = (once * state).eval();
        return -state[0];
    }
    double acceleration() const { return omega * omega * stop(); }

    /// Returns the model in the chosen units. @param contact modes and transitions at the stop; empty: a rigid impact.
    /// In it, RATES, JUMP and HELD stand for the free rates, the velocity after an impact and the rates with a spring k
    /// behind the stop
    Model model(const std::string& contact = "") const {
        const std::size_t n = degrees();
        std::string states, rates;
        for (std::size_t i = 0; i < n; ++i) {
            if (i > 0 || wall == 0)
                states += fmt::format("q{} = 0\nv{} = 0\n", i, i);
            std::string rate = fmt::format("force*({:.17g})*cos(theta)", force[idx(i)] * length / (clock * clock));
            for (std::size_t j = 0; j < n; ++j)
                rate += fmt::format(" - ({:.17g})*v{} - ({:.17g})*q{}", damping(idx(i), idx(j)) / clock, j,
                                    stiffness(idx(i), idx(j)) / (clock * clock), j);
            if (i > 0 || wall == 0)
                rates += fmt::format("q{} = \"v{}\"\nv{} = \"{}\"\n", i, i, i, rate);
            else
                rates += fmt::format("p = \"u\"\nu = \"{} - wall*omega^2*sin(theta)\"\n", rate);
        }
        std::string moving;
        if (wall != 0) {
            states += "p = 0\nu = 0\n";
            moving = "[definitions]\nq0 = \"p - wall*sin(theta)\"\nv0 = \"u - wall*omega*cos(theta)\"\n";
        }
        const std::string rest =
            contact.empty() ? "[modes.free]\nwatch = ['stop']\n[modes.free.rates]\nRATES\n[jumps.impact]\nJUMP\n" +
                                  transition("free", "stop", "free", "impact", "impact")
                            : contact;
        std::string text = fmt::format(R"toml(
[parameters]
force = 1
sigma = {:.17g}
omega = {:.17g}
e = {:.17g}
wall = {:.17g}
{}[states]
{}theta = {{ initial = 0, period = "2*pi" }}
[events.stop]
function = "sigma - q0"
)toml",
                                       stop() * length, omega / clock, restitution, wall * length, moving, states) +
                           at_phase(0) + rest;
        for (std::size_t at; (at = text.find("RATES")) != std::string::npos;)
            text.replace(at, 5, rates + "theta = \"omega\"");
        if (const std::size_t at = text.find("JUMP"); at != std::string::npos)
            text.replace(at, 4, wall == 0 ? "v0 = \"-e*v0\"" : "u = \"wall*omega*cos(theta) - e*v0\"");
        for (std::size_t at; (at = text.find("HELD")) != std::string::npos;) {
            std::string held = rates + "theta = \"omega\"";
            held.insert(held.find("v0 = \"") + 6, "k*(sigma - q0) + ");
            text.replace(at, 4, held);
        }
        return model_from(text);
    }
    /// Returns the steady motion, which touches the stop.
    Orbit orbit(const Model& made) const {
        std::vector<double> start;
        const Eigen::VectorXcd motion = amplitude();
        const std::complex<double> i(0, 1);
        for (Eigen::Index k = 0; k < motion.size(); ++k)
            for (const double one : {motion[k].real() * length, (i * omega * motion[k]).real() * length / clock})
                start.push_back(one);
        if (wall != 0) { // the model then lists the state of the first mass last
            start[1] += wall * omega * length / clock;
            std::rotate(start.begin(), start.begin() + 2, start.end());
        }
        start.push_back(0);
        return given_orbit(made, "free:start", {start}, {period() * clock});
    }
    static Eigen::Index idx(std::size_t i) { return static_cast<Eigen::Index>(i); }
};

inline LinearOscillator one_degree(double zeta, double omega, double restitution) {
    LinearOscillator result;
    result.damping = Eigen::MatrixXd::Constant(1, 1, 2 * zeta);
    result.stiffness = Eigen::MatrixXd::Constant(1, 1, 1);
    result.force = Eigen::VectorXd::Constant(1, 1);
    result.omega = omega;
    result.restitution = restitution;
    return result;
}

/// Two masses in a chain with Rayleigh damping.
inline LinearOscillator two_degrees(double coupling, double zeta, double omega, double restitution, double other) {
    LinearOscillator result;
    result.stiffness.resize(2, 2);
    result.stiffness << 1 + coupling, -coupling, -coupling, 1.7 + coupling;
    result.damping = 2 * zeta * (0.6 * Eigen::MatrixXd::Identity(2, 2) + 0.4 * result.stiffness);
    result.force.resize(2);
    result.force << 1, other;
    result.omega = omega;
    result.restitution = restitution;
    return result;
}

} // namespace graze::testing
