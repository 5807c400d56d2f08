#include "branch/accumulating_orbit.hpp"

#include "base/concatenated.hpp"
#include "base/linear_systems.hpp"
#include "base/special_numbers.hpp"
#include "branch/inserted_contact.hpp"
#include "flow/lie_derivative.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/newton.hpp"
#include "orbit/orbit_flow.hpp"
#include "orbit/shooting.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Loosest tolerance of the integration: errors grow with each contact and are not part of the error estimate.
constexpr double finest = 1e-13;
/// Share of the period that is integrated from the start before contacts are watched, since the height is of third
/// order there.
constexpr double blind_share = 1e-3;
/// Share of the period for which the motion is followed: contacts of a first guess may come late.
constexpr double followed_share = 1.1;

} // namespace

AccumulatingOrbit::AccumulatingOrbit(const System& system, const Orbit& like, std::size_t mode, std::size_t event,
                                     ParameterId along, double tolerance)
    : simulation_(system, {}, {}, integration(std::min(tolerance, finest))), flow_(flow_of(simulation_)), like_(like),
      along_(along), mode_(mode), event_(event), first_mode_(mode_) {
    const Model& model = simulation_.model();
    if (like.symmetry)
        if (const Transition* contact = model.find_transition(mode_, event)) {
            const auto transition = static_cast<std::size_t>(contact - model.transitions.data());
            first_mode_ = image_of(system, *like.symmetry, {mode_, SegmentEnd::event, transition}, like).mode;
        }
    constexpr int derivatives = 3;
    heights_.push_back(simulation_.system().event(event));
    for (const Expression& rate : rates_of(simulation_.system(), mode_, event, derivatives))
        heights_.push_back(simulation_.system().with_gradient(rate));
    const Shooting shooting(simulation_, like, {along});
    const auto n = index(model.states.size());
    scales_.resize(n + 1);
    scales_ << shooting.scales().head(n), shooting.scales()[index(shooting.layout().parameter(0))];
    for (const State& state : model.states)
        is_closed_.push_back(!state.drifting);
}

std::vector<double> AccumulatingOrbit::inputs(const VectorXd& state) const {
    return concatenated(state, parameters_);
}

bool AccumulatingOrbit::set(const VectorXd& unknowns) {
    parameters_ = like_.parameters;
    parameters_[along_.place()] = unknowns[parameter_place()];
    if (!unknowns.allFinite())
        return false;
    flow_.set_parameters(parameters_);
    periods_ = simulation_.system().periods()(parameters_);
    return true;
}

VectorXd AccumulatingOrbit::heights(const VectorXd& state) const {
    VectorXd values(index(heights_.size()));
    for (std::size_t k = 0; k < heights_.size(); ++k)
        values[index(k)] = heights_[k](inputs(state))[0];
    return values;
}

MatrixXd AccumulatingOrbit::slopes(const VectorXd& state) const {
    MatrixXd result(index(heights_.size()), state.size());
    for (std::size_t k = 0; k < heights_.size(); ++k)
        result.row(index(k)) = vector_of(heights_[k](inputs(state))).segment(1, state.size()).transpose();
    return result;
}

VectorXd AccumulatingOrbit::field(const VectorXd& state) const {
    return vector_of(simulation_.system().mode(mode_).rates(inputs(state)));
}

bool AccumulatingOrbit::begin(double parameter, std::size_t count, const std::vector<double>& state,
                              std::string& problem) {
    count_ = count;
    jacobian_.resize(0, 0);
    const auto n = index(state.size());
    unknowns_.resize(n + 1);
    unknowns_ << vector_of(state), parameter;
    VectorXd start = vector_of(state);
    if (!set(unknowns_) || !project(start) || !(heights(start)[3] > 0)) {
        problem = "near the touch there is no state in which contacts can accumulate just where the motion leaves: the "
                  "height's third rate is not positive there";
        return false;
    }
    unknowns_.head(n) = start;
    rows_ = (slopes(start).topRows(3) * scales_.head(n).asDiagonal()).rowwise().norm();
    return true; // rows_ is positive, otherwise the projection would have failed
}

/// Projects a state onto the nearest one, in scaled states, at which the height and its first two derivatives are zero.
bool AccumulatingOrbit::project(VectorXd& state) const {
    const auto n = state.size();
    constexpr int iterations = 30;
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i < iterations; ++i) {
        const MatrixXd rows = slopes(state).topRows(3) * scales_.head(n).asDiagonal();
        const VectorXd sizes = rows.rowwise().norm();
        if (!(sizes.minCoeff() > 0))
            return false;
        const VectorXd correction =
            shortest_solution(sizes.cwiseInverse().asDiagonal() * rows, -heights(state).head(3).cwiseQuotient(sizes));
        const double size = correction.cwiseAbs().maxCoeff();
        if (!std::isfinite(size))
            return false;
        state += scales_.head(n).cwiseProduct(correction);
        if (size <= 4 * epsilon || (size < 1e-10 && size >= last))
            return true;
        last = size;
    }
    return last < 1e-10;
}

bool AccumulatingOrbit::compare_with_self_similar(const VectorXd& before, const VectorXd& after,
                                                  Remainder& remainder) const {
    const double arriving = -heights(before)[1];
    const VectorXd leaves = heights(after);
    const double speed = leaves[1], deceleration = -leaves[2], third = leaves[3], restitution = speed / arriving;
    if (!(arriving > 0 && restitution > 0 && restitution < 1 && deceleration > 0 && third > 0))
        return false;
    remainder.contacts = self_similar_contacts(restitution);
    remainder.excess = speed / deceleration * (third / deceleration) / remainder.contacts.speed - 1;
    // Heights decrease with the third power of the remaining time, while the states that they are differences of do
    // not. The excess is therefore known no better than the height of the next flight.
    const double height = speed * speed / (2 * deceleration);
    remainder.uncertainty = epsilon * slopes(after).row(0).cwiseAbs().dot(after.cwiseAbs()) / height;
    return std::isfinite(remainder.excess);
}

/// Computes the state of accumulation, where contacts have held the motion on the surface until its second derivative
/// is zero: the flow plus a multiple of the last contact's jump for all remaining contacts, projected onto the surface.
bool AccumulatingOrbit::find_accumulation(const VectorXd& before, const VectorXd& after, Remainder& remainder) const {
    const auto n = after.size();
    VectorXd movable = scales_.head(n);
    for (Eigen::Index i = 0; i < n; ++i)
        if (periods_[static_cast<std::size_t>(i)] > 0)
            movable[i] = 0; // contacts do not change cyclic states
    const VectorXd rates = field(after), at = heights(after);
    const VectorXd kick =
        (after - before).cwiseQuotient(scales_.head(n)).cwiseProduct(movable) / (at[1] - heights(before)[1]);
    double time = -at[2] / at[3];
    constexpr int iterations = 8;
    for (int i = 0; i < iterations; ++i) {
        remainder.state = after + time * rates;
        remainder.state -= heights(remainder.state)[1] * kick;
        for (int k = 0; k < 3; ++k) {
            const MatrixXd rows = slopes(remainder.state).topRows(2) * movable.asDiagonal();
            const VectorXd missing = -heights(remainder.state).head(2);
            remainder.state += movable.cwiseProduct(shortest_solution(rows, missing));
        }
        const VectorXd values = heights(remainder.state);
        const double change = -values[2] / values[3];
        time += change;
        if (!remainder.state.allFinite() || !std::isfinite(time))
            return false;
        if (std::abs(change) <= 4 * epsilon * std::abs(time))
            break;
    }
    remainder.left = time;
    return true;
}

/// Follows the motion over `count` contacts from the state of accumulation.
bool AccumulatingOrbit::follow(std::size_t count, Remainder& remainder) {
    remainder.start = unknowns_.head(parameter_place());
    if (!project(remainder.start))
        return false;
    const Orbit& orbit = like_;
    const System& system = simulation_.system();
    std::vector<double> state = numbers_of(remainder.start);
    if (orbit.symmetry)
        state = system.symmetry(*orbit.symmetry).map(inputs(vector_of(state)));
    const double period = orbit.return_time();
    const std::vector<double> start = state;
    if (flow_.run(first_mode_, state, blind_share * period) != ModeFlow::Ending::done)
        return false;
    remainder.motion = follow_motion(simulation_, parameters_, state, first_mode_, followed_share * period);
    FollowedMotion& motion = remainder.motion;
    std::size_t contacts = 0, contact = 0;
    for (; contact < motion.segments.size(); ++contact)
        if (motion.segments[contact].mode == mode_ && motion.segments[contact].end == SegmentEnd::event &&
            system.model().transitions[motion.segments[contact].index].event == event_ && ++contacts == count)
            break;
    remainder.contact = contact;
    remainder.segments = contact + 1;
    while (remainder.segments < motion.segments.size() && motion.segments[remainder.segments].mode != mode_)
        ++remainder.segments;
    if (contacts < count || remainder.segments >= motion.segments.size())
        return false;
    std::vector<double> before = motion.starts[contact];
    if (flow_.run(mode_, before, motion.durations[contact]) != ModeFlow::Ending::done)
        return false;
    const VectorXd after = vector_of(motion.starts[remainder.segments]);
    motion.starts[0] = start;
    motion.durations[0] += blind_share * period;
    return compare_with_self_similar(vector_of(before), after, remainder) &&
           find_accumulation(vector_of(before), after, remainder);
}

/// Returns the scaled differences between end and start; 0 for drifting states.
VectorXd AccumulatingOrbit::gaps(const Remainder& remainder) const {
    VectorXd result = remainder.state - remainder.start;
    for (Eigen::Index i = 0; i < result.size(); ++i) {
        const double period = periods_[static_cast<std::size_t>(i)];
        const double gap = period > 0 ? std::remainder(result[i], period) : result[i];
        result[i] = is_closed_[static_cast<std::size_t>(i)] ? gap / scales_[i] : 0;
    }
    return result;
}

bool AccumulatingOrbit::residuals(const VectorXd& unknowns, VectorXd& values, Remainder& remainder) {
    const VectorXd kept = unknowns_;
    unknowns_ = unknowns;
    const bool followed_it = set(unknowns) && follow(count_, remainder);
    unknowns_ = kept;
    if (!followed_it)
        return false;
    const auto n = unknowns.size() - 1;
    values = VectorXd::Zero(3 + n + 1);
    values.head(3) = heights(unknowns.head(n)).head(3).cwiseQuotient(rows_);
    values.segment(3, n) = gaps(remainder);
    values[3 + n] = remainder.excess;
    return values.allFinite();
}

bool AccumulatingOrbit::differentiate(const VectorXd& values) {
    constexpr double step = 1e-6; // of the scales
    jacobian_.resize(values.size(), unknowns_.size());
    VectorXd shifted = unknowns_, there;
    Remainder remainder;
    for (Eigen::Index i = 0; i < unknowns_.size(); ++i) {
        shifted[i] += step * scales_[i];
        if (!residuals(shifted, there, remainder))
            return false;
        jacobian_.col(i) = (there - values) / step;
        shifted[i] = unknowns_[i];
    }
    return true;
}

/// Updates the derivatives of the excess only: their growth with each contact is known, and other derivatives change
/// little.
bool AccumulatingOrbit::renew_excess(const VectorXd& values) {
    constexpr double largest_step = 1e-6, wanted = 1e-3, smallest_step = 1e3 * epsilon;
    const Eigen::Index last = values.size() - 1;
    jacobian_.row(last) /= std::pow(contacts_.ratio, static_cast<double>(added_));
    VectorXd shifted = unknowns_, there;
    Remainder remainder;
    for (Eigen::Index i = 0; i < unknowns_.size(); ++i) {
        const double step = std::min(largest_step, wanted / std::abs(jacobian_(last, i)));
        if (step < smallest_step)
            continue; // differences would be less accurate than the known growth
        shifted[i] += step * scales_[i];
        const double taken = (shifted[i] - unknowns_[i]) / scales_[i];
        if (taken != 0 && residuals(shifted, there, remainder))
            jacobian_(last, i) = (there[last] - values[last]) / taken;
        shifted[i] = unknowns_[i];
    }
    return jacobian_.allFinite();
}

bool AccumulatingOrbit::solve() {
    constexpr int iterations = 20, halvings = 12;
    constexpr double enough = 1e-9, far = 10; // of the scales
    VectorXd values, next;
    Remainder remainder;
    solved_ = false;
    if (!residuals(unknowns_, values, remainder))
        return false;
    if (jacobian_.size() == 0 ? !differentiate(values) : !renew_excess(values))
        return false;
    double last = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < iterations; ++iteration) {
        const VectorXd step = scales_.cwiseProduct(shortest_solution(jacobian_, -values));
        const double size = size_of_step(step);
        if (!(size < far))
            return false;
        // Smaller steps are round-off of the motion.
        if (size <= 4 * epsilon || (size < enough && size >= last))
            break;
        last = size;
        double share = 1;
        const auto helps = [&] {
            return residuals(unknowns_ + share * step, next, remainder) &&
                   (next.norm() < values.norm() || share * size < enough);
        };
        int halved = 0;
        for (; halved < halvings && !helps(); ++halved)
            share /= 2;
        if (halved == halvings)
            return false;
        unknowns_ += share * step;
        // Broyden's update of the derivatives of the first iterate, except for short steps, in which round-off
        // dominates.
        const VectorXd moved = share * step.cwiseQuotient(scales_);
        if (share * size >= enough)
            jacobian_ += (next - values - jacobian_ * moved) * moved.transpose() / moved.squaredNorm();
        values = next;
    }
    contacts_ = remainder.contacts;
    uncertainty_ =
        remainder.uncertainty * scales_[parameter_place()] / std::abs(jacobian_(values.size() - 1, parameter_place()));
    solved_ = last < enough && std::isfinite(uncertainty_);
    if (solved_) {
        solution_ = unknowns_;
        solution_count_ = count_;
    }
    return solved_;
}

void AccumulatingOrbit::add_contacts(std::size_t more) {
    count_ += more;
    added_ = more;
}

std::optional<Orbit> AccumulatingOrbit::orbit_for_output(double& gap) {
    constexpr double little = 1e-4; // share of the period
    Remainder remainder;
    std::optional<Orbit> result;
    unknowns_ = solution_;
    for (std::size_t count = 2; count <= solution_count_ && set(unknowns_) && follow(count, remainder); ++count) {
        const auto taken = [&](const auto& values) {
            return std::vector(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(remainder.segments));
        };
        Orbit orbit{taken(remainder.motion.segments), parameters_, taken(remainder.motion.starts),
                    taken(remainder.motion.durations), like_.symmetry};
        const VectorXd after = vector_of(remainder.motion.starts[remainder.segments]);
        // One last segment stands for all remaining contacts: the orbit ends where they accumulate.
        append(orbit, Segment(orbit.signature[remainder.contact]), remainder.motion.starts[remainder.segments],
               remainder.left);
        gap = gaps(remainder).cwiseAbs().maxCoeff();
        result = orbit;
        if (-heights(after)[2] < little * orbit.return_time() * heights(after)[3])
            break;
    }
    return result;
}

} // namespace graze
