#include "orbit/orbit_equations.hpp"

#include "base/concatenated.hpp"
#include "flow/cyclic.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

std::vector<double> usual_values(const Model& model, const std::vector<ParameterId>& free) {
    const std::vector<double> all = model.parameter_values();
    std::vector<double> result;
    for (const ParameterId f : free)
        result.push_back(all.at(f.place()));
    return result;
}

const Orbit& valid(const Model& model, const Orbit& orbit) {
    validate_orbit(model, orbit);
    if (is_rest(orbit.signature))
        throw InputError("an equilibrium is asked for contacts or a period, and has none",
                         "choose a point of a branch of periodic orbits");
    return orbit;
}

} // namespace

Eigen::MatrixXd jump_times(const OrbitEvaluation::Piece& piece, const Eigen::MatrixXd& derivatives) {
    const Eigen::Index n = piece.jump.rows();
    if (n <= many_states)
        return piece.jump.leftCols(n) * derivatives;
    Eigen::MatrixXd result = derivatives;
    for (Eigen::Index i = 0; i < n; ++i) {
        Eigen::RowVectorXd change = piece.jump.row(i).head(n);
        change[i] -= 1;
        if (!change.isZero(0))
            result.row(i) = piece.jump.row(i).head(n) * derivatives;
    }
    return result;
}

OrbitEquations::OrbitEquations(const Simulation& simulation, const Orbit& orbit, std::vector<ParameterId> free,
                               std::vector<double> ranges)
    : simulation_(simulation), ends_(simulation.system(), valid(simulation.model(), orbit), std::move(free)),
      flow_(flow_of(simulation, ends_.free())), layout_(simulation.system().states(), {}, 0, ends_.free().size()),
      orbit_scales_(simulation.system().states(), usual_values(simulation.model(), ends_.free()), std::move(ranges)),
      parameters_(orbit.parameters), reference_(orbit.starts.front()) {
    for (const Segment& segment : orbit.signature) {
        modes_.push_back(segment.mode);
        accumulations_.emplace_back();
        if (segment.end == SegmentEnd::chatter)
            accumulations_.back().emplace(simulation.system(), segment.index, ends_.free());
    }
    if (is_homoclinic(orbit.signature))
        homoclinic_.emplace(simulation.system(), modes_.back(), ends_.free());
    if (orbit.cycle)
        cycle_.emplace(simulation, orbit, ends_.free());
    flow_.set_parameters(parameters_);
    follow_contacts(orbit);
}

/// Finds the contacts of the chatter sequences that are resolved one by one.
void OrbitEquations::follow_contacts(const Orbit& orbit) {
    contacts_.resize(orbit.segments());
    for (std::size_t s = 0; s < orbit.segments(); ++s) {
        if (!accumulations_[s])
            continue;
        contacts_[s] =
            follow_chatter(simulation_, *accumulations_[s], orbit.parameters, orbit.starts[s], orbit.durations[s]);
        if (!contacts_[s].problem.empty())
            contacts_problem_ =
                fmt::format("segment {} is no complete chatter sequence: {}", s + 1, contacts_[s].problem);
    }
}

void OrbitEquations::lay_out(const Orbit& orbit, const std::vector<std::size_t>& counts, std::size_t inner) {
    std::vector<bool> chatter;
    for (const std::optional<Accumulation>& one : accumulations_)
        chatter.push_back(one.has_value());
    layout_ = OrbitLayout(layout_.states(), counts, inner, layout_.free(), std::move(chatter));
    fixed_durations_.clear();
    for (std::size_t k = 0; k < layout_.pieces(); ++k) {
        const std::size_t segment = layout_.segment_of(k);
        fixed_durations_.push_back(orbit.durations[segment] / static_cast<double>(counts[segment]));
    }
    const Eigen::VectorXd unknowns = unknowns_of(orbit);
    set_scales(unknowns);
    ends_.lay_cuts(orbit, scales_.head(index(layout_.states())));
    if (homoclinic_)
        keep_distances(unknowns);
    if (cycle_) {
        std::vector<double> end, parameters;
        cycle_->set_scales(extents(unknowns, parameters, end));
    }
    OrbitEvaluation at = evaluation();
    if (layout_.free() > 0 && evaluate(unknowns, at)) // the evaluation has measured the effects of the parameters
        set_scales(unknowns);
}

/// Returns the extents of the states along the orbit. @param parameters, end set to its parameters and last state
Eigen::VectorXd OrbitEquations::extents(const Eigen::VectorXd& unknowns, std::vector<double>& parameters,
                                        std::vector<double>& end) {
    constexpr int parts = 24;
    const std::size_t n = layout_.states();
    set_parameters(unknowns, parameters);
    StateScales sizes(n);
    sizes.begin();
    for (std::size_t k = 0; k < layout_.pieces(); ++k) {
        const double* const start = unknowns.data() + layout_.start_of(k);
        end.assign(start, start + n);
        sizes.note(end);
        for (int part = 0; part < parts; ++part) {
            flow_.run(mode_of(k), end, unknowns[index(layout_.duration_of(k))] / parts);
            sizes.note(end);
        }
    }
    const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(index(n), index(n));
    return vector_of(sizes.choose(ends_.periods(), none, none));
}

/// Keeps the distances from the saddle at which an orbit begins and ends, in units of the extents of the states.
void OrbitEquations::keep_distances(const Eigen::VectorXd& unknowns) {
    std::vector<double> end, parameters;
    const Eigen::VectorXd sizes = extents(unknowns, parameters, end);
    homoclinic_->keep_distances({unknowns.data(), layout_.states()}, end, parameters, sizes);
}

Eigen::VectorXd OrbitEquations::unknowns_of(const Orbit& orbit) {
    Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(index(layout_.unknowns()));
    flow_.set_parameters(orbit.parameters);
    for (std::size_t s = 0; s < layout_.segments(); ++s) {
        if (layout_.is_chatter(s)) {
            set_contacts(orbit, s, unknowns);
            continue;
        }
        std::vector<double> state = orbit.starts[s];
        double remaining = orbit.durations[s];
        for (std::size_t k = layout_.first_piece(s); k <= layout_.last_piece(s); ++k) {
            const double duration = layout_.is_last(k) ? remaining : fixed_durations_[k];
            std::ranges::copy(state, unknowns.data() + layout_.start_of(k));
            unknowns[index(layout_.duration_of(k))] = duration;
            if (!layout_.is_last(k))
                flow_.run(modes_[s], state, duration);
            remaining -= duration;
        }
    }
    for (std::size_t f = 0; f < layout_.free(); ++f)
        unknowns[index(layout_.parameter(f))] = orbit.parameters[free()[f].place()];
    set_inner(orbit, unknowns);
    clear_vanishing_states(unknowns);
    return unknowns;
}

/// Sets the starts and durations of the flights of a chatter sequence, and of all that are left.
void OrbitEquations::set_contacts(const Orbit& orbit, std::size_t s, Eigen::VectorXd& unknowns) {
    const std::size_t first = layout_.first_piece(s), count = layout_.last_piece(s) - first;
    const bool known = contacts_[s].durations.size() == count && contacts_[s].starts.front() == orbit.starts[s] &&
                       parameters_ == orbit.parameters;
    ChatterContacts found;
    if (count == 0) // they do not accumulate
        found.starts.push_back(orbit.starts[s]);
    else
        found = known ? contacts_[s]
                      : follow_chatter(simulation_, *accumulations_[s], orbit.parameters, orbit.starts[s],
                                       orbit.durations[s], count);
    if (!found.problem.empty())
        contacts_problem_ = fmt::format("segment {} is no complete chatter sequence: {}", s + 1, found.problem);
    double remaining = orbit.durations[s];
    for (std::size_t i = 0; i <= count; ++i) {
        const bool there = i < found.starts.size() && (i == count || i < found.durations.size());
        const double duration = !there       ? std::numeric_limits<double>::quiet_NaN() // evaluations will refuse it
                                : i == count ? remaining
                                             : found.durations[i];
        std::ranges::copy(found.starts[there ? i : 0], unknowns.data() + layout_.start_of(first + i));
        unknowns[index(layout_.duration_of(first + i))] = duration;
        remaining -= duration;
    }
}

/// Sets states to zero that are negligible against the others all along the orbit: they are decaying to zero, as a
/// symmetry demands, and would otherwise shrink until they underflow.
void OrbitEquations::clear_vanishing_states(Eigen::VectorXd& unknowns) const {
    constexpr double remnant = 1e-25;
    const std::vector<double>& periods = ends_.periods();
    std::vector<double> sizes(layout_.states(), 0.0);
    double largest = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        for (std::size_t k = 0; k < layout_.pieces(); ++k)
            sizes[i] = std::max(sizes[i], std::abs(unknowns[index(layout_.start_of(k) + i)]));
        if (periods[i] == 0 && !model().states[i].drifting)
            largest = std::max(largest, sizes[i]);
    }
    for (std::size_t i = 0; i < sizes.size(); ++i)
        if (periods[i] == 0 && sizes[i] < remnant * largest)
            for (std::size_t k = 0; k < layout_.pieces(); ++k)
                unknowns[index(layout_.start_of(k) + i)] = 0;
}

/// Appends the starts and durations of the segments, of an orbit or of a direction.
void OrbitEquations::take_segments(const Eigen::VectorXd& unknowns, std::vector<std::vector<double>>& starts,
                                   std::vector<double>& durations) const {
    for (std::size_t s = 0; s < layout_.segments(); ++s) {
        const double* start = unknowns.data() + layout_.start_of(layout_.first_piece(s));
        starts.emplace_back(start, start + layout_.states());
        double duration = 0;
        for (std::size_t k = layout_.first_piece(s); k <= layout_.last_piece(s); ++k)
            duration += unknowns[index(layout_.duration_of(k))];
        durations.push_back(duration);
    }
}

Orbit OrbitEquations::orbit_of(const Eigen::VectorXd& unknowns) const {
    Orbit orbit{signature(), parameters_, {}, {}, symmetry()};
    if (cycle_)
        orbit.cycle = cycle_->cycle().segments();
    for (std::size_t f = 0; f < layout_.free(); ++f)
        orbit.parameters[free()[f].place()] = unknowns[index(layout_.parameter(f))];
    take_segments(unknowns, orbit.starts, orbit.durations);
    return orbit;
}

OrbitDirection OrbitEquations::direction_of(const Eigen::VectorXd& unknowns) const {
    OrbitDirection direction;
    take_segments(unknowns, direction.starts, direction.durations);
    for (std::size_t f = 0; f < layout_.free(); ++f)
        direction.parameters.push_back(unknowns[index(layout_.parameter(f))]);
    return direction;
}

Eigen::VectorXd OrbitEquations::unknowns_of(const OrbitDirection& direction, const OrbitEvaluation& at) const {
    const auto n = index(layout_.states()), q = index(layout_.free());
    bool fits = direction.starts.size() == layout_.segments() && direction.durations.size() == layout_.segments();
    for (const std::vector<double>& start : direction.starts)
        fits = fits && start.size() == layout_.states();
    if (!fits || direction.parameters.empty())
        throw InputError("the direction does not fit the orbit",
                         "give what each segment's start and duration gains, and each parameter that varies");
    Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(index(layout_.unknowns()));
    for (std::size_t f = 0; f < std::min(layout_.free(), direction.parameters.size()); ++f)
        unknowns[index(layout_.parameter(f))] = direction.parameters[f];
    for (std::size_t s = 0; s < layout_.segments(); ++s) {
        Eigen::VectorXd start = Eigen::Map<const Eigen::VectorXd>(direction.starts[s].data(), n);
        double before = 0; // change of the durations of the flights of a chatter sequence
        for (std::size_t k = layout_.first_piece(s); k <= layout_.last_piece(s); ++k) {
            unknowns.segment(index(layout_.start_of(k)), n) = start;
            const OrbitEvaluation::Piece& piece = at.pieces[k];
            start = Eigen::VectorXd(piece.flow.leftCols(n) * start) + piece.flow.rightCols(q) * unknowns.tail(q);
            if (!layout_.is_contact(k))
                continue;
            // The contact comes later where the event function has gained.
            const double gain = piece.condition.head(n).dot(start) + piece.condition.tail(q).dot(unknowns.tail(q));
            const double later = -gain / piece.condition.head(n).dot(piece.by_time);
            unknowns[index(layout_.duration_of(k))] = later;
            before += later;
            start += later * piece.by_time;
            start = Eigen::VectorXd(piece.jump.leftCols(n) * start) + piece.jump.rightCols(q) * unknowns.tail(q);
        }
        unknowns[index(layout_.duration_of(layout_.last_piece(s)))] = direction.durations[s] - before;
    }
    if (layout_.inner() == 0)
        return unknowns;
    Eigen::VectorXd outer(index(layout_.inner_of(0)) + q);
    outer << unknowns.head(outer.size() - q), unknowns.tail(q);
    Eigen::VectorXd units(outer.size());
    units << at.scales.head(outer.size() - q), at.scales.tail(q);
    return expanded(at, outer.cwiseQuotient(units), true);
}

void OrbitEquations::set_parameters(const Eigen::VectorXd& unknowns, std::vector<double>& parameters) {
    parameters = parameters_;
    for (std::size_t f = 0; f < layout_.free(); ++f)
        parameters[free()[f].place()] = unknowns[index(layout_.parameter(f))];
    flow_.set_parameters(parameters);
    ends_.set_parameters(parameters);
    if (homoclinic_)
        homoclinic_->set_parameters(parameters);
    if (cycle_)
        cycle_->set_parameters(parameters);
}

void OrbitEquations::set_scales(const Eigen::VectorXd& unknowns) {
    std::vector<double> parameters;
    set_parameters(unknowns, parameters);
    scales_ = orbit_scales_.choose(layout_, unknowns, modes_, flow_, ends_.periods());
    raise_above_round_off(unknowns, parameters);
}

/// Raises scales above the round-off of the integrated rates: a state that only round-off moves, as one that a symmetry
/// keeps at rest, has no extent of its own.
void OrbitEquations::raise_above_round_off(const Eigen::VectorXd& unknowns, const std::vector<double>& parameters) {
    constexpr double noise_share = 1e-11; // share of the scale: below the accuracy of orbits
    const std::size_t n = layout_.states();
    std::vector<double> inputs(n + parameters.size()), errors(inputs.size()), bounds(n), noise(n, 0.0),
        work(2 * system().workspace());
    std::ranges::copy(parameters, inputs.begin() + static_cast<std::ptrdiff_t>(n));
    double time = 0;
    for (std::size_t k = 0; k < layout_.pieces(); ++k)
        time += std::abs(unknowns[index(layout_.duration_of(k))]);
    for (std::size_t k = 0; k < layout_.pieces(); ++k) {
        std::copy_n(unknowns.data() + layout_.start_of(k), n, inputs.begin());
        std::ranges::fill(errors, 0.0);
        // The second pass propagates the error of a velocity to its position.
        for (int order = 0; order < 2; ++order) {
            system().mode(mode_of(k)).rates.error_bounds(inputs, errors, bounds, work);
            for (std::size_t i = 0; i < n; ++i) {
                errors[i] = std::isfinite(bounds[i] * time) ? bounds[i] * time : 0;
                noise[i] = std::max(noise[i], errors[i]);
            }
        }
    }
    for (std::size_t k = 0; k < layout_.pieces(); ++k) {
        for (std::size_t i = 0; i < n; ++i)
            scales_[index(layout_.start_of(k) + i)] =
                std::max(scales_[index(layout_.start_of(k) + i)], noise[i] / noise_share);
        for (std::size_t j = 0; j < layout_.inner(); ++j)
            scales_[index(layout_.inner_of(k) + j)] =
                std::max(scales_[index(layout_.inner_of(k) + j)], noise[j % n] / noise_share);
    }
}

ModeFlow& OrbitEquations::flow_at(const OrbitEvaluation& at) {
    flow_.set_parameters(at.parameters);
    return flow_;
}

bool OrbitEquations::evaluate(const Eigen::VectorXd& unknowns, OrbitEvaluation& at) {
    at.unknowns.resize(0);
    at.problem.clear();
    at.took_too_long = false;
    if (!unknowns.allFinite()) {
        at.problem = contacts_problem_.empty() ? "an unknown is not finite" : contacts_problem_;
        return false;
    }
    set_parameters(unknowns, at.parameters);
    if (homoclinic_ && !homoclinic_->problem().empty()) {
        at.problem = homoclinic_->problem();
        return false;
    }
    if (cycle_ && !cycle_->problem().empty()) {
        at.problem = cycle_->problem();
        return false;
    }
    at.periods = ends_.periods();
    at.scales = scales_;
    at.pieces.resize(layout_.pieces());
    at.system.resize(layout_.pieces());
    for (std::size_t k = 0; k < layout_.pieces(); ++k)
        if (!evaluate_piece(k, unknowns, at))
            return false;
    assemble(unknowns, at);
    orbit_scales_.note_effects(at.effects);
    at.residual = 0;
    for (std::size_t k = 0; k < layout_.pieces(); ++k)
        at.residual = std::max(at.residual, at.system.block(k).right.cwiseAbs().maxCoeff());
    const Eigen::Index inner = index(layout_.inner());
    for (std::size_t k = 0; k < layout_.pieces() && inner > 0; ++k) {
        const auto units = scales_.segment(index(layout_.inner_of(k)), inner);
        const double lack = at.pieces[k].inner.rightCols(1).cwiseQuotient(units).cwiseAbs().maxCoeff();
        at.residual = std::max(at.residual, lack);
    }
    if (!std::isfinite(at.residual) || !at.system.factor()) {
        at.problem = "an equation is not finite";
        return false;
    }
    at.unknowns = unknowns;
    return true;
}

bool OrbitEquations::evaluate_piece(std::size_t k, const Eigen::VectorXd& unknowns, OrbitEvaluation& at) {
    if (layout_.is_contact(k) && !(unknowns[index(layout_.duration_of(k))] > 0)) {
        at.problem = fmt::format("two contacts of segment {} come at the same time", layout_.segment_of(k) + 1);
        return false;
    }
    if (!(layout_.accumulates(k) ? accumulate(k, unknowns, at) : follow(k, unknowns, at)))
        return false;
    OrbitEvaluation::Piece& piece = at.pieces[k];
    const std::size_t segment = layout_.segment_of(k);
    const auto n = index(layout_.states());
    piece.jump.setZero(n, n + index(layout_.free()));
    piece.jump.leftCols(n).setIdentity();
    piece.after = piece.end;
    if (!layout_.has_end(k))
        return true;
    if (homoclinic_ && k + 1 == layout_.pieces()) {
        const HomoclinicEnds::Condition approach = homoclinic_->approaches(piece.end);
        piece.condition_value = approach.value;
        piece.condition = approach.gradient;
        return std::isfinite(approach.value);
    }
    if (ends_.pass(segment, piece, passed_at(k)))
        return true;
    at.problem = fmt::format("the jump after segment {} is not defined", segment + 1);
    return false;
}

SegmentEnds::Passed OrbitEquations::passed_at(std::size_t piece) const {
    return layout_.is_contact(piece) ? SegmentEnds::Passed::contact : SegmentEnds::Passed::end;
}

/// Takes in all contacts of a chatter sequence that are left. The state at their accumulation does not depend on the
/// duration of the piece, which is an unknown that the time of the accumulation determines.
bool OrbitEquations::accumulate(std::size_t k, const Eigen::VectorXd& unknowns, OrbitEvaluation& at) {
    // Excess error of the sum, beyond which other contacts must be resolved: a step leads less far instead.
    constexpr double usable = 1e3;
    const std::size_t segment = layout_.segment_of(k), n = layout_.states();
    OrbitEvaluation::Piece& piece = at.pieces[k];
    Accumulation::Remainder left;
    if (!accumulations_[segment]->evaluate({unknowns.data() + layout_.start_of(k), n}, at.parameters, left) ||
        !(excess_error(left, duration_of_segment(unknowns, segment)) < usable)) {
        at.problem = contacts_problem_.empty()
                         ? fmt::format("the contacts of segment {} do not accumulate", segment + 1)
                         : contacts_problem_;
        return false;
    }
    piece.end = numbers_of(left.state);
    piece.flow = left.state_by;
    piece.by_time.setZero(index(n));
    piece.field.setZero(index(n));
    piece.condition.setZero(left.time_by.size());
    piece.condition_value = unknowns[index(layout_.duration_of(k))] - left.time;
    piece.time_by = left.time_by;
    piece.time_round_off = left.round_off;
    piece.watched = {};
    piece.inner.resize(0, 0);
    return true;
}

bool OrbitEquations::has_chatter() const {
    return std::ranges::any_of(accumulations_, [](const auto& one) { return one.has_value(); });
}

double OrbitEquations::duration_of_segment(const Eigen::VectorXd& unknowns, std::size_t segment) const {
    double duration = 0;
    for (std::size_t k = layout_.first_piece(segment); k <= layout_.last_piece(segment); ++k)
        duration += unknowns[index(layout_.duration_of(k))];
    return duration;
}

double OrbitEquations::round_off(const OrbitEvaluation& at) const {
    double result = 0;
    for (std::size_t s = 0; s < layout_.segments(); ++s)
        if (const std::size_t last = layout_.last_piece(s); layout_.accumulates(last))
            result = std::max(result, at.pieces[last].time_round_off / scales_[index(layout_.duration_of(last))]);
    return result;
}

bool OrbitEquations::contacts_need_renewal(const OrbitEvaluation& at) const {
    // Bounds of the excess error: few contacts sum what is not slow yet, many are round-off.
    constexpr double few = 10, many = 1e-4;
    for (std::size_t s = 0; s < layout_.segments(); ++s) {
        if (!layout_.is_chatter(s))
            continue;
        Accumulation::Remainder left;
        const double* const start = at.unknowns.data() + layout_.start_of(layout_.last_piece(s));
        if (!accumulations_[s]->evaluate({start, layout_.states()}, at.parameters, left))
            return true;
        const double error = excess_error(left, duration_of_segment(at.unknowns, s));
        const double per_contact = std::abs(left.ratio * left.ratio * left.ratio);
        if (!(error < few) || error < many * per_contact)
            return true;
    }
    return false;
}

/// Fills the blocks of the linear system, in scaled unknowns and equations.
void OrbitEquations::assemble(const Eigen::VectorXd& unknowns, OrbitEvaluation& at) {
    std::vector<bool> neutral(layout_.states(), !homoclinic_ && !cycle_);
    at.effects.setZero(index(layout_.free()));
    for (std::size_t k = 0; k < layout_.pieces(); ++k) {
        CyclicSystem::Block& block = at.system.block(k);
        block.own.setZero();
        block.next.setZero();
        if (layout_.accumulates(k)) {
            assemble_accumulation(k, at);
        } else if (layout_.has_end(k)) {
            assemble_end(k, unknowns[index(layout_.duration_of(k))], at);
        } else {
            const Eigen::Index duration = index(layout_.duration_of(k));
            block.own(0, index(layout_.states())) = 1;
            block.parameters.row(0).setZero();
            block.right[0] = (fixed_durations_[k] - unknowns[duration]) / scales_[duration];
        }
        if (homoclinic_ && k + 1 == layout_.pieces())
            assemble_ends_at_saddle(unknowns, at);
        else if (cycle_ && k + 1 == layout_.pieces())
            assemble_ends_at_cycle(unknowns, at);
        else
            assemble_closure(k, unknowns, at, neutral);
    }
    // A state whose sign is reversed an odd number of times must be zero: it is not neutral.
    for (std::size_t i = 0; i < layout_.states(); ++i)
        for (std::size_t k = 0, reversed = 0; neutral[i] && k < layout_.pieces(); ++k) {
            reversed += at.system.block(k).own(1 + index(i), index(i)) > 0 ? 1 : 0;
            neutral[i] = k + 1 < layout_.pieces() || reversed % 2 == 0;
        }
    drop_accidentally_neutral(at, neutral);
    pin(unknowns, neutral, at);
}

/// Clears the neutral flag of states that are neutral only at this parameter: at a branch point a state that is zero
/// along the orbit may have an identity return map by accident. A state counts as neutral only if at shifted parameters
/// the flow and the jump still return a small change of it.
void OrbitEquations::drop_accidentally_neutral(const OrbitEvaluation& at, std::vector<bool>& neutral) {
    constexpr double parameter_shift = 1e-2, state_shift = 1e-9,
                     // Shift of parameters and of the state, in scales; tolerance, as a share of the latter.
        identity_tolerance = 1e-6;
    const std::size_t n = layout_.states();
    if (free().empty() || std::find(neutral.begin(), neutral.end(), true) == neutral.end())
        return;
    std::vector<double> parameters = at.parameters;
    for (std::size_t f = 0; f < free().size(); ++f)
        parameters[free()[f].place()] += parameter_shift * scales_[index(layout_.parameter(f))];
    ends_.set_parameters(parameters);
    Eigen::VectorXd rates;
    for (std::size_t k = 0; k < layout_.pieces(); ++k) {
        const std::size_t segment = layout_.segment_of(k);
        const auto state_scales = scales_.segment(index(layout_.start_of(k)), index(n));
        std::vector<double> state = at.pieces[k].end;
        for (std::size_t i = 0; i < n; ++i)
            state[i] += neutral[i] ? state_shift * state_scales[index(i)] : 0;
        ends_.field(segment, state, rates);
        std::vector<double> after = state;
        double condition = 0;
        const bool jumps = layout_.has_end(k) && ends_.pass(segment, after, condition, passed_at(k));
        for (std::size_t i = 0; i < n; ++i) {
            const double most = identity_tolerance * state_shift * state_scales[index(i)],
                         same = without_turns(after[i] - state[i], at.periods[i]),
                         reversed = without_turns(after[i] + state[i], at.periods[i]);
            const bool moves = std::abs(rates[index(i)]) * scales_[index(layout_.duration_of(k))] > most;
            if (moves || (jumps && std::min(std::abs(same), std::abs(reversed)) > most))
                neutral[i] = false;
        }
    }
    ends_.set_parameters(at.parameters);
}

double OrbitEquations::first_duration(std::size_t flight) const {
    const std::size_t segment = layout_.segment_of(flight);
    return contacts_[segment].durations[flight - layout_.first_piece(segment)];
}

/// Fills the row of the end condition of a segment. Event functions have units of their own, so the row is divided by
/// their change over the scales of the states.
/// A flight of a chatter sequence begins on the surface and would satisfy its condition with duration 0 as well: the
/// condition is divided by the duration, relative to its first value, so that Newton's method cannot end there.
void OrbitEquations::assemble_end(std::size_t k, double duration, OrbitEvaluation& at) const {
    const auto n = index(layout_.states()), q = index(layout_.free());
    OrbitEvaluation::Piece& piece = at.pieces[k];
    CyclicSystem::Block& block = at.system.block(k);
    const Eigen::VectorXd state_scales = scales_.head(n), parameter_scales = scales_.tail(q);
    const Eigen::RowVectorXd gradient = piece.condition.head(n).transpose();
    const double size = gradient.cwiseAbs() * state_scales;
    const bool is_flight = layout_.is_contact(k);
    const double unit = (size > 0 ? size : 1) * (is_flight ? duration / first_duration(k) : 1);
    piece.condition_unit = unit;
    const Eigen::RowVectorXd by_start = gradient * piece.flow.leftCols(n) * state_scales.asDiagonal();
    const Eigen::RowVectorXd by_parameters = gradient * piece.flow.rightCols(q) + piece.condition.tail(q).transpose();
    at.effects = at.effects.cwiseMax(by_parameters.transpose().cwiseAbs() / unit);
    block.own.row(0).head(n) = by_start / unit;
    const double by_duration = gradient.dot(piece.by_time) - (is_flight ? piece.condition_value / duration : 0);
    block.own(0, n) = by_duration * scales_[index(layout_.duration_of(k))] / unit;
    block.parameters.row(0) = by_parameters * parameter_scales.asDiagonal() / unit;
    block.right[0] = -piece.condition_value / unit;
}

/// Fills the row of the time that all contacts take that are left of a chatter sequence.
void OrbitEquations::assemble_accumulation(std::size_t k, OrbitEvaluation& at) const {
    const auto n = index(layout_.states()), q = index(layout_.free());
    OrbitEvaluation::Piece& piece = at.pieces[k];
    CyclicSystem::Block& block = at.system.block(k);
    const double unit = scales_[index(layout_.duration_of(k))];
    piece.condition_unit = unit;
    const Eigen::RowVectorXd by_parameters = -piece.time_by.tail(q).transpose() / unit;
    at.effects = at.effects.cwiseMax(by_parameters.transpose().cwiseAbs());
    block.own.row(0).head(n) = -piece.time_by.head(n).cwiseProduct(scales_.head(n)).transpose() / unit;
    block.own(0, n) = 1;
    block.parameters.row(0) = by_parameters * scales_.tail(q).asDiagonal();
    block.right[0] = -piece.condition_value / unit;
}

/// Fills the rows of continuity: the next piece starts in the state after the jump of this one, (x, T, p) -> end ->
/// after.
/// @param neutral states that all pieces so far have returned exactly, or with reversed sign
void OrbitEquations::assemble_closure(std::size_t k, const Eigen::VectorXd& unknowns, OrbitEvaluation& at,
                                      std::vector<bool>& neutral) const {
    const auto n = index(layout_.states()), q = index(layout_.free());
    const OrbitEvaluation::Piece& piece = at.pieces[k];
    CyclicSystem::Block& block = at.system.block(k);
    const Eigen::VectorXd state_scales = scales_.head(n), units = state_scales.cwiseInverse();
    const Eigen::MatrixXd jump = piece.jump.leftCols(n);
    const Eigen::MatrixXd by_start = jump_times(piece, piece.flow.leftCols(n));
    const Eigen::VectorXd by_time = jump * piece.by_time;
    Eigen::MatrixXd by_parameters = jump * piece.flow.rightCols(q) + piece.jump.rightCols(q);
    const std::size_t following = k + 1 < layout_.pieces() ? k + 1 : 0;
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto state = static_cast<std::size_t>(i);
        double difference = unknowns[index(layout_.start_of(following)) + i] - piece.after[state];
        if (at.periods[state] > 0) {
            const double turns = std::round(difference / at.periods[state]);
            difference -= turns * at.periods[state];
            by_parameters.row(i) += turns * ends_.period_rates().row(i);
        }
        block.right[1 + i] = -difference / state_scales[i];
        bool unchanged = by_time[i] == 0 && difference == 0 && by_parameters.row(i).isZero(0);
        for (Eigen::Index j = 0; j < n && unchanged; ++j)
            unchanged = std::abs(by_start(i, j)) == (i == j ? 1 : 0);
        neutral[state] = neutral[state] && unchanged;
    }
    if (n > 0)
        at.effects =
            at.effects.cwiseMax((units.asDiagonal() * by_parameters).cwiseAbs().colwise().maxCoeff().transpose());
    block.own.block(1, 0, n, n) = -(units.asDiagonal() * by_start * state_scales.asDiagonal());
    block.own.block(1, n, n, 1) = -units.cwiseProduct(by_time) * scales_[index(layout_.duration_of(k))];
    block.parameters.bottomRows(n) = -(units.asDiagonal() * by_parameters * scales_.tail(q).asDiagonal());
    block.next.bottomRows(n).setIdentity();
}

/// Fills the rows that take the place of continuity after the last piece of a homoclinic orbit: the coordinates that
/// vanish at its ends.
void OrbitEquations::assemble_ends_at_saddle(const Eigen::VectorXd& unknowns, OrbitEvaluation& at) const {
    const auto n = index(layout_.states()), q = index(layout_.free());
    const OrbitEvaluation::Piece& piece = at.pieces.back();
    CyclicSystem::Block& block = at.system.block(layout_.pieces() - 1);
    const std::span<const double> begin(unknowns.data(), layout_.states());
    const HomoclinicEnds::Projections ends = homoclinic_->projections(begin, piece.end);
    const Eigen::VectorXd state_scales = scales_.head(n);
    const Eigen::MatrixXd by_parameters = ends.by_parameters + ends.by_end * piece.flow.rightCols(q);
    at.effects = at.effects.cwiseMax(by_parameters.cwiseAbs().colwise().maxCoeff().transpose());
    block.own.block(1, 0, n, n) = ends.by_end * piece.flow.leftCols(n) * state_scales.asDiagonal();
    block.own.block(1, n, n, 1) =
        ends.by_end * piece.by_time * scales_[index(layout_.duration_of(layout_.pieces() - 1))];
    block.parameters.bottomRows(n) = by_parameters * scales_.tail(q).asDiagonal();
    block.next.bottomRows(n) = ends.by_begin * state_scales.asDiagonal();
    block.right.tail(n) = -ends.values;
    const HomoclinicEnds::Condition departure = homoclinic_->departs(begin);
    at.departure = departure.value;
    at.departure_by = departure.gradient;
    at.eigenvalues = homoclinic_->saddle().eigenvalues();
}

/// Fills the rows that take the place of continuity after the last piece of an orbit that is homoclinic to a cycle.
void OrbitEquations::assemble_ends_at_cycle(const Eigen::VectorXd& unknowns, OrbitEvaluation& at) const {
    const auto n = index(layout_.states()), q = index(layout_.free());
    const OrbitEvaluation::Piece& piece = at.pieces.back();
    CyclicSystem::Block& block = at.system.block(layout_.pieces() - 1);
    const CycleEnds::Equations ends =
        cycle_->equations({unknowns.data(), layout_.states()}, piece.after, ends_.period_rates());
    const Eigen::VectorXd state_scales = scales_.head(n), units = state_scales.cwiseInverse();
    const Eigen::MatrixXd by_end = units.asDiagonal() * ends.by_end * piece.jump.leftCols(n);
    const Eigen::MatrixXd by_parameters =
        units.asDiagonal() * (ends.by_parameters + ends.by_end * piece.jump.rightCols(q)) +
        by_end * piece.flow.rightCols(q);
    at.effects = at.effects.cwiseMax(by_parameters.cwiseAbs().colwise().maxCoeff().transpose());
    block.own.block(1, 0, n, n) = by_end * piece.flow.leftCols(n) * state_scales.asDiagonal();
    block.own.block(1, n, n, 1) = by_end * piece.by_time * scales_[index(layout_.duration_of(layout_.pieces() - 1))];
    block.parameters.bottomRows(n) = by_parameters * scales_.tail(q).asDiagonal();
    block.next.bottomRows(n) = units.asDiagonal() * ends.by_begin * state_scales.asDiagonal();
    block.right.tail(n) = -units.cwiseProduct(ends.values);
}

/// Subtracts from the continuity row of a state in the last piece that of the drifting state with which it is
/// translated: the distance between the two closes.
void OrbitEquations::close_with(std::size_t state, std::size_t drifting, OrbitEvaluation& at) const {
    CyclicSystem::Block& block = at.system.block(layout_.pieces() - 1);
    const Eigen::Index row = index(state) + 1, other = index(drifting) + 1;
    const double ratio = scales_[index(drifting)] / scales_[index(state)];
    block.own.row(row) -= ratio * block.own.row(other);
    block.parameters.row(row) -= ratio * block.parameters.row(other);
    block.next.row(row) -= ratio * block.next.row(other);
    block.right[row] -= ratio * block.right[other];
}

/// Replaces the continuity rows of neutral and drifting states of the last piece: they are held at their first value.
void OrbitEquations::pin(const Eigen::VectorXd& unknowns, const std::vector<bool>& neutral, OrbitEvaluation& at) const {
    CyclicSystem::Block& block = at.system.block(layout_.pieces() - 1);
    at.active.clear();
    for (std::size_t i = 0; i < layout_.states(); ++i)
        if (const auto& with = model().states[i].drifts_with)
            close_with(i, *with, at);
    for (std::size_t i = 0; i < layout_.states(); ++i) {
        if (!neutral[i] && !model().states[i].drifting) {
            at.active.push_back(i);
            continue;
        }
        const auto row = index(i) + 1;
        block.own.row(row).setZero();
        block.parameters.row(row).setZero();
        block.next.row(row).setZero();
        block.next(row, index(i)) = 1;
        block.right[row] = (reference_[i] - unknowns[index(i)]) / scales_[index(i)];
    }
}

/// Returns the borders with the inner unknowns eliminated, in scaled unknowns: starts and durations, then parameters.
/// @param lack set to the contribution of the inner defects
Eigen::MatrixXd OrbitEquations::condensed(const OrbitEvaluation& at, const Eigen::MatrixXd& borders,
                                          Eigen::VectorXd& lack) const {
    const Eigen::Index width = index(layout_.states()) + 1, q = index(layout_.free()), inner = index(layout_.inner()),
                       outer = index(layout_.inner_of(0));
    Eigen::MatrixXd result(borders.rows(), outer + q);
    result << borders.leftCols(outer), borders.rightCols(q);
    lack.setZero(borders.rows());
    for (std::size_t k = 0; k < layout_.pieces() && inner > 0; ++k) {
        const Eigen::MatrixXd changes = borders.middleCols(index(layout_.inner_of(k)), inner) * at.pieces[k].inner;
        result.middleCols(index(layout_.start_of(k)), width) += changes.leftCols(width);
        result.rightCols(q) += changes.middleCols(width, q);
        lack += changes.rightCols(1);
    }
    result.leftCols(outer) *= at.scales.head(outer).asDiagonal();
    result.rightCols(q) *= at.scales.tail(q).asDiagonal();
    return result;
}

/// Returns all unknowns from the scaled ones without the inner ones.
Eigen::VectorXd OrbitEquations::expanded(const OrbitEvaluation& at, const Eigen::VectorXd& outer,
                                         bool homogeneous) const {
    const Eigen::Index width = index(layout_.states()) + 1, q = index(layout_.free()), inner = index(layout_.inner()),
                       count = index(layout_.inner_of(0));
    Eigen::VectorXd unknowns(index(layout_.unknowns()));
    unknowns.head(count) = outer.head(count).cwiseProduct(at.scales.head(count));
    unknowns.tail(q) = outer.tail(q).cwiseProduct(at.scales.tail(q));
    for (std::size_t k = 0; k < layout_.pieces() && inner > 0; ++k) {
        Eigen::VectorXd changes(width + q + 1);
        changes << unknowns.segment(index(layout_.start_of(k)), width), unknowns.tail(q), homogeneous ? 0.0 : 1.0;
        unknowns.segment(index(layout_.inner_of(k)), inner) = at.pieces[k].inner * changes;
    }
    return unknowns;
}

OrbitEquations::Closed OrbitEquations::close(const OrbitEvaluation& at, const Eigen::MatrixXd& borders) const {
    Closed closed;
    closed.system = at.system.close(condensed(at, borders, closed.lack));
    return closed;
}

bool OrbitEquations::solve(const OrbitEvaluation& at, const Closed& closed, const Eigen::VectorXd& right,
                           bool homogeneous, Eigen::VectorXd& step) const {
    Eigen::VectorXd outer, blocks;
    if (!homogeneous)
        blocks = at.system.right_hand_sides();
    const Eigen::VectorXd values = homogeneous ? right : right - closed.lack;
    if (!at.system.solve(closed.system, homogeneous ? nullptr : &blocks, values, outer))
        return false;
    step = expanded(at, outer, homogeneous);
    return true;
}

bool OrbitEquations::respond(const OrbitEvaluation& at, const Eigen::VectorXd& change, Eigen::VectorXd& step) const {
    const Closed closed = close(at, Eigen::MatrixXd(0, index(layout_.unknowns())));
    Eigen::VectorXd outer;
    if (!at.system.solve(closed.system, &change, Eigen::VectorXd(0), outer))
        return false;
    step = expanded(at, outer, true);
    return true;
}

bool OrbitEquations::solve_nearest(const OrbitEvaluation& at, Eigen::VectorXd& step, std::size_t& deficiency) const {
    Eigen::VectorXd outer;
    if (!at.system.solve_nearest(at.system.right_hand_sides(), outer, deficiency))
        return false;
    step = expanded(at, outer, false);
    return true;
}

bool OrbitEquations::chord(const OrbitEvaluation& at, const Closed& closed, const Eigen::VectorXd& unknowns,
                           const Eigen::VectorXd& right, Eigen::VectorXd& step, ModeFlow* other) {
    std::vector<double> parameters;
    set_parameters(unknowns, parameters);
    if (other)
        other->set_parameters(parameters);
    Eigen::VectorXd blocks(index(layout_.start_of(layout_.pieces()))), outer;
    for (std::size_t k = 0; k < layout_.pieces(); ++k)
        if (!set_right(k, unknowns, at, blocks, other ? *other : flow_))
            return false;
    if (!blocks.allFinite() || !at.system.solve(closed.system, &blocks, right, outer))
        return false;
    step = expanded(at, outer, true);
    return true;
}

/// Sets the right-hand side of a piece's equations at other unknowns than those of the evaluation, in its units.
bool OrbitEquations::set_right(std::size_t k, const Eigen::VectorXd& unknowns, const OrbitEvaluation& at,
                               Eigen::VectorXd& right, ModeFlow& flow) {
    const std::size_t n = layout_.states(), place = layout_.start_of(k), segment = layout_.segment_of(k);
    const Eigen::Index duration = index(layout_.duration_of(k));
    std::vector<double> state(unknowns.data() + place, unknowns.data() + place + n);
    double condition = 0;
    if (layout_.accumulates(k)) {
        Accumulation::Remainder left;
        std::vector<double> parameters = parameters_;
        for (std::size_t f = 0; f < layout_.free(); ++f)
            parameters[free()[f].place()] = unknowns[index(layout_.parameter(f))];
        if (!accumulations_[segment]->evaluate(state, parameters, left))
            return false;
        state = numbers_of(left.state);
        condition = unknowns[duration] - left.time;
    } else if (flow.run(modes_[segment], state, unknowns[duration]) != ModeFlow::Ending::done) {
        return false;
    }
    if (layout_.has_end(k)) {
        if (!ends_.pass(segment, state, condition, passed_at(k)))
            return false;
        right[index(place)] = -condition / at.pieces[k].condition_unit;
    } else {
        right[index(place)] = (fixed_durations_[k] - unknowns[duration]) / at.scales[duration];
    }
    const std::size_t following = k + 1 < layout_.pieces() ? layout_.start_of(k + 1) : 0;
    std::size_t active = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const bool held = following == 0 && (active == at.active.size() || at.active[active] != i);
        active += following == 0 && !held ? 1 : 0;
        const double start = unknowns[index(following + i)], period = ends_.periods()[i];
        double difference = held ? start - reference_[i] : without_turns(start - state[i], period);
        if (const auto& with = model().states[i].drifts_with; with && following == 0 && !held)
            difference -= unknowns[index(following + *with)] - state[*with];
        right[index(place + 1 + i)] = -difference / at.scales[index(i)];
    }
    return true;
}

bool OrbitEquations::null_vector(const OrbitEvaluation& at, const Eigen::RowVectorXd& row,
                                 Eigen::VectorXd& vector) const {
    Eigen::VectorXd lack, outer;
    const Eigen::MatrixXd borders = condensed(at, row, lack);
    if (!at.system.null_vector(borders / borders.norm(), outer))
        return false;
    const double size = outer.norm();
    if (!(size > 0))
        return false;
    vector = expanded(at, outer / size, true);
    return true;
}

Eigen::RowVectorXd OrbitEquations::row_at_end(const OrbitEvaluation& at, std::size_t k,
                                              const Eigen::VectorXd& gradient) const {
    const auto n = index(layout_.states()), q = index(layout_.free());
    const OrbitEvaluation::Piece& piece = at.pieces[k];
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(index(layout_.unknowns()));
    const Eigen::RowVectorXd by_state = gradient.head(n).transpose();
    row.segment(index(layout_.start_of(k)), n) = by_state * piece.flow.leftCols(n);
    row[index(layout_.duration_of(k))] = by_state.dot(piece.by_time);
    row.tail(q) = by_state * piece.flow.rightCols(q) + gradient.tail(q).transpose();
    return row;
}

Eigen::RowVectorXd OrbitEquations::departure_row(const OrbitEvaluation& at) const {
    const auto n = index(layout_.states()), q = index(layout_.free());
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(index(layout_.unknowns()));
    row.head(n) = at.departure_by.head(n).transpose();
    row.tail(q) = at.departure_by.tail(q).transpose();
    return row;
}

double OrbitEquations::rate_at_end(const OrbitEvaluation& at, std::size_t segment) const {
    const OrbitEvaluation::Piece& piece = at.pieces[layout_.last_piece(segment)];
    return piece.condition.head(index(layout_.states())).dot(piece.field);
}

double OrbitEquations::typical_change(const OrbitEvaluation& at, const Eigen::VectorXd& gradient) const {
    double change = 0;
    for (const std::size_t i : at.active)
        change += std::abs(gradient[index(i)]) * at.scales[index(i)];
    return change / at.scales[index(layout_.duration_of(0))];
}

double OrbitEquations::typical_rate(const OrbitEvaluation& at, std::size_t segment) const {
    return typical_change(at, at.pieces[layout_.last_piece(segment)].condition);
}

double OrbitEquations::typical_rate_of_piece(const OrbitEvaluation& at, std::size_t piece) const {
    return typical_change(at, at.pieces[piece].condition);
}

double OrbitEquations::typical_rate(const OrbitEvaluation& at, std::size_t segment, std::size_t event) const {
    const std::vector<double>& end = at.pieces[layout_.last_piece(segment)].end;
    return typical_change(at, gradient_of(system().event(event)(concatenated(end, at.parameters))));
}

} // namespace graze
