#include "orbit/accumulation.hpp"

#include "base/concatenated.hpp"
#include "base/special_numbers.hpp"
#include "flow/lie_derivative.hpp"
#include "graze/flow/mode_flow.hpp"
#include "graze/symbolic/transform.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "orbit/certify.hpp"
#include "orbit/orbit_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graze {

namespace {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

/// Places in the list of functions on the surface.
enum Surface : std::size_t { deceleration, damping, fall, ratio, kicks };

Expression sum_of(const std::vector<Expression>& one, const std::vector<Expression>& other) {
    Expression sum = one[0] * other[0];
    for (std::size_t i = 1; i < one.size(); ++i)
        sum = sum + one[i] * other[i];
    return sum;
}

std::vector<Component> along(const std::vector<Expression>& symbols, const std::vector<Expression>& direction) {
    std::vector<Component> result;
    for (std::size_t i = 0; i < symbols.size(); ++i)
        result.emplace_back(symbols[i], direction[i]);
    return result;
}

Expression derivative_along(const Expression& function, const std::vector<Component>& field) {
    return differentiate_along(std::span(&function, 1), field).front();
}

} // namespace

Accumulation::Accumulation(const System& system, std::size_t transition, std::vector<ParameterId> free)
    : n_(system.states()), transition_(transition), event_(system.model().transitions.at(transition).event),
      mode_(system.model().transitions.at(transition).mode), free_(std::move(free)) {
    Model model = system.model();
    const Transition& made = model.transitions[transition];
    const auto symbols = model.state_symbols();
    const std::vector<Expression> states(symbols.begin(), symbols.end());
    const std::vector<Expression> rates = model.expand(model.modes[mode_].rates);
    std::vector<Expression> height{model.expand(model.events[event_].function)};
    for (int order = 0; order < 2; ++order)
        height.push_back(lie_derivatives(model, std::span(&height.back(), 1), rates).front());
    for (const Expression& one : height)
        heights_.push_back(system.with_gradient(one));
    const std::vector<Expression> after =
        model.jumps[made.jump].map.empty() ? states : model.expand(std::vector<Expression>(model.jumps[made.jump].map));
    // A direction along the surface that changes the rate: at zero speed a contact changes no state, so that any such
    // direction shows by how much it changes states per speed.
    const std::vector<Expression> normal = jacobian(std::span(height).first(1), states);
    std::vector<Expression> direction = jacobian(std::span(height).subspan(1, 1), states);
    const Expression part = sum_of(direction, normal) / sum_of(normal, normal);
    for (std::size_t i = 0; i < n_; ++i)
        direction[i] = direction[i] - part * normal[i];
    std::vector<Expression> changes;
    for (std::size_t i = 0; i < n_; ++i)
        changes.push_back(after[i] - states[i]);
    std::vector<Expression> kick = differentiate_along(changes, along(states, direction));
    const Expression change = derivative_along(height[1], along(states, kick));
    const Expression speed = derivative_along(height[1], along(states, direction));
    for (Expression& one : kick)
        one = one / change;
    std::vector<Expression> held;
    for (std::size_t i = 0; i < n_; ++i)
        held.push_back(rates[i] - kick[i] * height[2]);
    std::vector<Expression> all{-height[2], -derivative_along(height[2], along(states, kick)),
                                derivative_along(height[2], along(states, held)), -change / speed - 1.0};
    all.insert(all.end(), kick.begin(), kick.end());
    all.insert(all.end(), held.begin(), held.end());
    for (const Expression& one : all)
        surface_.push_back(system.with_gradient(one));
}

/// Values of the functions on the surface, and derivatives: rows are functions.
struct Accumulation::Field {
    VectorXd values;
    MatrixXd by;

    VectorXd kick(Eigen::Index n) const { return values.segment(kicks, n); }
    VectorXd held(Eigen::Index n) const { return values.segment(index(kicks) + n, n); }
    MatrixXd kick_by(Eigen::Index n) const { return by.middleRows(kicks, n); }
    MatrixXd held_by(Eigen::Index n) const { return by.middleRows(index(kicks) + n, n); }
};

RowVectorXd Accumulation::gradient_of(std::span<const double> values) const {
    RowVectorXd gradient(index(n_ + free_.size()));
    for (std::size_t i = 0; i < n_; ++i)
        gradient[index(i)] = values[1 + i];
    for (std::size_t f = 0; f < free_.size(); ++f)
        gradient[index(n_ + f)] = values[1 + n_ + free_[f].place()];
    return gradient;
}

Accumulation::Field Accumulation::field(const VectorXd& state, std::span<const double> parameters) const {
    const std::vector<double> inputs = concatenated(state, parameters);
    Field result{VectorXd(index(surface_.size())), MatrixXd(index(surface_.size()), index(n_ + free_.size()))};
    for (std::size_t i = 0; i < surface_.size(); ++i) {
        const std::vector<double> values = surface_[i](inputs);
        result.values[index(i)] = values[0];
        result.by.row(index(i)) = gradient_of(values);
    }
    return result;
}

std::vector<double> Accumulation::heights(std::span<const double> state, std::span<const double> parameters) const {
    std::vector<double> result;
    for (const Function& one : heights_)
        result.push_back(one(concatenated(state, parameters))[0]);
    return result;
}

double Accumulation::size(std::span<const double> state, std::span<const double> parameters) const {
    const std::vector<double> values = heights_[0](concatenated(state, parameters));
    double sum = 0;
    for (std::size_t i = 0; i < n_; ++i)
        sum += std::abs(values[1 + i] * state[i]);
    return sum;
}

bool Accumulation::evaluate(std::span<const double> state, std::span<const double> parameters,
                            Remainder& result) const {
    const auto n = index(n_), all = index(n_ + free_.size());
    const VectorXd start = Eigen::Map<const VectorXd>(state.data(), n);
    const std::vector<double> speeds = heights_[1](concatenated(start, parameters));
    const double u = speeds[0];
    const RowVectorXd u_by = gradient_of(speeds);
    // The state without its speed, through which the motion that is held on the surface passes.
    const Field at_contact = field(start, parameters);
    const VectorXd kick = at_contact.kick(n);
    const VectorXd slow = start - u * kick;
    MatrixXd slow_by = -(kick * u_by + u * at_contact.kick_by(n));
    slow_by.leftCols(n) += MatrixXd::Identity(n, n);
    const Field here = field(slow, parameters);
    // Derivatives of functions at another state than the start, by the chain rule.
    const auto chained = [&](const MatrixXd& by, const MatrixXd& state_by) {
        MatrixXd total = by.leftCols(n) * state_by;
        total.rightCols(all - n) += by.rightCols(all - n);
        return total;
    };
    const MatrixXd by = chained(here.by, slow_by);
    const double a = here.values[deceleration], c = here.values[damping], j = here.values[fall], r = here.values[ratio];
    if (!(a > 0) || !(std::abs(r) < 1) || !std::isfinite(u))
        return false;
    const RowVectorXd a_by = by.row(deceleration), c_by = by.row(damping), j_by = by.row(fall), r_by = by.row(ratio);
    const double steady = 2 * u / (a * (1 - r));
    const RowVectorXd steady_by = 2 * u_by / (a * (1 - r)) - steady * (a_by / a - r_by / (1 - r));
    // The first-order lengthening: half the steady time times (2 J / A - c) / 3.
    const double per_time = (2 * j / a - c) / 6;
    const RowVectorXd per_time_by = (2 * j_by / a - 2 * j / (a * a) * a_by - c_by) / 6;
    result.time = steady * (1 + per_time * steady);
    result.time_by = ((1 + 2 * per_time * steady) * steady_by + steady * steady * per_time_by).transpose();
    // Heun's step along the motion that is held on the surface.
    const VectorXd first = here.held(n);
    const MatrixXd first_by = by.middleRows(index(kicks) + n, n);
    const VectorXd predicted = slow + result.time * first;
    const MatrixXd predicted_by = slow_by + first * result.time_by.transpose() + result.time * first_by;
    const Field there = field(predicted, parameters);
    const VectorXd rates = 0.5 * (first + there.held(n));
    result.state = slow + result.time * rates;
    result.state_by = slow_by + rates * result.time_by.transpose() +
                      0.5 * result.time * (first_by + chained(there.held_by(n), predicted_by));
    result.deceleration = there.values[deceleration];
    result.ratio = r;
    const double change = std::abs(steady) * (std::abs(j) / a + std::abs(c)),
                 of_ratio = (std::abs(there.values[ratio] - r) + std::abs(at_contact.values[ratio] - r)) / (1 - r);
    constexpr double negligible = 1e-12; // differences of ratios by round-off
    result.relative_error = 4 * change * change + (of_ratio > negligible ? of_ratio : 0);
    result.round_off = 2 * epsilon * size(state, parameters) / (std::abs(u) * (1 - r));
    return std::isfinite(result.time) && result.state.allFinite() && result.state_by.allFinite() &&
           result.time_by.allFinite();
}

double excess_error(const Accumulation::Remainder& remainder, double duration) {
    // Share of the duration: with more contacts their round-off, divided by their speed, would be larger than this.
    constexpr double allowed = 1e-12;
    // Forces that vary once along the segment change by this share of themselves.
    const double turn = 2 * std::numbers::pi * remainder.time / duration;
    return std::abs(remainder.time / duration) * (remainder.relative_error + turn * turn) / allowed;
}

namespace {

/// Records the contacts of a chatter sequence until the remaining ones can be summed.
class ChatterRecorder : public Observer {
public:
    ChatterRecorder(const System& system, const Accumulation& accumulation, std::span<const double> parameters,
                    double duration, std::optional<std::size_t> count, ChatterContacts& contacts)
        : system_(&system), accumulation_(&accumulation), parameters_(parameters), duration_(duration), count_(count),
          contacts_(&contacts) {}

    void contact(const Contact& contact) override {
        if (complete_ || contact.kind == ContactKind::touch ||
            (contact.kind == ContactKind::crossing && is_identity_transition(*system_, contact.transition)))
            return;
        const Model& model = system_->model();
        if (contact.kind == ContactKind::sticking && contact.event == accumulation_->event()) {
            complete_ = !count_ && accurate_enough(still_enough);
            ended_ = true;
            return;
        }
        if (contact.transition != accumulation_->transition() || contact.mode_after != accumulation_->mode()) {
            contacts_->problem =
                fmt::format("'{}' comes before the contacts accumulate", model.transitions[contact.transition].label);
            return;
        }
        contacts_->durations.push_back(contact.time - last_);
        contacts_->starts.emplace_back(contact.after.begin(), contact.after.end());
        last_ = contact.time;
        complete_ = count_ ? contacts_->durations.size() == *count_ : accurate_enough(1);
    }
    bool stop() override {
        constexpr std::size_t most_contacts = 2000;
        return complete_ || ended_ || !contacts_->problem.empty() || contacts_->durations.size() >= most_contacts;
    }
    bool is_complete() const { return complete_; }

private:
    /// Of a sequence that the simulation completes earlier.
    static constexpr double still_enough = 1e2;

    bool accurate_enough(double most) const {
        Accumulation::Remainder remainder;
        return !contacts_->durations.empty() &&
               accumulation_->evaluate(contacts_->starts.back(), parameters_, remainder) &&
               excess_error(remainder, duration_) <= most;
    }

    const System* system_;
    const Accumulation* accumulation_;
    std::span<const double> parameters_;
    double duration_;
    std::optional<std::size_t> count_;
    ChatterContacts* contacts_;
    double last_ = 0;
    bool complete_ = false, ended_ = false;
};

} // namespace

ChatterContacts follow_chatter(const Simulation& simulation, const Accumulation& accumulation,
                               std::span<const double> parameters, std::span<const double> start, double duration,
                               std::optional<std::size_t> count) {
    constexpr double followed_share = 1.5; // of the duration: contacts of a first guess may come late
    constexpr double blind_share = 1e-3;   // of the duration
    constexpr double on_surface = 1e-9;    // of the size of the terms of the event function
    constexpr double without_speed = 1e-6; // change over the duration, as a share of the same
    ChatterContacts contacts;
    contacts.starts.emplace_back(start.begin(), start.end());
    if (!(duration > 0)) {
        contacts.problem = "its duration is not positive";
        return contacts;
    }
    // Just after it has left the surface the motion is within round-off of it, and is not watched there.
    std::vector<double> state = contacts.starts.front();
    const std::vector<double> height = accumulation.heights(state, parameters);
    const double by_speed = std::abs(height[1]) * duration,
                 size = accumulation.size(state, parameters) + by_speed + std::abs(height[2]) * duration * duration;
    double blind = 0;
    if (std::abs(height[0]) <= on_surface * size) {
        blind = blind_share * duration;
        if (by_speed > without_speed * size && height[1] > 0 && height[2] < 0) // a known flight may be shorter
            blind = std::min(blind, -0.5 * height[1] / height[2]);
        ModeFlow flow = flow_of(simulation);
        flow.set_parameters(parameters);
        if (flow.run(accumulation.mode(), state, blind) != ModeFlow::Ending::done) {
            contacts.problem = "the motion ceases to exist at its start";
            return contacts;
        }
    }
    ChatterRecorder recorder(simulation.system(), accumulation, parameters, duration, count, contacts);
    Trajectory trajectory(simulation, parameters, borrowed(recorder));
    trajectory.start(state, accumulation.mode(), 0, followed_share * duration);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    if (!contacts.durations.empty())
        contacts.durations.front() += blind;
    if (!recorder.is_complete() && contacts.problem.empty())
        contacts.problem = fmt::format("contacts at '{}' do not accumulate in the time of the segment",
                                       simulation.model().events[accumulation.event()].name);
    return contacts;
}

} // namespace graze
