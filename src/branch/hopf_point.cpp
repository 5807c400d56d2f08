#include "branch/hopf_point.hpp"

#include "base/decompositions.hpp"
#include "base/linear_systems.hpp"
#include "orbit/eigen_index.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace graze {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The scaled vector field of a mode, in units of an orbit's frequency.
class Field {
public:
    Field(const System& system, std::size_t mode, std::span<const double> parameters, ParameterId parameter,
          double frequency, std::span<const double> scales)
        : place_(system.states() + parameter.place()), frequency_(frequency), scales_(scales.begin(), scales.end()),
          inputs_(system.states()) {
        inputs_.insert(inputs_.end(), parameters.begin(), parameters.end());
        Model model = system.model();
        for (const Expression& rate : model.modes[mode].rates)
            rates_.push_back(system.with_gradient(model.expand(rate)));
    }

    /// Moves a state to the equilibrium at a value of the parameter by Newton's method. @return the Jacobian there;
    /// empty if it does not converge
    std::optional<MatrixXd> find_equilibrium(std::vector<double>& state, double value) {
        constexpr int most = 40;
        constexpr double close = 1e-9; // below this, corrections that do not shrink are round-off
        inputs_[place_] = value;
        double before = std::numeric_limits<double>::infinity();
        for (int i = 0; i < most; ++i) {
            evaluate(state);
            const VectorXd step = shortest_solution(matrix_, -values_);
            const double size = step.norm();
            if (!std::isfinite(size))
                return std::nullopt;
            if (size == 0 || (before < close && size >= 0.5 * before))
                return matrix_;
            before = size;
            entries_of(state) += step.cwiseProduct(vector_of(scales_));
        }
        return std::nullopt;
    }

private:
    void evaluate(const std::vector<double>& state) {
        const std::size_t n = state.size();
        std::copy(state.begin(), state.end(), inputs_.begin());
        values_.resize(index(n));
        matrix_.resize(index(n), index(n));
        for (std::size_t i = 0; i < n; ++i) {
            const std::vector<double> all = rates_[i](inputs_);
            const double unit = scales_[i] * frequency_;
            values_[index(i)] = all[0] / unit;
            for (std::size_t k = 0; k < n; ++k)
                matrix_(index(i), index(k)) = all[1 + k] * scales_[k] / unit;
        }
    }

    std::size_t place_;
    double frequency_;
    std::vector<double> scales_, inputs_;
    std::vector<Function> rates_;
    VectorXd values_;
    MatrixXd matrix_;
};

/// Returns the eigenvalue in the upper half plane nearest to i; empty if there is none.
std::optional<std::complex<double>> oscillation_of(const MatrixXd& matrix) {
    const auto values = eigenvalues(matrix);
    std::optional<std::complex<double>> nearest;
    if (!values)
        return nearest;
    const std::complex<double> wanted(0, 1);
    for (const std::complex<double> one : *values)
        if (one.imag() > 0 && (!nearest || std::abs(one - wanted) < std::abs(*nearest - wanted)))
            nearest = one;
    return nearest;
}

} // namespace

std::optional<HopfPoint> hopf_near(const System& system, std::size_t mode, std::span<const double> state,
                                   std::span<const double> parameters, ParameterId parameter, double period,
                                   std::span<const double> scales) {
    constexpr int most = 40;
    constexpr double first = 1e-4, small = 1e-8;
    // Relative errors of an eigenvalue (against the matrix norm) and of a number.
    constexpr double round_off = 1e-14, last_digits = 1e-15;
    const double frequency = 2 * std::numbers::pi / period;
    Field field(system, mode, parameters, parameter, frequency, scales);
    HopfPoint point;
    point.state.assign(state.begin(), state.end());
    std::complex<double> eigenvalue;
    double norm = 0;
    const auto growth = [&](double value) {
        const auto matrix = field.find_equilibrium(point.state, value);
        const auto found = matrix ? oscillation_of(*matrix) : std::nullopt;
        if (!found)
            return std::numeric_limits<double>::quiet_NaN();
        norm = matrix->norm();
        eigenvalue = *found;
        return eigenvalue.real();
    };
    const double begin = parameters[parameter.place()];
    double older = begin, older_growth = growth(older);
    double value = begin + first * std::max(std::abs(begin), first), here = growth(value), slope = 0;
    for (int i = 0;; ++i) {
        if (!std::isfinite(here) || !std::isfinite(older_growth) || i > most)
            return std::nullopt;
        const double change = value - older;
        if (here == older_growth || here == 0)
            break;
        slope = (here - older_growth) / change;
        const double step = -here / slope;
        const bool is_close = std::abs(here) < small;
        if (is_close && std::abs(step) >= 0.5 * std::abs(change))
            break; // round-off
        older = value;
        older_growth = here;
        value += step;
        if (value == older)
            break;
        here = growth(value);
    }
    if (!(std::abs(here) < small) || !(std::abs(slope) > 0))
        return std::nullopt;
    point.parameter = value;
    point.period = 2 * std::numbers::pi / (eigenvalue.imag() * frequency);
    point.error = (std::abs(here) + round_off * norm) / std::abs(slope) + last_digits * std::abs(value);
    return point;
}

} // namespace graze
