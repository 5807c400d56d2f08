// Motions on invariant planes, such as that of equal states or of a zero state: they are displaced off the plane.

#include "base/decompositions.hpp"
#include "sweep/attractor_search.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr double next_to_zero = 1e-9; ///< relative size of a state that keeps its sign and counts as almost zero

/// Allowed distance of points from a common plane: larger than rounding, smaller than any disturbance.
constexpr double in_plane = 1e-9;

/// Returns the normals of the smallest plane that contains all points, to within round-off: the directions in which the
/// points do not differ. A motion on such a plane gives no information on its neighbours beside it.
/// @param points in rows, in units in which the extent of each coordinate is about one
/// @param away a direction that is excluded, such as the one that leads off a section; zero: none
/// @return normals in columns, orthonormal; none if there are too few points
Eigen::MatrixXd normals_of_plane(const Eigen::MatrixXd& points, const Eigen::VectorXd& away) {
    const Eigen::Index count = points.rows(), size = points.cols();
    if (size == 0 || count < 2 * size + 2)
        return Eigen::MatrixXd(size, 0);
    Eigen::MatrixXd rows(count + 1, size);
    rows.topRows(count) = points.rowwise() - points.row(0);
    const double length = away.norm();
    rows.bottomRows(1).setZero();
    if (length > 0)
        rows.bottomRows(1) = away.transpose() / length * std::sqrt(static_cast<double>(count));
    if (!rows.allFinite())
        return Eigen::MatrixXd(size, 0);
    const SingularValues factors = singular_values(rows, SingularVectors::right);
    const double most = in_plane * std::sqrt(static_cast<double>(count));
    Eigen::Index normals = 0;
    while (normals < size && factors.values[size - 1 - normals] <= most)
        ++normals;
    return factors.right.rightCols(normals);
}

} // namespace

/// Returns the states that vary among the returns, except clocks and constant states.
std::vector<std::size_t> AttractorSearch::states_of_plane() const {
    std::vector<std::size_t> states;
    const std::size_t mode = watcher_.recent(0).mode;
    for (std::size_t i = 0; i < periods_.size(); ++i)
        if (const bool clock = periods_[i] > 0 && setting_->field.is_clock(mode, i);
            setting_->map.takes_part(i) && !clock && !setting_->field.is_conserved(i))
            states.push_back(i);
    return states;
}

/// Returns the unit of deviations from a plane. For a state that keeps its sign and is almost zero, it is the length
/// over which its rate is linear or, if that is unlimited, its initial value.
double AttractorSearch::scale_beside_plane(std::size_t state) {
    const double usual = watcher_.scale()[state];
    if (!setting_->field.keeps_sign(state))
        return usual;
    const Return& last = watcher_.recent(0);
    const double size = std::abs(last.state[state]);
    constexpr double smallest = 1e-100;
    double length = equilibria_.linear_length(last.state, last.mode, state, std::max(size, smallest));
    const double first = std::abs(setting_->simulation.model().initial_state()[state]);
    if (!(length > 0))
        length = std::max(watcher_.range(state), first > 0 ? first : usual);
    for (std::size_t k = 0; k < watcher_.remembered(); ++k)
        if (!(std::abs(watcher_.recent(k).state[state]) <= next_to_zero * length))
            return usual;
    return length;
}

/// Returns the share of a tangent vector, after long growth, that is normal to the plane.
double AttractorSearch::share_beside(const Eigen::MatrixXd& normals, const std::vector<std::size_t>& states,
                                     const Eigen::VectorXd& scale) const {
    const Eigen::VectorXd all = exponent_.vector(*main_);
    Eigen::VectorXd vector(scale.size());
    for (Eigen::Index k = 0; k < scale.size(); ++k)
        vector[k] = all[static_cast<Eigen::Index>(states[static_cast<std::size_t>(k)])] / scale[k];
    const double length = vector.norm();
    return length > 0 ? (normals.transpose() * vector).norm() / length : 0;
}

/// Returns whether no watched event lies between two states.
bool AttractorSearch::same_sides(std::span<const double> before, std::span<const double> after, std::size_t mode) {
    FieldMap::Workspace workspace = setting_->field.workspace(parameters_);
    setting_->field.evaluate_events(workspace, mode, before);
    const std::vector<double> values = workspace.events;
    setting_->field.evaluate_events(workspace, mode, after);
    for (std::size_t w = 0; w < setting_->simulation.system().mode(mode).watched.size(); ++w)
        if (!(workspace.events[w] > 0) && values[w] >= 0)
            return false;
    return true;
}

/// Separating neighbours are no evidence of chaos while the motion lies on an invariant plane: they may leave the
/// plane, and the motion would too. Displaces the motion off the plane, once in a search.
std::optional<bool> AttractorSearch::leave_plane() {
    if (plane_left_)
        return std::nullopt;
    const Return& last = watcher_.recent(0);
    const std::vector<std::size_t> states = states_of_plane();
    const auto size = static_cast<Eigen::Index>(states.size()),
               count = static_cast<Eigen::Index>(watcher_.remembered());
    Eigen::VectorXd scale(size), away(size);
    const std::vector<double> gradient = setting_->map.gradient_at(parameters_, last.state);
    for (Eigen::Index j = 0; j < size; ++j) {
        const std::size_t state = states[static_cast<std::size_t>(j)];
        scale[j] = scale_beside_plane(state);
        away[j] = gradient[state] * scale[j];
    }
    Eigen::MatrixXd points(count, size);
    std::vector<double> difference(periods_.size());
    for (Eigen::Index k = 0; k < count; ++k) {
        subtract_states(watcher_.recent(static_cast<std::size_t>(k)).state, last.state, periods_, difference);
        for (Eigen::Index j = 0; j < size; ++j)
            points(k, j) = difference[states[static_cast<std::size_t>(j)]] / scale[j];
    }
    const Eigen::MatrixXd normals = normals_of_plane(points, away);
    if (normals.cols() == 0)
        return std::nullopt;
    plane_left_ = true;
    if (setting_->options.disturbance == 0) {
        constexpr double most = 0.5;
        if (share_beside(normals, states, scale) <= most)
            return std::nullopt;
        finish(Label::unsettled);
        result_.outcome.detail = "neighbours part from the invariant plane on which the motion lies; allow a "
                                 "disturbance to displace it";
        return false;
    }
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(size);
    for (Eigen::Index k = 0; k < normals.cols(); ++k)
        direction += normals.col(k) / static_cast<double>(k + 1);
    direction /= direction.cwiseAbs().maxCoeff();
    const auto displaced = displaced_by(states, direction.cwiseProduct(scale) * setting_->options.disturbance);
    if (!displaced)
        return std::nullopt;
    visited_.values.clear();
    limit_ = std::max(limit_, watcher_.returns() + setting_->options.cycles);
    displace(*displaced, last.mode, watcher_.remembered() > 1 ? last.time - watcher_.recent(1).time : 0);
    return true;
}

/// Returns the present state changed by `change` or its opposite, such that signs are kept and no barrier is violated.
std::optional<std::vector<double>> AttractorSearch::displaced_by(const std::vector<std::size_t>& states,
                                                                 const Eigen::VectorXd& change) {
    const std::span<const double> here = main_->state();
    const auto on_edge = [&](std::size_t j) {
        const std::size_t state = states[j];
        return setting_->field.keeps_sign(state) &&
               std::abs(here[state]) < std::abs(change[static_cast<Eigen::Index>(j)]);
    };
    double side = 1, strongest = 0;
    for (std::size_t j = 0; j < states.size(); ++j)
        if (const double one = change[static_cast<Eigen::Index>(j)]; on_edge(j) && std::abs(one) > strongest) {
            strongest = std::abs(one);
            side = (here[states[j]] < 0) == (one < 0) ? 1 : -1;
        }
    const bool fixed = strongest > 0;
    for (const double sign : {side, -side}) {
        std::vector<double> state(here.begin(), here.end());
        for (std::size_t j = 0; j < states.size(); ++j) {
            const double one = sign * change[static_cast<Eigen::Index>(j)];
            if (!on_edge(j) || (here[states[j]] < 0) == (one < 0))
                state[states[j]] += one;
        }
        if (same_sides(here, state, main_->mode()))
            return state;
        if (fixed)
            break;
    }
    return std::nullopt;
}

} // namespace graze
