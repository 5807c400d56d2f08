#include "branch/monitor_function.hpp"

#include "graze/symbolic/transform.hpp"
#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace graze {

namespace {

/// Nodes and weights of Gauss's rule with eight points on [0, 1].
constexpr std::array<std::pair<double, double>, 8> gauss{{{0.019855071751231884, 0.05061426814518813},
                                                          {0.10166676129318664, 0.11119051722668724},
                                                          {0.2372337950418355, 0.15685332293894363},
                                                          {0.4082826787521751, 0.1813418916891810},
                                                          {0.5917173212478249, 0.1813418916891810},
                                                          {0.7627662049581645, 0.15685332293894363},
                                                          {0.8983332387068134, 0.11119051722668724},
                                                          {0.9801449282487681, 0.05061426814518813}}};

/// The monitor's expression and, for the second half of a symmetric orbit, the same of the image.
std::vector<Expression> expressions_of(const OrbitEquations& equations, const Monitor& monitor, bool whole) {
    Model model = equations.model();
    if (monitor.kind == Monitor::Kind::duration)
        return {};
    const Expression own = model.expand(monitor.kind == Monitor::Kind::norm ? monitor.expression * monitor.expression
                                                                            : monitor.expression);
    std::vector<Expression> result{own};
    if (whole && equations.symmetry()) {
        const auto states = model.state_symbols();
        const auto map = model.expand(model.symmetries[*equations.symmetry()].map);
        std::vector<Replacement> replacements;
        for (std::size_t i = 0; i < states.size(); ++i)
            replacements.emplace_back(states[i], map[i]);
        result.push_back(substitute(own, replacements));
    }
    return result;
}

} // namespace

MonitorFunction::MonitorFunction(const OrbitEquations& equations, const Monitor& monitor,
                                 std::optional<std::size_t> segment)
    : kind_(monitor.kind), segment_(segment),
      simulation_(equations.system(), {}, expressions_of(equations, monitor, !segment),
                  equations.simulation().options()),
      flow_(flow_of(simulation_, equations.free())), roots_(simulation_.order()) {
    for (const Expression& expression : expressions_of(equations, monitor, !segment))
        watched_.push_back({simulation_.system().with_gradient(expression), watched_.size()});
}

bool MonitorFunction::evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) {
    gradient_ = Eigen::RowVectorXd::Zero(at.unknowns.size());
    flow_.set_parameters(at.parameters);
    bool defined = false;
    switch (kind_) {
    case Monitor::Kind::value:
        defined = at_end(equations, at);
        break;
    case Monitor::Kind::start:
        defined = at_start(equations, at);
        break;
    case Monitor::Kind::duration:
        defined = duration(equations, at);
        break;
    case Monitor::Kind::maximum:
    case Monitor::Kind::minimum:
        defined = extremum(equations, at);
        break;
    case Monitor::Kind::mean:
    case Monitor::Kind::norm:
        defined = mean(equations, at);
        break;
    case Monitor::Kind::multiplier: // never held: BranchSettings::validate refuses it
        break;
    }
    return defined && std::isfinite(value_) && gradient_.allFinite();
}

std::vector<std::size_t> MonitorFunction::pieces(const OrbitLayout& layout) const {
    std::vector<std::size_t> result;
    for (std::size_t s = 0; s < layout.segments(); ++s)
        if (is_whole() || *segment_ == s)
            for (std::size_t k = layout.first_piece(s); k <= layout.last_piece(s); ++k)
                result.push_back(k);
    return result;
}

/// With respect to states, then free parameters.
Eigen::VectorXd MonitorFunction::gradient_at(const OrbitEquations& equations, const OrbitEvaluation& at,
                                             const Watched& watched, std::vector<double> state, double& value) const {
    state.insert(state.end(), at.parameters.begin(), at.parameters.end());
    const std::vector<double> all = watched.function(state);
    value = all[0];
    return equations.gradient_of(all);
}

bool MonitorFunction::at_end(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const std::size_t piece = equations.layout().last_piece(segment_.value_or(0));
    const Eigen::VectorXd by_all = gradient_at(equations, at, watched_[0], at.pieces[piece].end, value_);
    gradient_ = equations.row_at_end(at, piece, by_all);
    return true;
}

bool MonitorFunction::at_start(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const auto n = index(equations.layout().states());
    const Eigen::Index place = index(equations.layout().start_of(equations.layout().first_piece(segment_.value_or(0))));
    const std::vector<double> state(at.unknowns.data() + place, at.unknowns.data() + place + n);
    const Eigen::VectorXd by_all = gradient_at(equations, at, watched_[0], state, value_);
    gradient_.segment(place, n) = by_all.head(n).transpose();
    gradient_.tail(by_all.size() - n) = by_all.tail(by_all.size() - n).transpose();
    return true;
}

bool MonitorFunction::duration(const OrbitEquations& equations, const OrbitEvaluation& at) {
    value_ = 0;
    const double times = is_whole() && equations.symmetry() ? 2 : 1;
    for (const std::size_t k : pieces(equations.layout())) {
        value_ += times * at.unknowns[index(equations.layout().duration_of(k))];
        gradient_[index(equations.layout().duration_of(k))] = times;
    }
    return true;
}

std::optional<MonitorFunction::Place> MonitorFunction::find_extremum(const OrbitEquations& equations,
                                                                     const OrbitEvaluation& at) {
    const double sign = kind_ == Monitor::Kind::maximum ? 1 : -1;
    const std::size_t n = equations.layout().states();
    std::optional<Place> best;
    std::vector<double> coefficients, derivative;
    std::vector<Root> found;
    for (const std::size_t k : pieces(equations.layout())) {
        const auto note = [&](std::size_t watched, double time, bool at_end, double value) {
            if (std::isfinite(value) && (!best || sign * value > sign * best->value))
                best = Place{watched, k, time, at_end, value};
        };
        const double* start = at.unknowns.data() + equations.layout().start_of(k);
        std::vector<double> state(start, start + n);
        const std::size_t mode = equations.mode_of(k);
        const std::size_t events = simulation_.system().mode(mode).watched.size();
        const double duration = at.unknowns[index(equations.layout().duration_of(k))];
        flow_.run(mode, state, duration, [&](const Jet& jet, double time, double length) {
            for (const Watched& watched : watched_) {
                const double* series = jet.output(events + watched.series);
                coefficients.assign(series, series + simulation_.order() + 1);
                derivative.clear();
                for (std::size_t i = 1; i < coefficients.size(); ++i)
                    derivative.push_back(static_cast<double>(i) * coefficients[i]);
                note(watched.series, time, false, coefficients[0]);
                note(watched.series, time + length, time + length == duration,
                     evaluate_polynomial(coefficients, length));
                if (length < 0)
                    continue; // of a segment that has no meaning, the ends are enough
                roots_.crossings(derivative, length, RootStart::as_is, found);
                for (const Root& root : found)
                    note(watched.series, time + root.at, false, evaluate_polynomial(coefficients, root.at));
            }
        });
    }
    return best;
}

bool MonitorFunction::extremum(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const auto place = find_extremum(equations, at);
    if (!place)
        return false;
    const auto n = index(equations.layout().states()), q = index(equations.free().size());
    const Watched& watched = watched_[place->watched];
    if (place->at_end) { // ends with its segment, however long that takes
        const Eigen::VectorXd by_all = gradient_at(equations, at, watched, at.pieces[place->piece].end, value_);
        gradient_ = equations.row_at_end(at, place->piece, by_all);
        return true;
    }
    const double* start = at.unknowns.data() + equations.layout().start_of(place->piece);
    std::vector<double> state(start, start + n);
    Eigen::MatrixXd flow;
    if (run(flow_, equations.mode_of(place->piece), state, place->time, flow) != ModeFlow::Ending::done)
        return false;
    const Eigen::VectorXd by_all = gradient_at(equations, at, watched, state, value_);
    value_ = place->value;
    const Eigen::RowVectorXd by_state = by_all.head(n).transpose();
    gradient_.segment(index(equations.layout().start_of(place->piece)), n) = by_state * flow.leftCols(n);
    gradient_.tail(q) = by_state * flow.rightCols(q) + by_all.tail(q).transpose();
    return true;
}

/// Integrals of the function and of its changes, by Gauss's rule on each Taylor step.
bool MonitorFunction::mean(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const auto n = index(equations.layout().states()), q = index(equations.free().size());
    double integral = 0, time = 0;
    const double share = 1.0 / static_cast<double>(watched_.size());
    for (const std::size_t k : pieces(equations.layout())) {
        const double* start = at.unknowns.data() + equations.layout().start_of(k);
        const std::size_t mode = equations.mode_of(k);
        const double duration = at.unknowns[index(equations.layout().duration_of(k))];
        std::vector<double> state(start, start + n);
        std::vector<std::pair<double, double>> steps;
        flow_.run(mode, state, duration,
                  [&](const Jet&, double begin, double length) { steps.emplace_back(begin, length); });
        state.assign(start, start + n);
        double now = 0;
        Eigen::MatrixXd flow = Eigen::MatrixXd::Identity(n, n + q), part;
        for (const auto& [begin, length] : steps)
            for (const auto& [node, weight] : gauss) {
                const double next = begin + node * length;
                if (run(flow_, mode, state, next - now, part) != ModeFlow::Ending::done)
                    return false;
                now = next;
                flow = Eigen::MatrixXd(part.leftCols(n) * flow);
                flow.rightCols(q) += part.rightCols(q);
                for (const Watched& watched : watched_) {
                    double value = 0;
                    const Eigen::VectorXd by_all = gradient_at(equations, at, watched, state, value);
                    const Eigen::RowVectorXd by_state = by_all.head(n).transpose();
                    const double here = share * weight * length;
                    integral += here * value;
                    gradient_.segment(index(equations.layout().start_of(k)), n) += here * (by_state * flow.leftCols(n));
                    gradient_.tail(q) += here * (by_state * flow.rightCols(q) + by_all.tail(q).transpose());
                }
            }
        for (const Watched& watched : watched_) {
            double value = 0;
            gradient_at(equations, at, watched, at.pieces[k].end, value);
            gradient_[index(equations.layout().duration_of(k))] += share * value;
        }
        time += duration;
    }
    if (time == 0)
        return false;
    value_ = integral / time;
    for (const std::size_t k : pieces(equations.layout()))
        gradient_[index(equations.layout().duration_of(k))] -= value_;
    gradient_ /= time;
    if (kind_ == Monitor::Kind::norm) {
        if (!(value_ > 0))
            return false;
        value_ = std::sqrt(value_);
        gradient_ /= 2 * value_;
    }
    return true;
}

} // namespace graze
