#include "sweep/equilibrium.hpp"

#include "base/decompositions.hpp"
#include "base/linear_systems.hpp"
#include "flow/cyclic.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>

namespace graze {

namespace {

constexpr std::size_t most_newton_steps = 20;
constexpr double furthest = 3;               ///< largest correction, relative to the extent of the motion
constexpr double converged = 1e-14;          ///< corrections that are round-off
constexpr double round_off_of_field = 1e-10; ///< the same where the field is a small difference
constexpr std::size_t phases = 16;           ///< number of clock phases at which the field must vanish
constexpr double neutral_rate = 1e-10;       ///< relative real part that is indistinguishable from zero
constexpr double nearly = 0.1;               ///< allowed nonlinear part relative to the linear part
constexpr double ill = 1e-7;                 ///< reciprocal condition number of nearly parallel eigenvectors
constexpr double largest_number = 1e150;     ///< beyond which squares leave the range of numbers
constexpr double unbalanced = 1e3; ///< ratio of row and column sizes of the field above which scales are meaningless

/// Returns element k of a fixed, evenly spread sequence in [-1, 1].
double spread_number(std::size_t k) {
    return 2 * even_place(k) - 1;
}

} // namespace

bool Equilibrium::is_stable() const {
    return !driven && (values.size() == 0 || growth() < -neutral_rate * largest_rate());
}

bool Equilibrium::is_unstable() const {
    return !driven && values.size() > 0 && growth() > neutral_rate * largest_rate();
}

void EquilibriumFinder::begin(std::span<const double> parameters, std::span<const double> periods) {
    workspace_ = field_->workspace(parameters);
    periods_.assign(periods.begin(), periods.end());
}

std::span<const double> EquilibriumFinder::rates(std::span<const double> state, std::size_t mode) {
    field_->evaluate_rates(workspace_, mode, state);
    return workspace_.rates;
}

bool EquilibriumFinder::is_clock(std::size_t index, std::span<const double> state, std::size_t mode) {
    field_->evaluate(workspace_, mode, state);
    const std::span<const double> row(&workspace_.jacobian[index * state.size()], state.size());
    return periods_[index] > 0 && std::ranges::all_of(row, [](double x) { return x == 0; });
}

double EquilibriumFinder::linear_length(std::span<const double> state, std::size_t mode, std::size_t index,
                                        double from) {
    std::vector<double> at(state.begin(), state.end());
    double first = 0;
    for (double value = from; value < largest_number; value *= 10) {
        at[index] = value;
        field_->evaluate_rates(workspace_, mode, at);
        const double rate = workspace_.rates[index] / value;
        if (value == from)
            first = rate;
        else if (!(std::abs(rate - first) <= nearly * std::abs(first)))
            return 0.1 * value;
    }
    return 0;
}

std::optional<Equilibrium> EquilibriumFinder::find(std::span<const double> state, std::size_t mode,
                                                   std::span<const double> extents) {
    Equilibrium result;
    result.state.assign(state.begin(), state.end());
    result.mode = mode;
    if (!classify(result) || !solve(result, extents) || !rests_at_all_phases(result) || !find_basis(result))
        return std::nullopt;
    return result;
}

/// Classifies the states. @return false if one moves steadily
bool EquilibriumFinder::classify(Equilibrium& equilibrium) {
    const std::size_t count = field_->states();
    field_->evaluate(workspace_, equilibrium.mode, equilibrium.state);
    clocks_.clear();
    for (std::size_t i = 0; i < count; ++i) {
        if (field_->system().model().states[i].drifting)
            continue;
        const std::span<const double> row(&workspace_.jacobian[i * count], count);
        if (!std::isfinite(workspace_.rates[i]) || !std::ranges::all_of(row, [](double x) { return std::isfinite(x); }))
            return false;
        const bool constant = std::ranges::all_of(row, [](double x) { return x == 0; });
        if (!constant)
            equilibrium.active.push_back(i);
        else if (workspace_.rates[i] != 0 && !(periods_[i] > 0))
            return false;
        else if (workspace_.rates[i] != 0)
            clocks_.push_back(i);
    }
    return true;
}

/// Returns the rates of the active states in their scales, and sets their derivatives.
Eigen::VectorXd EquilibriumFinder::linearise(const Equilibrium& equilibrium, std::span<const double> state,
                                             Eigen::MatrixXd& field) {
    field_->evaluate(workspace_, equilibrium.mode, state);
    const Eigen::Index size = equilibrium.scale.size();
    Eigen::VectorXd rates(size);
    for (Eigen::Index i = 0; i < size; ++i) {
        const std::size_t row = equilibrium.place(i);
        rates[i] = workspace_.rates[row] / equilibrium.scale[i];
        for (Eigen::Index j = 0; j < size; ++j)
            field(i, j) = workspace_.jacobian[row * state.size() + equilibrium.place(j)] * equilibrium.scale[j] /
                          equilibrium.scale[i];
    }
    return rates;
}

bool EquilibriumFinder::solve(Equilibrium& equilibrium, std::span<const double> extents) {
    const auto size = static_cast<Eigen::Index>(equilibrium.active.size());
    equilibrium.scale.resize(size);
    equilibrium.field.resize(size, size);
    std::vector<bool> has_size(static_cast<std::size_t>(size));
    for (Eigen::Index i = 0; i < size; ++i) {
        const std::size_t state = equilibrium.place(i);
        const double largest = std::max(extents[state], std::abs(equilibrium.state[state]));
        equilibrium.scale[i] = periods_[state] > 0 ? periods_[state] : largest > 0 ? largest : 1;
        has_size[static_cast<std::size_t>(i)] = periods_[state] > 0 || largest > 0;
    }
    double before = std::numeric_limits<double>::infinity();
    for (std::size_t iteration = 0; iteration < most_newton_steps && size > 0; ++iteration) {
        Eigen::VectorXd rates = linearise(equilibrium, equilibrium.state, equilibrium.field);
        if (!equilibrium.field.allFinite() || !rates.allFinite())
            return false;
        if (iteration == 0) {
            const Eigen::VectorXd given = equilibrium.scale;
            balance(equilibrium, has_size);
            rates = rates.cwiseProduct(given).cwiseQuotient(equilibrium.scale);
        }
        const CheckedLU factors(equilibrium.field);
        if (!factors.is_invertible())
            return false;
        const Eigen::VectorXd correction = factors.solve(rates);
        const double length = correction.cwiseAbs().maxCoeff();
        if (!(length <= furthest))
            return false;
        for (Eigen::Index i = 0; i < size; ++i) {
            const std::size_t state = equilibrium.place(i);
            const double was = equilibrium.state[state];
            equilibrium.state[state] -= correction[i] * equilibrium.scale[i];
            // In the convergence to zero, each step squares the value.
            const double left = equilibrium.state[state] * std::copysign(1, was);
            if (field_->keeps_sign(state) && !(left > converged * std::abs(was)))
                equilibrium.state[state] = 0;
        }
        if (length < converged || (length < round_off_of_field && length >= 0.5 * before))
            return true;
        before = length;
    }
    return size == 0;
}

/// A state that is moved only by rounding, such as the velocity of a body at rest, has no scale of its own: its scale
/// follows from its rate and its influence on other states. Other scales are kept or increased.
void EquilibriumFinder::balance(Equilibrium& equilibrium, const std::vector<bool>& has_size) const {
    const auto size = equilibrium.scale.size();
    Eigen::MatrixXd& field = equilibrium.field;
    bool changed = true;
    for (Eigen::Index sweep = 0; sweep < size && changed; ++sweep) {
        changed = false;
        for (Eigen::Index i = 0; i < size; ++i) {
            double row = 0, column = 0;
            for (Eigen::Index j = 0; j < size; ++j)
                if (j != i) {
                    row = std::max(row, std::abs(field(i, j)));
                    column = std::max(column, std::abs(field(j, i)));
                }
            const double ratio = std::sqrt(row / column);
            const bool raised = ratio > unbalanced, lowered = ratio < 1 / unbalanced;
            if (!(row > 0 && column > 0) || !(raised || (lowered && !has_size[static_cast<std::size_t>(i)])))
                continue;
            equilibrium.scale[i] *= ratio;
            field.row(i) /= ratio;
            field.col(i) *= ratio;
            changed = true;
        }
    }
}

/// Returns value k of a clock among evenly spread ones.
double EquilibriumFinder::phase_of(std::size_t k, std::size_t clock) const {
    return periods_[clocks_[clock]] * 0.5 * (1 + spread_number(k * (clock + 1) + 3 * clock));
}

/// A clock may disturb a state that is at rest at one of its phases only.
bool EquilibriumFinder::rests_at_all_phases(Equilibrium& equilibrium) {
    if (clocks_.empty() || equilibrium.active.empty())
        return true;
    const CheckedLU factors(equilibrium.field);
    Eigen::MatrixXd now = equilibrium.field;
    const double largest = equilibrium.field.cwiseAbs().maxCoeff();
    std::vector<double> at = equilibrium.state;
    for (std::size_t k = 0; k < phases; ++k) {
        for (std::size_t c = 0; c < clocks_.size(); ++c)
            at[clocks_[c]] = phase_of(k, c);
        const Eigen::VectorXd rates = linearise(equilibrium, at, now);
        if (!((now - equilibrium.field).cwiseAbs().array() <= round_off_of_field * largest).all())
            equilibrium.driven = true;
        if (!(factors.solve(rates).cwiseAbs().maxCoeff() <= round_off_of_field))
            return false;
    }
    return true;
}

bool EquilibriumFinder::find_basis(Equilibrium& equilibrium) const {
    const auto size = static_cast<Eigen::Index>(equilibrium.active.size());
    if (size == 0)
        return true;
    const auto system = eigensystem(equilibrium.field);
    if (!system)
        return false;
    std::vector<Eigen::Index> order(static_cast<std::size_t>(size));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::ranges::stable_sort(order,
                             [&](auto a, auto b) { return system->values[a].real() > system->values[b].real(); });
    const Eigen::MatrixXcd& vectors = system->vectors;
    equilibrium.values.resize(size);
    equilibrium.basis.resize(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
        equilibrium.values[i] = system->values[order[static_cast<std::size_t>(i)]];
        equilibrium.basis.col(i) = vectors.col(order[static_cast<std::size_t>(i)]);
    }
    equilibrium.leading_direction = equilibrium.basis.col(0).real();
    const Eigen::VectorXd singular = singular_values(equilibrium.basis);
    if (!(singular[size - 1] > ill * singular[0])) {
        // Nearly parallel eigenvectors: use a Schur basis, with columns shortened until the coupling is small.
        const auto schur = schur_form(equilibrium.field);
        if (!schur)
            return false;
        const double slowest = equilibrium.values.real().cwiseAbs().minCoeff();
        equilibrium.basis = schur->unitary;
        equilibrium.inverse = schur->unitary.adjoint();
        double weight = 1;
        for (Eigen::Index i = 1; i < size; ++i) {
            const double coupling = schur->triangle.col(i).head(i).cwiseAbs().maxCoeff();
            if (coupling > nearly * slowest)
                weight *= nearly * slowest / coupling;
            equilibrium.basis.col(i) *= weight;
            equilibrium.inverse.row(i) /= weight;
        }
    } else {
        const ComplexLU factors(equilibrium.basis);
        equilibrium.inverse.resize(size, size);
        for (Eigen::Index i = 0; i < size; ++i)
            equilibrium.inverse.col(i) = factors.solve(Eigen::VectorXcd::Unit(size, i));
    }
    return equilibrium.inverse.allFinite();
}

double EquilibriumFinder::distance(const Equilibrium& equilibrium, std::span<const double> state) const {
    Eigen::VectorXd deviation(equilibrium.scale.size());
    for (Eigen::Index i = 0; i < deviation.size(); ++i) {
        const std::size_t index = equilibrium.place(i);
        deviation[i] = without_turns(state[index] - equilibrium.state[index], periods_[index]) / equilibrium.scale[i];
    }
    return (equilibrium.inverse * deviation).norm();
}

/// Returns the nonlinear part of the field in the basis, less its possible round-off.
double EquilibriumFinder::remainder(const Equilibrium& equilibrium, const Eigen::VectorXd& deviation) {
    constexpr double noise = 1e-13;
    std::vector<double> at = equilibrium.state;
    const auto size = equilibrium.scale.size();
    Eigen::VectorXd rest(size);
    double offset = 0;
    for (Eigen::Index i = 0; i < size; ++i) {
        const std::size_t index = equilibrium.place(i);
        offset = std::max(offset, std::abs(equilibrium.state[index]) / equilibrium.scale[i]);
        at[index] += deviation[i] * equilibrium.scale[i];
    }
    field_->evaluate_rates(workspace_, equilibrium.mode, at);
    for (Eigen::Index i = 0; i < size; ++i)
        rest[i] = workspace_.rates[equilibrium.place(i)] / equilibrium.scale[i];
    rest -= equilibrium.field * deviation;
    const double size_of_field = equilibrium.field.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < size; ++i) {
        const double lost = noise * size_of_field * (offset + deviation.cwiseAbs().maxCoeff());
        rest[i] = std::abs(rest[i]) > lost ? rest[i] : 0;
    }
    return (equilibrium.inverse * rest).norm();
}

bool EquilibriumFinder::events_are_away(const Equilibrium& equilibrium, double distance) {
    const auto size = static_cast<Eigen::Index>(equilibrium.active.size());
    const std::size_t count = field_->states();
    const std::size_t watched = field_->system().mode(equilibrium.mode).watched.size();
    std::vector<double> at = equilibrium.state;
    std::vector<int> sides(watched, 0);
    for (std::size_t k = 0; watched > 0 && k < (clocks_.empty() ? 1 : phases); ++k) {
        for (std::size_t c = 0; c < clocks_.size() && k > 0; ++c)
            at[clocks_[c]] = phase_of(k, c);
        field_->evaluate_events(workspace_, equilibrium.mode, at);
        for (std::size_t w = 0; w < watched; ++w) {
            const double value = workspace_.events[w];
            Eigen::RowVectorXcd gradient = Eigen::RowVectorXcd::Zero(size);
            for (Eigen::Index i = 0; i < size; ++i)
                gradient[i] = workspace_.event_gradients[w * count + equilibrium.place(i)] * equilibrium.scale[i];
            const double change = size > 0 ? (gradient * equilibrium.basis).norm() * distance : 0;
            const int side = value > 0 ? 1 : -1;
            if (!(std::abs(value) > 0 && change <= 0.5 * std::abs(value)) || (sides[w] != 0 && sides[w] != side))
                return false;
            sides[w] = side;
            // An event that the clock causes may be short: sampling phases cannot exclude it.
            for (const std::size_t clock : clocks_)
                if (workspace_.event_gradients[w * count + clock] != 0)
                    return false;
        }
    }
    return true;
}

bool EquilibriumFinder::is_linear_within(const Equilibrium& equilibrium, double distance, bool strict) {
    constexpr std::size_t directions = 48;
    if (!events_are_away(equilibrium, distance))
        return false;
    const auto size = equilibrium.scale.size();
    if (distance == 0 || size == 0)
        return true;
    const double rate = strict ? equilibrium.values.real().cwiseAbs().minCoeff() : equilibrium.largest_rate();
    const auto small_at = [&](const Eigen::VectorXd& direction) {
        const double length = (equilibrium.inverse * direction).norm();
        if (!(length > 0))
            return true;
        bool small = true;
        for (const double share : {1.0, 0.5})
            small = small &&
                    remainder(equilibrium, direction * (share * distance / length)) <= nearly * rate * share * distance;
        return small;
    };
    for (Eigen::Index i = 0; i < size; ++i)
        if (!small_at(Eigen::VectorXd::Unit(size, i)) || !small_at(-Eigen::VectorXd::Unit(size, i)))
            return false;
    std::size_t number = 0;
    for (std::size_t k = 0; k < directions; ++k) {
        Eigen::VectorXcd mixture(size);
        for (Eigen::Index i = 0; i < size; ++i) {
            mixture[i] = {spread_number(number), spread_number(3 * number + 1)};
            number += 1;
        }
        if (!small_at((equilibrium.basis * mixture).real()))
            return false;
    }
    return true;
}

std::vector<double> EquilibriumFinder::displaced(const Equilibrium& equilibrium, double share,
                                                 std::span<const double> motion) {
    constexpr double shortest = 1e-30;
    constexpr double visible = 1e-12; ///< smallest displacement relative to the state
    const auto size = equilibrium.scale.size();
    const Eigen::VectorXd direction =
        equilibrium.leading_direction / equilibrium.leading_direction.cwiseAbs().maxCoeff();
    double offset = 0;
    for (Eigen::Index i = 0; i < size; ++i)
        offset = std::max(offset, std::abs(equilibrium.state[equilibrium.place(i)]) / equilibrium.scale[i]);
    // The length over which the field is linear is determined from the field itself, independent of units.
    const double first = std::max(shortest, 1e-8 * offset);
    // Motions about a focus rotate through all directions of their plane.
    std::vector<Eigen::VectorXd> directions{direction};
    if (const double turn = std::abs(equilibrium.values[0].imag()); turn > 0) {
        const Eigen::VectorXd across = (equilibrium.field * direction - equilibrium.growth() * direction) / turn;
        directions.insert(directions.end(), {across, direction + across, direction - across});
    }
    double length = first, reach = 0;
    for (const Eigen::VectorXd& one : directions)
        reach = std::max(reach, one.cwiseProduct(equilibrium.scale).cwiseAbs().maxCoeff());
    const double longest = largest_number / reach; // even if the extent of the motion is tiny
    const auto is_linear = [&](const Eigen::VectorXd& one) {
        const double linear = (equilibrium.inverse * (equilibrium.field * one)).norm() * length;
        return remainder(equilibrium, one * length) <= nearly * linear &&
               events_are_away(equilibrium, (equilibrium.inverse * one).norm() * length);
    };
    while (length < longest && std::ranges::all_of(directions, is_linear))
        length *= 10;
    if (length >= longest)
        length = std::max(1.0, offset);
    std::vector<double> state = equilibrium.state;
    const auto is_on_edge = [&](Eigen::Index i) {
        const std::size_t index = equilibrium.place(i);
        return field_->keeps_sign(index) && state[index] == 0;
    };
    // Displace states that keep their signs, such as populations, to positive values or to the side of the motion.
    double side = 1, strongest = 0;
    for (Eigen::Index i = 0; i < size; ++i)
        if (is_on_edge(i) && std::abs(direction[i]) > strongest) {
            strongest = std::abs(direction[i]);
            side = (motion[equilibrium.place(i)] < 0) == (direction[i] < 0) ? 1 : -1;
        }
    for (Eigen::Index i = 0; i < size; ++i) {
        const std::size_t index = equilibrium.place(i);
        const double change = side * std::max(share * length, visible * offset) * direction[i] * equilibrium.scale[i];
        if (!is_on_edge(i) || (motion[index] < 0) == (change < 0))
            state[index] += change;
    }
    return state;
}

} // namespace graze
