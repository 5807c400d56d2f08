#include "graze/sweep/plan.hpp"

#include "base/concatenated.hpp"
#include "base/thread_team.hpp"
#include "base/turns.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/trajectory/ensemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

namespace graze {

bool can_be_carried_on(const PointResult& result) {
    const bool settled = result.label == Label::periodic || result.label == Label::quasi_periodic ||
                         result.label == Label::chaotic || result.label == Label::transient ||
                         result.label == Label::unsettled || result.label == Label::equilibrium;
    return settled && std::ranges::all_of(result.state, [](double x) { return std::isfinite(x); });
}

namespace {

constexpr std::size_t most_steps = 50;
/// Distance from a surface, relative to the size of a step, at which a state counts as on it.
constexpr double on_surface = 4 * std::numeric_limits<double>::epsilon();

/// Returns the admissible state nearest to a state that violates barriers of its mode: a state on their surfaces, by
/// Newton's method along their gradients. Clocks are unchanged.
/// @return nothing if no state on the admissible side of all barriers is found
std::optional<std::vector<double>> nearest_admissible(const System& system, std::span<const double> parameters,
                                                      std::span<const double> state, std::size_t mode) {
    const System::CompiledMode& compiled = system.mode(mode);
    const std::size_t states = system.states(), events = compiled.watched.size();
    std::vector<double> inputs = concatenated(state, parameters), values(events), gradients(events * states);
    std::vector<double> work(system.workspace()), periods(states);
    system.periods().evaluate(parameters, periods, work);
    for (std::size_t step = 0; step < most_steps; ++step) {
        compiled.events.evaluate(inputs, values, work);
        compiled.event_gradients.evaluate(inputs, gradients, work);
        bool moved = false;
        for (std::size_t w = 0; w < events; ++w) {
            if (system.model().events[compiled.watched[w]].kind != EventKind::barrier || values[w] >= 0)
                continue;
            if (!std::isfinite(values[w]))
                return std::nullopt;
            const double* gradient = &gradients[w * states];
            double square = 0;
            for (std::size_t i = 0; i < states; ++i)
                square += periods[i] > 0 ? 0 : gradient[i] * gradient[i];
            if (!(square > 0) || !std::isfinite(square))
                return std::nullopt;
            for (std::size_t i = 0; i < states; ++i) {
                const double change = periods[i] > 0 ? 0 : -values[w] * gradient[i] / square;
                moved = moved || std::abs(change) > on_surface * std::abs(inputs[i]);
                inputs[i] += change;
            }
            break; // the other barriers are examined in the next step
        }
        if (!moved)
            return std::vector<double>(inputs.begin(), inputs.begin() + static_cast<std::ptrdiff_t>(states));
    }
    return std::nullopt;
}

using Sink = std::function<void(std::size_t, const PointStart&, PointResult&)>;

/// Data shared by the threads.
struct Execution {
    const Plan& plan;
    const SearchFactory& searches;
    const KnownChains& known;
    const std::function<PointStart(std::size_t)> start;
    const std::function<bool()> interrupted;
    const Sink sink;

    std::atomic<std::size_t> next_chain{0};
    ThreadTeam team{};

    bool must_stop() {
        if (interrupted && interrupted())
            team.stop();
        return team.is_stopped();
    }
};

/// Executes chains one after another, point by point.
class Worker {
public:
    explicit Worker(Execution& execution) : execution_(&execution), search_(execution.searches.make()) {}

    /// Begins the next point. @return the trajectory to run first; null if there is nothing to do
    Trajectory* next_point() {
        const Plan& plan = execution_->plan;
        while (index_ >= plan.chain_length || !has_chain_) {
            chain_ = execution_->next_chain++;
            if (chain_ >= plan.chains)
                return nullptr;
            has_chain_ = true;
            index_ = execution_->known.done(chain_, plan.chain_length);
            carried_ = false;
            if (const ChainProgress* begun = execution_->known.begun(chain_)) {
                carried_ = begun->done > 0 && begun->regular;
                state_ = begun->state;
                mode_ = begun->mode;
            }
        }
        if (execution_->must_stop())
            return nullptr;
        start_ = execution_->start(chain_ * plan.chain_length + index_);
        start_note_.clear();
        attempt_ = Attempt::initial;
        if (plan.carry)
            initial_ = start_;
        if (plan.carry && carried_ && index_ > 0) {
            start_.state = state_;
            start_.mode = mode_;
            attempt_ = Attempt::carried;
        }
        search_->begin(start_.parameters, start_.state, start_.mode);
        return &search_->trajectory();
    }

    /// Returns the trajectory to run after the last one has finished.
    Trajectory* go_on() {
        if (execution_->must_stop())
            return nullptr;
        if (search_->proceed())
            return &search_->trajectory();
        PointResult& result = search_->result();
        if (was_refused(result) && try_another_start())
            return &search_->trajectory();
        if (!start_note_.empty())
            result.outcome.detail += (result.outcome.detail.empty() ? "" : "; ") + start_note_;
        carried_ = can_be_carried_on(result);
        if (execution_->plan.carry) {
            state_ = result.state;
            mode_ = result.mode;
        }
        execution_->sink(chain_ * execution_->plan.chain_length + index_, start_, result);
        ++index_;
        return next_point();
    }

private:
    /// Returns whether a carried state violates a barrier at this point.
    bool was_refused(const PointResult& result) const {
        return execution_->plan.carry && index_ > 0 && result.outcome.ending == Ending::inadmissible &&
               result.time == 0;
    }

    /// Tries the point's own initial state instead of the carried one, then the nearest admissible state.
    bool try_another_start() {
        if (attempt_ == Attempt::carried) {
            attempt_ = Attempt::initial;
            start_ = initial_;
            start_note_ = "began anew at the initial state: the one carried from the point before violates a barrier";
        } else if (attempt_ == Attempt::initial) {
            attempt_ = Attempt::nearest;
            const bool from_carried = carried_;
            const auto nearest = nearest_admissible(execution_->searches.simulation().system(), start_.parameters,
                                                    from_carried ? std::span<const double>(state_) : initial_.state,
                                                    from_carried ? mode_ : initial_.mode);
            if (!nearest)
                return false;
            start_.state = *nearest;
            start_.mode = from_carried ? mode_ : initial_.mode;
            start_note_ = fmt::format("began anew at the admissible state nearest to the {} one, since that and the "
                                      "initial one violate a barrier",
                                      from_carried ? "carried" : "initial");
        } else {
            return false;
        }
        search_->begin(start_.parameters, start_.state, start_.mode);
        return true;
    }

    Execution* execution_;
    std::unique_ptr<PointSearch> search_;
    bool has_chain_ = false, carried_ = false;
    std::size_t chain_ = 0, index_ = 0, mode_ = 0;
    std::vector<double> state_;
    PointStart start_, initial_;
    enum class Attempt { carried, initial, nearest } attempt_ = Attempt::initial; ///< kind of the initial state
    std::string start_note_; ///< note on a point that does not start where it should
};

void work_through(Execution& execution, InstructionSet set, std::size_t slots) {
    Ensemble ensemble(execution.searches.simulation(), set);
    ensemble.stop_when([&] { return execution.must_stop(); });
    std::vector<std::unique_ptr<Worker>> workers;
    std::vector<Trajectory*> first;
    for (std::size_t i = 0; i < slots; ++i) {
        workers.push_back(std::make_unique<Worker>(execution));
        first.push_back(workers.back()->next_point());
    }
    ensemble.run(first, [&](std::size_t slot) { return workers[slot]->go_on(); });
}

} // namespace

bool execute(const Plan& plan, const SearchFactory& searches, const KnownChains& known, const ExecutionOptions& options,
             const Sink& sink) {
    if (!plan.start || !sink)
        throw InputError("a plan needs a function for initial values and one for results", "give both functions");
    require_room(plan.chains, known.bound(), "chains of progress");
    for (const auto& [number, chain] : known.begun())
        require_room(plan.chain_length, chain.done, "points of a chain done");
    if (options.jobs < 1)
        throw InputError(fmt::format("{} jobs cannot do anything", options.jobs), "give at least one");
    const Turns turns;
    Execution execution{
        plan, searches, known, turns.taking(plan.start), turns.asking(options.interrupted), turns.taking(sink)};
    std::size_t chains = 0;
    for (const ItemRange& missing : known.missing(plan.chains))
        chains += missing.size();
    if (chains == 0)
        return true;
    const auto jobs = std::min(static_cast<std::size_t>(std::max(options.jobs, 1)), chains);
    const auto lanes = static_cast<std::size_t>(lanes_of(LaneKind::ensemble, options.instruction_set));
    // Two trajectories per lane keep lanes busy while modes differ; few chains are better distributed over threads.
    const std::size_t slots = std::clamp<std::size_t>((chains + jobs - 1) / jobs, 1, 2 * lanes);
    execution.team.run(jobs, [&](bool) { work_through(execution, options.instruction_set, slots); });
    return !execution.team.is_stopped();
}

} // namespace graze
