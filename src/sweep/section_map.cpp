#include "sweep/section_map.hpp"

#include "base/decompositions.hpp"
#include "base/linear_systems.hpp"
#include "flow/cyclic.hpp"
#include "graze/symbolic/transform.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
    const Eigen::VectorXd solution = shortest_solution(
        matrix, right, largest > 0 ? std::optional(std::max(usual, errors_of_derivatives / largest)) : std::nullopt);
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
    const auto system = eigensystem(matrix), transposed = eigensystem(matrix.transpose());
    if (!matrix.allFinite() || !system || !transposed)
        return std::nullopt;
    const Eigen::VectorXcd& values = system->values;
    std::vector<Eigen::Index> order(jacobian.active.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = static_cast<Eigen::Index>(i);
    std::ranges::stable_sort(order, [&](auto a, auto b) { return std::abs(values[a]) > std::abs(values[b]); });
    // At a crossing section, the projection along the flow adds one multiplier zero. If there is a single state, this
    // is the only one: the return map is constant, and the value is round-off.
    const std::size_t count = map.is_phase() || order.size() == 1 ? order.size() : order.size() - 1;
    for (std::size_t i = 0; i < count; ++i)
        result.multipliers.push_back(!map.is_phase() && order.size() == 1 ? 0.0 : values[order[i]]);
    const Eigen::VectorXd leading = system->vectors.col(order[0]).real();
    Eigen::Index same = 0;
    (transposed->values.array() - values[order[0]]).abs().minCoeff(&same);
    const Eigen::VectorXcd functional = transposed->vectors.col(same);
    for (std::size_t i = 0; i < jacobian.active.size(); ++i) {
        const auto state = static_cast<Eigen::Index>(jacobian.active[i]);
        result.direction[state] = leading[static_cast<Eigen::Index>(i)] * scale[state];
        result.functional[state] = functional[static_cast<Eigen::Index>(i)];
    }
    return result;
}

} // namespace graze
