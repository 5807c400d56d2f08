#include "branch/orbit_quantity.hpp"

#include "base/concatenated.hpp"
#include "flow/lie_derivative.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/symbolic/transform.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace graze {

namespace {

/// Nodes and weights of the Gauss rule with eight points on [0, 1].
constexpr std::array<std::pair<double, double>, 8> gauss{{{0.019855071751231884, 0.05061426814518813},
                                                          {0.10166676129318664, 0.11119051722668724},
                                                          {0.2372337950418355, 0.15685332293894363},
                                                          {0.4082826787521751, 0.1813418916891810},
                                                          {0.5917173212478249, 0.1813418916891810},
                                                          {0.7627662049581645, 0.15685332293894363},
                                                          {0.8983332387068134, 0.11119051722668724},
                                                          {0.9801449282487681, 0.05061426814518813}}};

/// Returns the composition of an expression with a map of the states.
Expression composed(Model& model, const Expression& expression, const std::vector<Expression>& map) {
    const auto states = model.state_symbols();
    const auto images = model.expand(map);
    std::vector<Replacement> replacements;
    for (std::size_t i = 0; i < std::min(states.size(), images.size()); ++i)
        replacements.emplace_back(states[i], images[i]);
    return substitute(expression, replacements);
}

std::vector<double> start_of_piece(const OrbitEquations& equations, const OrbitEvaluation& at, std::size_t piece) {
    const double* start = at.unknowns.data() + equations.layout().start_of(piece);
    return {start, start + equations.layout().states()};
}

const Transition& transition_of(const OrbitEquations& equations, std::size_t segment) {
    require_index(segment, equations.signature().size(), "segment");
    if (equations.signature()[segment].end != SegmentEnd::event)
        throw InputError(fmt::format("no event ends segment {}", segment + 1), "choose one that an event ends");
    return equations.model().transitions[equations.signature()[segment].index];
}

} // namespace

OrbitQuantity OrbitQuantity::of_monitor(const OrbitEquations& equations, const Monitor& monitor,
                                        std::optional<std::size_t> segment, double value) {
    if (monitor.kind == Monitor::Kind::multiplier)
        throw InputError(fmt::format("monitor '{}' is a multiplier, which cannot be held", monitor.name),
                         "report values of it, or give bounds at which the branch ends");
    return {equations, {monitor.kind, monitor.expression, segment, value, {}, monitor.in_modes}};
}

OrbitQuantity OrbitQuantity::of_speed(const OrbitEquations& equations, std::size_t segment, double speed) {
    const Transition& transition = transition_of(equations, segment);
    return {
        equations,
        {Monitor::Kind::value, rate_of(equations.system(), transition.mode, transition.event), segment, -speed, {}}};
}

OrbitQuantity OrbitQuantity::of_touch(const OrbitEquations& equations, std::size_t segment, std::size_t event,
                                      double share) {
    require_index(segment, equations.signature().size(), "segment");
    require_index(event, equations.model().events.size(), "event");
    return {equations, {Monitor::Kind::minimum, equations.model().events[event].function, segment, 0, share}};
}

OrbitQuantity OrbitQuantity::of_two_events(const OrbitEquations& equations, std::size_t segment, std::size_t event) {
    require_index(segment, equations.signature().size(), "segment");
    require_index(event, equations.model().events.size(), "event");
    return {equations, {Monitor::Kind::value, equations.model().events[event].function, segment, 0, {}}};
}

OrbitQuantity OrbitQuantity::of_vanishing(const OrbitEquations& equations, std::size_t segment) {
    require_index(segment, equations.signature().size(), "segment");
    return {equations, {Monitor::Kind::duration, {}, segment, 0, {}}};
}

std::optional<OrbitQuantity> OrbitQuantity::of_guard(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                     std::size_t segment) {
    const Transition& transition = transition_of(equations, segment);
    Model model = equations.model();
    const std::vector<double> inputs =
        concatenated(at.pieces[equations.layout().last_piece(segment)].end, at.parameters);
    std::optional<Expression> nearest;
    double least = 0;
    const auto add = [&](const Expression& before) {
        const double value = std::abs(equations.system().function_of({&before, 1})(inputs)[0]);
        if (nearest && !(value < least))
            return;
        least = value;
        nearest = before;
    };
    for (const Alternative& alternative : transition.next)
        for (const auto& condition : alternative.when) {
            // Guards are evaluated in the state after the jump.
            const std::vector<Expression>& map = model.jumps[transition.jump].map;
            const Expression own = model.expand(condition.function);
            add(map.empty() ? own : composed(model, own, map));
        }
    // Conditions of transitions in the state before it.
    const std::vector<Transition> transitions = model.transitions;
    for (const Transition& other : transitions)
        if (other.mode == transition.mode && other.event == transition.event && other.also == transition.also)
            for (const Condition& condition : other.when)
                add(model.expand(condition.function));
    if (!nearest)
        return std::nullopt;
    return OrbitQuantity(equations, {Monitor::Kind::value, *nearest, segment, 0, {}});
}

/// Returns the expression of the quantity and, for half orbits, its composition with the symmetry.
std::vector<Expression> OrbitQuantity::expressions_of(const OrbitEquations& equations, const Description& description) {
    if (description.kind == Monitor::Kind::duration)
        return {};
    Model model = equations.model();
    const Expression& given = description.expression;
    if (!description.in_modes.empty())
        return model.expand(description.in_modes);
    const Expression own = model.expand(description.kind == Monitor::Kind::norm ? given * given : given);
    std::vector<Expression> result{own};
    const bool along_orbit = description.kind != Monitor::Kind::conserved && !description.segment;
    if (along_orbit && equations.symmetry())
        result.push_back(composed(model, own, model.symmetries[*equations.symmetry()].map));
    return result;
}

OrbitQuantity::OrbitQuantity(const OrbitEquations& equations, const Description& description)
    : OrbitQuantity(equations, description, expressions_of(equations, description)) {}

OrbitQuantity::OrbitQuantity(const OrbitEquations& equations, const Description& description,
                             const std::vector<Expression>& expressions)
    : kind_(description.kind), segment_(description.segment), target_(description.target), share_(description.share),
      simulation_(equations.system(), {}, expressions, equations.simulation().options()),
      flow_(flow_of(simulation_, equations.free())), roots_(simulation_.order()) {
    for (const Expression& expression : expressions)
        watched_.push_back({simulation_.system().with_gradient(expression), watched_.size()});
}

bool OrbitQuantity::evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) {
    gradient_ = Eigen::RowVectorXd::Zero(at.unknowns.size());
    flow_.set_parameters(at.parameters);
    const bool defined = kind_ == Monitor::Kind::value                                        ? at_end(equations, at)
                         : kind_ == Monitor::Kind::start                                      ? at_start(equations, at)
                         : kind_ == Monitor::Kind::conserved                                  ? at_start(equations, at)
                         : kind_ == Monitor::Kind::duration                                   ? duration(equations, at)
                         : kind_ == Monitor::Kind::maximum || kind_ == Monitor::Kind::minimum ? extremum(equations, at)
                                                                                              : mean(equations, at);
    value_ -= target_;
    return defined && std::isfinite(value_) && gradient_.allFinite();
}

void OrbitQuantity::renew(const OrbitEquations& equations, const OrbitEvaluation& at) {
    if (!share_)
        return;
    flow_.set_parameters(at.parameters);
    if (const auto place = find_extremum(equations, at))
        share_ = place->share;
}

std::vector<std::size_t> OrbitQuantity::pieces(const OrbitLayout& layout) const {
    std::vector<std::size_t> result;
    for (std::size_t s = 0; s < layout.segments(); ++s)
        if (!segment_ || *segment_ == s)
            for (std::size_t k = layout.first_piece(s); k <= layout.last_piece(s); ++k)
                result.push_back(k);
    return result;
}

/// Returns the gradient with respect to states, then free parameters, and sets the value.
Eigen::VectorXd OrbitQuantity::gradient_at(const OrbitEquations& equations, const OrbitEvaluation& at,
                                           const Watched& watched, const std::vector<double>& state,
                                           double& value) const {
    const std::vector<double> all = watched.function(concatenated(state, at.parameters));
    value = all[0];
    return equations.gradient_of(all);
}

bool OrbitQuantity::at_end(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const std::size_t piece = equations.layout().last_piece(segment_.value_or(0));
    const Eigen::VectorXd by_all = gradient_at(equations, at, watched_[0], at.pieces[piece].end, value_);
    gradient_ = equations.row_at_end(at, piece, by_all);
    return true;
}

bool OrbitQuantity::at_start(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const auto n = index(equations.layout().states());
    const std::size_t piece = equations.layout().first_piece(segment_.value_or(0));
    const Watched& watched = watched_[watched_.size() == 1 ? 0 : equations.mode_of(piece)];
    const Eigen::VectorXd by_all = gradient_at(equations, at, watched, start_of_piece(equations, at, piece), value_);
    gradient_.segment(index(equations.layout().start_of(piece)), n) = by_all.head(n).transpose();
    gradient_.tail(by_all.size() - n) = by_all.tail(by_all.size() - n).transpose();
    return true;
}

bool OrbitQuantity::duration(const OrbitEquations& equations, const OrbitEvaluation& at) {
    value_ = 0;
    const double times = !segment_ && equations.symmetry() ? 2 : 1;
    for (const std::size_t k : pieces(equations.layout())) {
        value_ += times * at.unknowns[index(equations.layout().duration_of(k))];
        gradient_[index(equations.layout().duration_of(k))] = times;
    }
    return true;
}

/// Returns the distance in time from the previous touch, as a share of the period, measured cyclically for an orbit
/// without contacts.
double OrbitQuantity::distance_from_touch(const OrbitEquations& equations, double share) const {
    const double off = std::abs(share - *share_);
    const bool is_cyclic =
        equations.signature().size() == 1 && !ends_by_transition(equations.signature()[0]) && !equations.symmetry();
    return is_cyclic ? std::min(off, std::abs(1 - off)) : off;
}

std::optional<OrbitQuantity::Place> OrbitQuantity::find_extremum(const OrbitEquations& equations,
                                                                 const OrbitEvaluation& at) {
    const bool touch = share_.has_value();
    const double sign = kind_ == Monitor::Kind::maximum ? 1 : -1;
    double whole = 0, before = 0; // durations of all pieces, and of the previous ones
    for (const std::size_t k : pieces(equations.layout()))
        whole += at.unknowns[index(equations.layout().duration_of(k))];
    std::optional<Place> best;
    std::vector<double> coefficients, derivative;
    std::vector<Root> found;
    for (const std::size_t k : pieces(equations.layout())) {
        const auto note = [&](std::size_t watched, double time, bool at_end, double value) {
            const double share = (before + time) / whole;
            const double preference = touch ? -distance_from_touch(equations, share) : sign * value;
            if (std::isfinite(preference) && (!best || preference > best->preference))
                best = Place{watched, k, time, at_end, value, preference, share};
        };
        std::vector<double> state = start_of_piece(equations, at, k);
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
                if (!touch)
                    note(watched.series, time, false, coefficients[0]);
                if (length < 0)
                    continue; // for a segment of negative duration only the ends are evaluated
                roots_.crossings(derivative, length, RootStart::as_is, found);
                for (const Root& root : found)
                    note(watched.series, time + root.at, false, evaluate_polynomial(coefficients, root.at));
            }
        });
        if (!touch) // evaluated at the exact end, from which the end of the last step may differ by round-off
            for (const Watched& watched : watched_) {
                double value = 0;
                gradient_at(equations, at, watched, state, value);
                note(watched.series, duration, true, value);
            }
        before += duration;
    }
    return best;
}

bool OrbitQuantity::extremum(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const auto place = find_extremum(equations, at);
    if (!place)
        return false;
    const auto n = index(equations.layout().states()), q = index(equations.free().size());
    const Watched& watched = watched_[place->watched];
    if (place->at_end) { // the extremum moves with the end of the segment
        const Eigen::VectorXd by_all = gradient_at(equations, at, watched, at.pieces[place->piece].end, value_);
        gradient_ = equations.row_at_end(at, place->piece, by_all);
        return true;
    }
    std::vector<double> state = start_of_piece(equations, at, place->piece);
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

/// Integrates the function and its derivatives by the Gauss rule on each Taylor step.
bool OrbitQuantity::mean(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const auto n = index(equations.layout().states()), q = index(equations.free().size());
    double integral = 0, time = 0;
    const double share = 1.0 / static_cast<double>(watched_.size());
    for (const std::size_t k : pieces(equations.layout())) {
        const std::size_t mode = equations.mode_of(k);
        const double duration = at.unknowns[index(equations.layout().duration_of(k))];
        std::vector<double> state = start_of_piece(equations, at, k);
        std::vector<std::pair<double, double>> steps;
        flow_.run(mode, state, duration,
                  [&](const Jet&, double begin, double length) { steps.emplace_back(begin, length); });
        state = start_of_piece(equations, at, k);
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
