#include "orbit/certify.hpp"

#include "base/special_numbers.hpp"
#include "graze/flow/roots.hpp"
#include "orbit/shooting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// Event function values below this fraction of the function's size along the arc count as zero.
constexpr double on_surface = 1e-9;

/// Whether none of the transitions for an event changes anything. @param first of them
bool changes_nothing(const System& system, std::size_t first) {
    for (std::optional<std::size_t> one = first; one; one = system.transition(*one).following)
        if (!is_identity_transition(system, *one))
            return false;
    return true;
}

/// Records the minima and the first fall of each watched event function along one segment.
class ArcWatcher {
public:
    /// @param touched event that the orbit is constrained to touch within this segment, if any
    /// @param origin time at which the arc begins, since the start of the segment
    ArcWatcher(const OrbitEquations& equations, std::size_t segment, RootFinder& roots,
               std::optional<std::size_t> touched, double origin = 0)
        : equations_(&equations), segment_(segment), touched_(touched), origin_(origin),
          mode_(&equations.system().mode(equations.signature()[segment].mode)), roots_(&roots),
          sizes_(mode_->watched.size(), 0.0), falls_(mode_->watched.size(), std::numeric_limits<double>::infinity()),
          starts_(mode_->watched.size(), 0.0), lowest_(mode_->watched.size(), std::numeric_limits<double>::infinity()),
          extrema_(mode_->watched.size()) {
        const System& compiled = equations.system();
        for (std::size_t w = 0; w < mode_->watched.size(); ++w)
            identity_.push_back(changes_nothing(compiled, mode_->transitions[w]));
    }

    /// @param begin start time of the arc of the series, from the start of the segment
    void scan(const WatchedSeries& series, double begin) {
        for (std::size_t step = 0; step < series.steps().size(); ++step)
            scan(series, step, begin + series.steps()[step].time);
    }

    void scan(const WatchedSeries& series, std::size_t step, double time) {
        const double length = series.steps()[step].length, sign = length < 0 ? -1 : 1;
        for (std::size_t w = 0; w < mode_->watched.size(); ++w) {
            if (identity_[w] && !is_own(w))
                continue;
            const std::span<const double> c = series.of(step, w);
            coefficients_.assign(c.begin(), c.end());
            double power = 1;
            for (double& coefficient : coefficients_) {
                coefficient *= power;
                power *= sign;
            }
            const double size = RootFinder::enclosure(coefficients_, std::abs(length), RootStart::as_is).size;
            sizes_[w] = std::max(sizes_[w], size);
            const bool first = time == 0;
            if (first)
                starts_[w] = coefficients_[0];
            note_lowest(w, evaluate_polynomial(coefficients_, std::abs(length)));
            const bool on_surface_here = first && std::abs(coefficients_[0]) <= on_surface * sizes_[w];
            find_extrema(w, time, length, on_surface_here ? size : 0);
            if (std::isinf(falls_[w])) {
                Root root;
                const bool zero = std::abs(coefficients_[0]) <= on_surface * sizes_[w];
                if (roots_->first_falling(coefficients_, std::abs(length),
                                          first && zero ? RootStart::deflate : RootStart::as_is, root))
                    falls_[w] = time + sign * root.at;
            }
        }
    }

    /// Returns why the model would not follow the segment; empty if it would. @param ends event functions at its end,
    /// with their rates and round-off errors
    std::string violation(double duration, std::span<const double> ends, std::span<const double> rates,
                          std::span<const double> round_off) const {
        const Model& model = equations_->model();
        if (duration < 0)
            return fmt::format("segment {} has negative duration", segment_ + 1);
        for (std::size_t w = 0; w < mode_->watched.size(); ++w) {
            if (identity_[w] && !is_own(w))
                continue;
            const Event& event = model.events[mode_->watched[w]];
            const double zero =
                std::max(on_surface * std::max(sizes_[w], std::numeric_limits<double>::min()), round_off[w]);
            // The end time is uncertain by round-off over speed. At zero speed it is known to the square root of
            // round-off, so that the uncertainty is bounded.
            const double latest = std::abs(duration) * 1e-4;
            const double late =
                std::max(std::abs(duration) * 1e-9,
                         is_own(w) && rates[w] != 0 ? std::min(round_off[w] / std::abs(rates[w]), latest) : 0);
            if (event.kind == EventKind::barrier && starts_[w] < -zero)
                return fmt::format("segment {} begins beyond event '{}'", segment_ + 1, event.name);
            // An orbit that only touches the surface may lie on either side of it, within round-off.
            const bool beyond = lowest_[w] < -std::max(smallest_clearance * sizes_[w], round_off[w]);
            if (falls_[w] < duration - late && beyond)
                return fmt::format("event '{}' happens within segment {}", event.name, segment_ + 1);
            // Without a fall the orbit entered the forbidden side at the start, with zero speed.
            if (event.kind == EventKind::barrier && std::isinf(falls_[w]) && lowest_[w] < -zero)
                return fmt::format("segment {} leaves the surface of event '{}' on the forbidden side", segment_ + 1,
                                   event.name);
            if (!is_own(w) && event.kind == EventKind::barrier && ends[w] < -zero)
                return fmt::format("segment {} ends beyond event '{}'", segment_ + 1, event.name);
        }
        return {};
    }
    /// @param ends values of the event functions at the end of the segment
    std::vector<OrbitMinimum> minima(std::span<const double> ends) const {
        std::vector<OrbitMinimum> result;
        for (std::size_t w = 0; w < mode_->watched.size(); ++w)
            add_clearances(w, ends[w], result);
        std::ranges::stable_sort(result, [](const OrbitMinimum& a, const OrbitMinimum& b) { return a.time < b.time; });
        return result;
    }
    /// Whether the segment ends where this event happens, alone or with others. Of several transitions for one event
    /// any may be made.
    bool is_own(std::size_t w) const {
        const Transition* const made = transition_of(equations_->model(), equations_->signature()[segment_]);
        const std::size_t event = mode_->watched[w];
        return made != nullptr && (made->event == event || std::ranges::find(made->also, event) != made->also.end());
    }
    bool is_identity(std::size_t w) const { return identity_[w]; }
    /// Sizes of the functions along the arc. A flight of a chatter sequence has those of the flights before it: its own
    /// height may be as small as the accuracy of the orbit.
    const std::vector<double>& sizes() const { return sizes_; }
    void set_sizes(const std::vector<double>& sizes) { sizes_ = sizes; }

private:
    struct Extremum {
        double time, value;
        bool minimum;
    };

    /// Round-off below zero does not count for the event that the orbit is constrained to touch.
    void note_lowest(std::size_t w, double value) {
        if (touched_ != mode_->watched[w] || std::abs(value) > on_surface * sizes_[w])
            lowest_[w] = std::min(lowest_[w], value);
    }
    /// @param begins_on_surface size of the function, if the segment begins where it is zero; otherwise 0
    void find_extrema(std::size_t w, double time, double length, double begins_on_surface) {
        derivative_.clear();
        for (std::size_t k = 1; k < coefficients_.size(); ++k)
            derivative_.push_back(static_cast<double>(k) * coefficients_[k]);
        const double reach = std::abs(length), sign = length < 0 ? -1 : 1;
        const bool is_section = equations_->model().events[mode_->watched[w]].kind == EventKind::section;
        roots_->crossings(derivative_, reach, RootStart::as_is, found_);
        for (const Root& root : found_) {
            const bool minimum = root.kind == RootKind::rising;
            if (!minimum && !is_section)
                continue;
            const double value = evaluate_polynomial(coefficients_, root.at);
            if (minimum)
                note_lowest(w, value);
            // A motion that leaves the surface with zero speed, as at the end of sticking, has its minimum at the
            // start.
            constexpr double at_start = 1e-4;
            if (root.at <= at_start * reach && std::abs(value) <= on_surface * begins_on_surface)
                continue;
            extrema_[w].push_back({time + sign * root.at, value, minimum});
        }
    }
    /// Appends the clearances of one event: how far its extrema are from making the event happen. A section function
    /// may have either sign and falls through zero where a positive maximum precedes a negative minimum, so of the two
    /// the one nearer to zero is listed: its value passes continuously through zero where a fall appears.
    void add_clearances(std::size_t w, double end, std::vector<OrbitMinimum>& result) const {
        const std::vector<Extremum>& all = extrema_[w];
        const std::size_t event = mode_->watched[w];
        const auto note = [&](const Extremum& one, double value) {
            result.push_back({segment_, event, origin_ + one.time, value, sizes_[w]});
        };
        const bool is_section = equations_->model().events[event].kind == EventKind::section;
        std::vector<double> later(all.size() + 1, is_own(w) ? infinity : end); // minimum from each extremum on
        for (std::size_t i = all.size(); i-- > 0;)
            later[i] = all[i].minimum ? std::min(later[i + 1], all[i].value) : later[i + 1];
        double before = starts_[w] > on_surface * sizes_[w] ? infinity : -infinity;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Extremum& one = all[i];
            if (!is_section) {
                note(one, one.value);
            } else if (one.minimum) {
                if (one.value >= -before)
                    note(one, one.value);
            } else {
                if (before < infinity && -one.value >= later[i + 1])
                    note(one, -one.value);
                before = std::max(before, one.value);
            }
        }
    }

    const OrbitEquations* equations_;
    std::size_t segment_;
    std::optional<std::size_t> touched_;
    double origin_;
    const System::CompiledMode* mode_;
    RootFinder* roots_;
    std::vector<double> sizes_, falls_, starts_, lowest_, coefficients_, derivative_;
    std::vector<std::vector<Extremum>> extrema_; ///< of each event, in the order of time
    std::vector<bool> identity_;
    std::vector<Root> found_;
};

/// Returns the margin by which guards choose the alternative that leads to `next`: negative when they do not.
double guard_margin(const System::CompiledTransition& transition, std::size_t next, std::span<const double> inputs,
                    std::span<double> work) {
    double before = infinity, best = -infinity;
    std::vector<double> values;
    for (const auto& alternative : transition.next) {
        values.resize(alternative.conditions.outputs());
        alternative.conditions.evaluate(inputs, values, work);
        double margin = infinity;
        for (const double value : values)
            margin = std::min(margin, value);
        if (alternative.mode == next)
            best = std::max(best, std::min(before, margin));
        else
            before = std::min(before, -margin); // guards of earlier alternatives must fail
    }
    return best;
}

/// Returns the margin by which conditions before the jump choose a transition of an event: negative when they do not.
/// @param first transition of the mode and event
double choice_margin(const System& system, std::size_t first, std::size_t chosen, std::span<const double> inputs,
                     std::span<double> work) {
    double before = infinity;
    std::vector<double> values;
    for (std::optional<std::size_t> next = first; next; next = system.transition(*next).following) {
        const auto& one = system.transition(*next);
        if (one.also != system.transition(chosen).also)
            continue;
        values.resize(one.when.outputs());
        one.when.evaluate(inputs, values, work);
        double margin = infinity;
        for (const double value : values)
            margin = std::min(margin, value);
        if (*next == chosen)
            return std::min(before, margin);
        before = std::min(before, -margin);
    }
    return before;
}

/// Checks an orbit segment by segment.
class Certifier {
public:
    Certifier(OrbitEquations& equations, const OrbitEvaluation& at, const std::optional<HeldLimit>& held)
        : equations_(&equations), held_(held), system_(&equations.system()), at_(&at),
          states_(equations.layout().states()), roots_(equations.simulation().order()), work_(system_->workspace()),
          inputs_(states_ + at.parameters.size()), field_(states_) {
        std::ranges::copy(at.parameters, inputs_.begin() + static_cast<std::ptrdiff_t>(states_));
    }

    Certificate certify() {
        for (std::size_t s = 0; s < equations_->signature().size(); ++s) {
            if (equations_->layout().is_chatter(s))
                check_contacts(s);
            else
                check_arc(s);
            check_end(s);
        }
        return std::move(certificate_);
    }

private:
    void reject(std::string reason) {
        if (certificate_.admissible && !reason.empty()) {
            certificate_.admissible = false;
            certificate_.reason = std::move(reason);
        }
    }
    bool is_held(HeldLimit::Kind kind, std::size_t segment) const {
        return held_ && held_->kind == kind && held_->segment == segment;
    }
    void set_state(const std::vector<double>& state) { std::copy(state.begin(), state.end(), inputs_.begin()); }
    /// Returns the rate of a watched event function along a vector field. Requires evaluate_gradients.
    double rate_of(std::size_t watched, const Eigen::VectorXd& field) const {
        return Eigen::Map<const Eigen::VectorXd>(&gradients_[watched * states_], index(states_)).dot(field);
    }
    /// Returns the round-off error of a watched event function at a state, propagated from the states: a gap that is a
    /// difference of positions is no better known than the positions. Requires evaluate_gradients at the state.
    double round_off_of(std::size_t watched, const std::vector<double>& state) const {
        constexpr double share = 16 * std::numeric_limits<double>::epsilon();
        double sum = 0;
        for (std::size_t i = 0; i < states_; ++i)
            sum += std::abs(gradients_[watched * states_ + i] * state[i]);
        return share * sum;
    }
    void evaluate_gradients(const System::CompiledMode& mode) {
        gradients_.resize(mode.watched.size() * states_);
        mode.event_gradients.evaluate(inputs_, gradients_, work_);
    }

    void check_arc(std::size_t s) {
        const OrbitLayout& layout = equations_->layout();
        const Segment& segment = equations_->signature()[s];
        const auto& mode = system_->mode(segment.mode);
        ArcWatcher watcher(*equations_, s, roots_,
                           is_held(HeldLimit::Kind::touch, s) ? std::optional(held_->event) : std::nullopt);
        double begin = 0;
        for (std::size_t k = layout.first_piece(s); k <= layout.last_piece(s); ++k) {
            const double duration = at_->unknowns[index(layout.duration_of(k))];
            if (!at_->pieces[k].watched.steps().empty())
                watcher.scan(at_->pieces[k].watched, begin);
            else if (!mode.watched.empty())
                watcher.scan(integrated(k, duration), begin);
            begin += duration;
        }
        judge_arc(s, watcher, at_->pieces[layout.last_piece(s)], begin, true);
    }

    /// Judges an arc that has been scanned, and records its minima. @param last piece, with its end; @param at_end
    /// whether the segment ends there
    void judge_arc(std::size_t s, const ArcWatcher& watcher, const OrbitEvaluation::Piece& last, double duration,
                   bool at_end) {
        const auto& mode = system_->mode(equations_->signature()[s].mode);
        set_state(last.end);
        values_.resize(mode.watched.size());
        mode.events.evaluate(inputs_, values_, work_);
        evaluate_gradients(mode);
        std::vector<double> rates, round_off;
        for (std::size_t w = 0; w < mode.watched.size(); ++w) {
            rates.push_back(rate_of(w, last.field));
            round_off.push_back(round_off_of(w, last.end));
            if (at_end && !watcher.is_own(w) && !watcher.is_identity(w))
                certificate_.end_values.push_back({s, mode.watched[w], values_[w], rates.back()});
        }
        if (!held_ ||
            !held_->has_zero_duration(
                s, equations_->signature().size())) // a verdict on a segment of no duration would be round-off
            reject(watcher.violation(duration, values_, rates, round_off));
        for (const OrbitMinimum& minimum : watcher.minima(values_))
            certificate_.minima.push_back(minimum);
    }

    /// Checks a complete chatter sequence: each flight between contacts that are resolved, and that each contact is
    /// made and leads back. The remaining contacts are slow, and nothing else can come between them.
    void check_contacts(std::size_t s) {
        const OrbitLayout& layout = equations_->layout();
        const Segment& segment = equations_->signature()[s];
        double begin = 0;
        std::vector<double> sizes;
        for (std::size_t k = layout.first_piece(s); k < layout.last_piece(s); ++k) {
            const double duration = at_->unknowns[index(layout.duration_of(k))];
            const OrbitEvaluation::Piece& piece = at_->pieces[k];
            ArcWatcher watcher(*equations_, s, roots_,
                               is_held(HeldLimit::Kind::touch, s) ? std::optional(held_->event) : std::nullopt, begin);
            if (!sizes.empty())
                watcher.set_sizes(sizes);
            watcher.scan(piece.watched, 0);
            sizes = watcher.sizes();
            judge_arc(s, watcher, piece, duration, false);
            const double rate = piece.condition.head(index(states_)).dot(piece.field);
            if (rate > least_rate * equations_->typical_rate_of_piece(*at_, k))
                reject(fmt::format("a contact within segment {} rises instead of falling", s + 1));
            set_state(piece.after);
            if (guard_margin(system_->transition(segment.index), segment.mode, inputs_, work_) < 0)
                reject(fmt::format("the guard after a contact within segment {} leads to another mode", s + 1));
            begin += duration;
        }
        const OrbitEvaluation::Piece& last = at_->pieces[layout.last_piece(s)];
        const double left = at_->unknowns[index(layout.duration_of(layout.last_piece(s)))];
        ArcWatcher watcher(*equations_, s, roots_, std::nullopt, begin);
        judge_arc(s, watcher, last, left, true);
    }

    /// Returns the event functions along a piece that the discretisation has not integrated.
    const WatchedSeries& integrated(std::size_t k, double duration) {
        const double* start = at_->unknowns.data() + equations_->layout().start_of(k);
        std::vector<double> state(start, start + states_);
        equations_->flow_at(*at_).run(equations_->mode_of(k), state, duration, series_);
        return series_;
    }

    void check_end(std::size_t s) {
        const Segment& segment = equations_->signature()[s];
        const double rate = equations_->rate_at_end(*at_, s);
        if (segment.end != SegmentEnd::event) {
            certificate_.approach_speeds.push_back(std::abs(rate));
            certificate_.departures.push_back(rate);
            certificate_.guard_margins.push_back(std::numeric_limits<double>::infinity());
            return;
        }
        certificate_.approach_speeds.push_back(-rate);
        if (rate > least_rate * equations_->typical_rate(*at_, s))
            reject(fmt::format("the event that ends segment {} rises instead of falling", s + 1));
        // Guards of a half orbit's last jump act on the state before the symmetry is applied.
        std::vector<double> after = at_->pieces[equations_->layout().last_piece(s)].end;
        set_state(after);
        const auto& mode = system_->mode(segment.mode);
        const auto own = static_cast<std::size_t>(
            std::ranges::find(mode.watched, equations_->model().transitions[segment.index].event) -
            mode.watched.begin());
        const double chosen = choice_margin(*system_, mode.transitions[own], segment.index, inputs_, work_);
        const auto& jump = system_->jump(equations_->model().transitions[segment.index].jump);
        if (!jump.identity)
            jump.map.evaluate(inputs_, after, work_);
        set_state(after);
        const std::size_t next = mode_after(s);
        const double margin = std::min(chosen, guard_margin(system_->transition(segment.index), next, inputs_, work_));
        certificate_.guard_margins.push_back(margin);
        // Guards after a contact at zero speed may depend on round-off alone.
        const bool decided_by_round_off =
            is_held(HeldLimit::Kind::guard, s) || (is_held(HeldLimit::Kind::stop, s) && held_->zero_durations > 0);
        if (margin < 0 && !decided_by_round_off)
            reject(fmt::format("the guard after segment {} leads to another mode", s + 1));
        system_->mode(next).rates.evaluate(inputs_, field_, work_);
        evaluate_gradients(mode);
        certificate_.departures.push_back(
            rate_of(own, Eigen::Map<const Eigen::VectorXd>(field_.data(), index(states_))));
    }

    /// Returns the mode after a segment; for the last one of a half orbit, the mode before the symmetry is applied.
    std::size_t mode_after(std::size_t s) const {
        const std::size_t segments = equations_->signature().size();
        const std::size_t next = equations_->signature()[(s + 1) % segments].mode;
        if (!equations_->symmetry() || s + 1 < segments)
            return next;
        const auto& images = equations_->model().symmetries[*equations_->symmetry()].modes;
        return static_cast<std::size_t>(std::ranges::find(images, next) - images.begin());
    }

    OrbitEquations* equations_;
    std::optional<HeldLimit> held_;
    const System* system_;
    const OrbitEvaluation* at_;
    std::size_t states_;
    WatchedSeries series_;
    RootFinder roots_;
    std::vector<double> work_, inputs_, values_, gradients_, field_;
    Certificate certificate_;
};

} // namespace

bool is_identity_transition(const System& model, std::size_t transition) {
    const Transition& one = model.model().transitions[transition];
    return model.jump(one.jump).identity &&
           std::ranges::all_of(one.next, [&](const Alternative& alternative) { return alternative.mode == one.mode; });
}

Certificate certify(OrbitEquations& equations, const OrbitEvaluation& at, const std::optional<HeldLimit>& held) {
    return Certifier(equations, at, held).certify();
}

bool is_admissible(const Simulation& simulation, const Orbit& orbit, std::string& why) {
    Shooting shooting(simulation, orbit, {});
    OrbitEvaluation at = shooting.evaluation();
    if (!shooting.evaluate(shooting.unknowns_of(orbit), at))
        return false;
    const Certificate certificate = certify(shooting, at);
    if (!certificate.admissible)
        why = certificate.reason;
    return certificate.admissible && std::ranges::all_of(orbit.durations, [](double duration) { return duration > 0; });
}

} // namespace graze
