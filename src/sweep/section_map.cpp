#include "sweep/section_map.hpp"

#include "base/decompositions.hpp"
#include "base/leading_eigenvalues.hpp"
#include "base/linear_systems.hpp"
#include "base/many_states.hpp"
#include "flow/cyclic.hpp"
#include "graze/symbolic/transform.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace graze {

namespace {

constexpr double simultaneous_phase = 1e-10; ///< relative to the period

/// Returns rows and columns of the active states, in units of their scales.
Eigen::MatrixXd scaled_matrix(const ReturnJacobian& jacobian, const Eigen::VectorXd& scale) {
    const auto size = static_cast<Eigen::Index>(jacobian.active.size());
    Eigen::MatrixXd matrix(size, size);
    for (Eigen::Index i = 0; i < size; ++i)
        for (Eigen::Index j = 0; j < size; ++j) {
            const auto row = static_cast<Eigen::Index>(jacobian.active[static_cast<std::size_t>(i)]);
            const auto column = static_cast<Eigen::Index>(jacobian.active[static_cast<std::size_t>(j)]);
            matrix(i, j) = jacobian.matrix(row, column) * scale[column] / scale[row];
        }
    return matrix;
}

/// Returns the solution of many equations that are regular by far; nothing where they are few or may be singular.
std::optional<Eigen::VectorXd> solution_of_many(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
    constexpr double regular_by_far = 1e-8; // reciprocal condition number
    if (matrix.rows() <= many_states)
        return std::nullopt;
    const PartialLU factors(matrix);
    if (!(factors.reciprocal_condition() > regular_by_far))
        return std::nullopt;
    return factors.solve(right);
}

/// The eigenvalues of a matrix, and right and left eigenvectors of the largest one.
struct Leading {
    Eigen::VectorXcd values;
    std::vector<Eigen::Index> order; ///< largest first
    Eigen::VectorXcd right, left;
};

/// Finds the eigenvectors of an eigenvalue by inverse iteration, in a fraction of the time that those of all take.
bool find_vectors(const Eigen::MatrixXd& matrix, std::complex<double> value, Leading& result) {
    constexpr double beside = 1e-10; // relative to the matrix: the factors must be regular
    constexpr int iterations = 3;
    const Eigen::Index size = matrix.rows();
    const std::complex<double> shift = value + beside * matrix.norm() / std::sqrt(static_cast<double>(size));
    const ComplexLU factors(matrix - shift * Eigen::MatrixXcd::Identity(size, size));
    const auto begin = Eigen::VectorXcd::NullaryExpr(
        size, [](Eigen::Index i) { return std::complex<double>(std::cos(1.7 * static_cast<double>(i) + 0.3)); });
    result.right = result.left = begin.normalized();
    for (int i = 0; i < iterations; ++i) {
        result.right = factors.solve(result.right).normalized();
        result.left = factors.solve_transposed(result.left).normalized();
    }
    return result.right.allFinite() && result.left.allFinite();
}

std::optional<Leading> leading_of(const Eigen::MatrixXd& matrix) {
    if (!matrix.allFinite())
        return std::nullopt;
    Leading result;
    const bool many = matrix.rows() > many_states;
    std::optional<Eigensystem> system, transposed;
    if (many) {
        const auto values = eigenvalues(matrix);
        if (!values)
            return std::nullopt;
        result.values = *values;
    } else {
        system = eigensystem(matrix);
        transposed = eigensystem(matrix.transpose());
        if (!system || !transposed)
            return std::nullopt;
        result.values = system->values;
    }
    const Eigen::VectorXcd& values = result.values;
    result.order.resize(static_cast<std::size_t>(values.size()));
    std::iota(result.order.begin(), result.order.end(), Eigen::Index{0});
    std::ranges::stable_sort(result.order, [&](auto a, auto b) { return std::abs(values[a]) > std::abs(values[b]); });
    const std::complex<double> first = values[result.order[0]];
    if (many)
        return find_vectors(matrix, first, result) ? std::optional(result) : std::nullopt;
    result.right = system->vectors.col(result.order[0]);
    Eigen::Index same = 0;
    (transposed->values.array() - first).abs().minCoeff(&same);
    result.left = transposed->vectors.col(same);
    return result;
}

} // namespace

SectionMap::SectionMap(const Simulation& simulation, std::size_t probe)
    : simulation_(simulation), probe_(probe), states_(simulation.system().states()), takes_part_(states_, true) {
    const Model& model = simulation.model();
    const Probe& section = simulation.probes()[probe];
    for (std::size_t i = 0; i < states_; ++i)
        takes_part_[i] = !model.states[i].drifting && !(is_phase() && section.state == i);
    if (is_phase())
        return;
    section_ = simulation.system().with_gradient(section.expression);
}

SectionMap::Workspace SectionMap::workspace(std::span<const double> parameters) const {
    const System& compiled = simulation_.system();
    Workspace workspace;
    workspace.inputs.resize(states_ + parameters.size());
    std::ranges::copy(parameters, workspace.inputs.begin() + static_cast<std::ptrdiff_t>(states_));
    workspace.work.resize(std::max(2 * compiled.workspace(), section_.workspace()));
    workspace.errors.resize(workspace.inputs.size());
    workspace.field.resize(states_);
    workspace.gradient.resize(std::max(1 + states_, section_.outputs()));
    std::size_t watched = 0;
    for (std::size_t m = 0; m < compiled.model().modes.size(); ++m)
        watched = std::max(watched, compiled.mode(m).watched.size());
    workspace.events.resize(watched);
    workspace.event_gradients.resize(watched * states_);
    return workspace;
}

bool SectionMap::project(Workspace& workspace, std::size_t mode, std::span<const double> state,
                         Eigen::MatrixXd& tangents) const {
    std::ranges::copy(state, workspace.inputs.begin());
    simulation_.system().mode(mode).rates.evaluate(workspace.inputs, workspace.field, workspace.work);
    const auto states = static_cast<Eigen::Index>(states_);
    const Eigen::Map<const Eigen::VectorXd> field(workspace.field.data(), states);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(states);
    if (is_phase()) {
        gradient[static_cast<Eigen::Index>(simulation_.probes()[probe_].state)] = 1;
    } else {
        section_.evaluate(workspace.inputs, workspace.gradient, workspace.work);
        gradient = Eigen::Map<const Eigen::VectorXd>(workspace.gradient.data() + 1, states);
    }
    const double rate = gradient.dot(field);
    if (!(std::abs(rate) > 0) || !std::isfinite(rate))
        return false;
    const Eigen::RowVectorXd shift = gradient.transpose() * tangents / rate;
    tangents -= field * shift;
    return tangents.allFinite();
}

std::vector<double> SectionMap::gradient_at(std::span<const double> parameters, std::span<const double> state) const {
    std::vector<double> gradient(states_, 0.0);
    if (is_phase())
        return gradient;
    Workspace numbers = workspace(parameters);
    std::ranges::copy(state, numbers.inputs.begin());
    section_.evaluate(numbers.inputs, numbers.gradient, numbers.work);
    std::copy_n(numbers.gradient.begin() + 1, states_, gradient.begin());
    return gradient;
}

void SectionMap::settle_on_section(Workspace& workspace, std::span<double> state) const {
    if (is_phase())
        return;
    std::ranges::copy(state, workspace.inputs.begin());
    section_.evaluate(workspace.inputs, workspace.gradient, workspace.work);
    double square = 0;
    for (std::size_t i = 0; i < states_; ++i)
        square += workspace.gradient[1 + i] * workspace.gradient[1 + i];
    if (!(square > 0))
        return;
    for (std::size_t i = 0; i < states_; ++i)
        state[i] -= workspace.gradient[0] * workspace.gradient[1 + i] / square;
}

void SectionMap::add_round_off(Workspace& workspace, std::size_t mode, std::span<const double> state, double time,
                               std::span<double> result) const {
    const Function& rates = simulation_.system().mode(mode).rates;
    std::ranges::copy(state, workspace.inputs.begin());
    std::ranges::fill(workspace.errors, 0.0);
    // Round-off of a speed causes the same of the position.
    for (int order = 0; order < 2; ++order) {
        rates.error_bounds(workspace.inputs, workspace.errors, workspace.field, workspace.work);
        for (std::size_t i = 0; i < states_; ++i) {
            const double moved = workspace.field[i] * time;
            workspace.errors[i] = std::isfinite(moved) ? moved : 0;
            result[i] = std::max(result[i], workspace.errors[i]);
        }
    }
}

bool SectionMap::is_on_event(Workspace& workspace, std::size_t mode, std::span<const double> state,
                             std::span<const double> periods, double time) const {
    if (simulation_.system().mode(mode).watched.empty())
        return false;
    std::ranges::copy(state, workspace.inputs.begin());
    if (meets_event(workspace, mode, time))
        return true;
    // A phase at the beginning of its period is also at its end, where clocks have their events.
    bool at_end = false;
    for (std::size_t i = 0; i < states_; ++i)
        if (periods[i] > 0 && state[i] < simultaneous_phase * periods[i]) {
            workspace.inputs[i] += periods[i];
            at_end = true;
        }
    return at_end && meets_event(workspace, mode, time);
}

bool SectionMap::meets_event(Workspace& workspace, std::size_t mode, double time) const {
    const auto& compiled = simulation_.system().mode(mode);
    compiled.rates.evaluate(workspace.inputs, workspace.field, workspace.work);
    compiled.events.evaluate(workspace.inputs, workspace.events, workspace.work);
    compiled.event_gradients.evaluate(workspace.inputs, workspace.event_gradients, workspace.work);
    for (std::size_t w = 0; w < compiled.watched.size(); ++w) {
        double rate = 0;
        for (std::size_t i = 0; i < states_; ++i)
            rate += workspace.event_gradients[w * states_ + i] * workspace.field[i];
        if (rate < 0 && std::abs(workspace.events[w]) <= -rate * time)
            return true;
    }
    return false;
}

void subtract_states(std::span<const double> a, std::span<const double> b, std::span<const double> periods,
                     std::span<double> difference) {
    for (std::size_t i = 0; i < a.size(); ++i)
        difference[i] = without_turns(a[i] - b[i], periods[i]);
}

ReturnJacobian return_jacobian(const SectionMap& map, const Eigen::MatrixXd& tangents) {
    ReturnJacobian jacobian{tangents, {}};
    for (std::size_t i = 0; i < map.states(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        bool conserved = true;
        for (std::size_t j = 0; j < map.states() && conserved; ++j)
            conserved = !map.takes_part(j) || tangents(row, static_cast<Eigen::Index>(j)) == (i == j ? 1 : 0);
        if (map.takes_part(i) && !conserved)
            jacobian.active.push_back(i);
    }
    return jacobian;
}

Eigen::VectorXd newton_correction(const ReturnJacobian& jacobian, const Eigen::VectorXd& defect,
                                  const Eigen::VectorXd& scale) {
    Eigen::VectorXd correction = Eigen::VectorXd::Zero(defect.size());
    const auto size = static_cast<Eigen::Index>(jacobian.active.size());
    if (size == 0)
        return correction;
    const Eigen::MatrixXd matrix = scaled_matrix(jacobian, scale) - Eigen::MatrixXd::Identity(size, size);
    Eigen::VectorXd right(size);
    for (Eigen::Index i = 0; i < size; ++i) {
        const auto state = static_cast<Eigen::Index>(jacobian.active[static_cast<std::size_t>(i)]);
        right[i] = -defect[state] / scale[state];
    }
    // Entries that cancel leave the error of derivatives: in directions in which all neighbours return too, nothing is
    // to be corrected.
    constexpr double errors_of_derivatives = 1e-12;
    const double largest = matrix.colwise().norm().maxCoeff();
    const double usual = std::numeric_limits<double>::epsilon() * static_cast<double>(size);
    Eigen::VectorXd solution;
    if (const auto regular = solution_of_many(matrix, right))
        solution = *regular;
    else
        solution = shortest_solution(matrix, right,
                                     largest > 0 ? std::optional(std::max(usual, errors_of_derivatives / largest))
                                                 : std::nullopt);
    for (Eigen::Index i = 0; i < size; ++i) {
        const auto state = static_cast<Eigen::Index>(jacobian.active[static_cast<std::size_t>(i)]);
        correction[state] = solution[i] * scale[state];
    }
    return correction;
}

std::optional<ReturnSpectrum> return_spectrum(const SectionMap& map, const ReturnJacobian& jacobian,
                                              const Eigen::VectorXd& scale) {
    ReturnSpectrum result;
    result.direction = Eigen::VectorXd::Zero(scale.size());
    result.functional = Eigen::VectorXcd::Zero(scale.size());
    if (jacobian.active.empty())
        return result;
    const Eigen::MatrixXd matrix = scaled_matrix(jacobian, scale);
    const auto leading = leading_of(matrix);
    if (!leading)
        return std::nullopt;
    const Eigen::VectorXcd& values = leading->values;
    const std::vector<Eigen::Index>& order = leading->order;
    // At a crossing section, the projection along the flow adds one multiplier zero. If there is a single state, this
    // is the only one: the return map is constant, and the value is round-off.
    const std::size_t count = map.is_phase() || order.size() == 1 ? order.size() : order.size() - 1;
    for (std::size_t i = 0; i < count; ++i)
        result.multipliers.push_back(!map.is_phase() && order.size() == 1 ? 0.0 : values[order[i]]);
    for (std::size_t i = 0; i < jacobian.active.size(); ++i) {
        const auto state = static_cast<Eigen::Index>(jacobian.active[i]);
        result.direction[state] = leading->right[static_cast<Eigen::Index>(i)].real() * scale[state];
        result.functional[state] = leading->left[static_cast<Eigen::Index>(i)];
    }
    return result;
}

bool has_multiplier_beyond(const ReturnJacobian& jacobian, const Eigen::VectorXd& scale, double radius) {
    const Eigen::MatrixXd matrix = scaled_matrix(jacobian, scale);
    if (const auto leading = leading_eigenvalues(matrix))
        return !leading->values.empty() && std::abs(leading->values.front()) > radius;
    const auto all = matrix.size() > 0 && matrix.allFinite() ? eigenvalues(matrix) : std::nullopt;
    return all && all->cwiseAbs().maxCoeff() > radius;
}

} // namespace graze
