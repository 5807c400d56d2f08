#include "sweep/step_maps.hpp"

#include "flow/tangent_reach.hpp"
#include "graze/flow/step_check.hpp"
#include "graze/flow/tangent_steps.hpp"
#include "graze/symbolic/symbol_index.hpp"
#include "graze/symbolic/transform.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Number of directions up to which lanes are faster than a trajectory that propagates any of them.
constexpr std::size_t most_directions = 6;
/// Largest number of parts of a step. If more are needed, derivatives diverge from a motion of which nothing is known,
/// such as one that has decayed to the smallest numbers.
constexpr std::size_t most_parts_of_map = 16384;
/// Number of completed parts after which their memory is released.
constexpr std::size_t most_done = 1024;

/// Returns whether the rate of a state is constant in all modes, and no jump changes it.
bool is_clock(const System& system, Model& model, std::size_t state) {
    Expression rate;
    for (const Mode& mode : model.modes) {
        const Expression here = model.expand(mode.rates)[state];
        if (!rate.empty() && !(here == rate))
            return false;
        rate = here;
    }
    for (const Expression& symbol : model.state_symbols())
        if (!(differentiate(rate, symbol) == model.number(0)))
            return false;
    for (std::size_t j = 0; j < model.jumps.size(); ++j) {
        const std::vector<std::size_t>& changed = system.jump(j).changed;
        if (std::ranges::find(changed, state) != changed.end())
            return false;
    }
    return true;
}

std::vector<std::size_t> directions_of(const SectionMap& map) {
    const System& system = map.simulation().system();
    Model model = system.model();
    std::vector<std::size_t> directions;
    for (std::size_t i = 0; i < system.states(); ++i)
        if (map.takes_part(i) || !is_clock(system, model, i))
            directions.push_back(i);
    return directions;
}

std::vector<VariationalModes::Mode> linearised(const System& system, const std::vector<std::size_t>& directions) {
    Model model = system.model();
    const std::vector<Expression> states = model.state_symbols();
    std::vector<Expression> along;
    for (const std::size_t i : directions)
        along.push_back(states[i]);
    const SymbolIndex columns(along);
    std::vector<VariationalModes::Mode> modes;
    for (const Mode& mode : model.modes) {
        const std::vector<Expression> rates = model.expand(mode.rates);
        std::vector<Expression> moving, values;
        for (const std::size_t i : directions)
            moving.push_back(rates[i]);
        auto& linear = modes.emplace_back();
        for (JacobianEntry& entry : sparse_jacobian(moving, columns)) {
            linear.entries.push_back({entry.row, entry.column, values.size()});
            values.push_back(std::move(entry.value));
        }
        linear.tape = compile_tape(states, model.parameter_symbols(), rates, values);
    }
    return modes;
}

} // namespace

VariationalModes::VariationalModes(const SectionMap& map) : simulation_(map.simulation()) {
    // Models with many states are not differentiated needlessly.
    if (simulation_.system().states() > 2 * most_directions)
        return;
    directions_ = directions_of(map);
    suit_ = !directions_.empty() && directions_.size() <= most_directions;
    if (suit_)
        modes_ = linearised(simulation_.system(), directions_);
}

StepMaps::Flow::Flow(const VariationalModes::Mode& mode, std::size_t directions, int order)
    : jet(make_jet(mode.tape, order, LaneKind::ensemble)), end_jet(make_jet(mode.tape, order, LaneKind::ensemble)),
      columns(*jet, mode.tape, mode.entries, directions, directions),
      end_columns(*end_jet, mode.tape, mode.entries, directions, directions) {}

StepMaps::StepMaps(const VariationalModes& modes)
    : modes_(&modes), states_(modes.simulation().system().states()), directions_(modes.directions().size()),
      map_size_(std::max<std::size_t>(directions_ * directions_, 1)), order_(modes.simulation().order()),
      tolerance_(TangentSteps::allowance * modes.simulation().options().tolerance),
      lanes_(static_cast<std::size_t>(lanes_of(LaneKind::ensemble, best_instruction_set()))),
      flows_(modes.modes().size()), product_(map_size_), queues_(flows_.size()), times_(lanes_),
      states_here_(states_ * lanes_), states_there_(states_here_.size()), units_(map_size_ * lanes_),
      sums_(units_.size()), slopes_(units_.size()), worst_(lanes_) {
    for (std::size_t d = 0; d < directions_; ++d)
        std::fill_n(&units_[(d * directions_ + d) * lanes_], lanes_, 1.0);
}

void StepMaps::begin(std::span<const double> parameters, std::span<const double> scale) {
    parameters_.resize(parameters.size() * lanes_);
    for (std::size_t j = 0; j < parameters.size(); ++j)
        std::fill_n(&parameters_[j * lanes_], lanes_, parameters[j]);
    for (const auto& flow : flows_)
        if (flow) {
            flow->jet->set_parameters(parameters_);
            flow->end_jet->set_parameters(parameters_);
        }
    scale_.clear();
    for (const std::size_t i : modes_->directions())
        scale_.push_back(scale[i]);
    clear();
}

StepMaps::Flow& StepMaps::flow(std::size_t mode) {
    auto& flow = flows_[mode];
    if (!flow) {
        flow = std::make_unique<Flow>(modes_->modes()[mode], directions_, order_);
        flow->jet->set_parameters(parameters_);
        flow->end_jet->set_parameters(parameters_);
    }
    return *flow;
}

void StepMaps::clear() {
    numbers_.clear();
    maps_.clear();
    known_.clear();
    given_up_ = false;
}

std::size_t StepMaps::add(std::size_t mode, std::span<const double> state, double length) {
    const std::size_t step = steps();
    queues_[mode].push_back({.step = step, .state = numbers_.size(), .length = length, .attempt = length});
    numbers_.insert(numbers_.end(), state.begin(), state.end());
    maps_.resize(maps_.size() + map_size_);
    known_.push_back(true);
    return step;
}

void StepMaps::compute() {
    for (std::size_t mode = 0; mode < queues_.size(); ++mode) {
        std::vector<Part>& queue = queues_[mode];
        for (std::size_t done = 0; done < queue.size() && !given_up_;) {
            const std::size_t count = std::min(lanes_, queue.size() - done);
            batch_.assign(queue.begin() + static_cast<std::ptrdiff_t>(done),
                          queue.begin() + static_cast<std::ptrdiff_t>(done + count));
            compute(mode, batch_);
            done += count;
            if (done >= most_done) {
                queue.erase(queue.begin(), queue.begin() + static_cast<std::ptrdiff_t>(done));
                done = 0;
            }
        }
        for (const Part& part : queue)
            known_[part.step] = known_[part.step] && !given_up_;
        queue.clear();
    }
}

void StepMaps::compute(std::size_t mode, std::span<Part> parts) {
    Flow& here = flow(mode);
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        const Part& part = parts[lane < parts.size() ? lane : 0]; // empty lanes repeat the first
        for (std::size_t i = 0; i < states_; ++i)
            states_here_[i * lanes_ + lane] = numbers_[part.state + i];
        times_[lane] = part.attempt;
    }
    here.jet->compute(states_here_);
    here.columns.compute(units_);
    find_reaches(here.columns, parts);
    here.jet->evaluate_states(times_, states_there_);
    here.columns.evaluate(times_, sums_, slopes_);
    here.end_jet->begin(states_there_);
    here.end_columns.begin(sums_);
    const EndAllowance allowance{StepCheck::allowance * tolerance_ + TangentCheck::round_off, 0,
                                 StepCheck::smallest_size};
    here.columns.misfit(here.end_columns, allowance, times_, scale_, sums_, slopes_, worst_);
    for (std::size_t lane = 0; lane < parts.size(); ++lane) {
        Part& part = parts[lane];
        if (!accept(part, worst_[lane])) {
            queues_[mode].push_back(part);
            continue;
        }
        apply(part, lane);
        continue_after(mode, part, lane);
    }
}

/// Appends the rest of a step after a part of it.
void StepMaps::continue_after(std::size_t mode, const Part& part, std::size_t lane) {
    const double left = part.length - part.attempt;
    if (!(left > 0))
        return;
    if (part.before + 1 >= most_parts_of_map) {
        given_up_ = true;
        known_[part.step] = false;
        return;
    }
    for (std::size_t i = 0; i < states_; ++i)
        numbers_[part.state + i] = states_there_[i * lanes_ + lane];
    queues_[mode].push_back({.step = part.step,
                             .state = part.state,
                             .length = left,
                             .attempt = left,
                             .first_misfit = 0,
                             .halvings = 0,
                             .before = part.before + 1,
                             .accepted = false});
}

/// Finds the length over which each part can be followed at once.
void StepMaps::find_reaches(const ColumnSeries& columns, std::span<Part> parts) {
    constexpr int rounds = 6; // iterations, since sizes shrink with the step
    if (order_ < 3)
        return;
    const double root = 1.0 / (order_ - 1);
    bool too_long = true;
    for (int round = 0; round < rounds && too_long; ++round) {
        columns.tails(times_, scale_, worst_);
        too_long = false;
        for (std::size_t lane = 0; lane < parts.size(); ++lane)
            if (worst_[lane] > tolerance_ && !parts[lane].accepted) {
                times_[lane] *= std::pow(tolerance_ / worst_[lane], root);
                too_long = true;
            }
    }
    for (std::size_t lane = 0; lane < parts.size(); ++lane) {
        if (std::isfinite(times_[lane]) && times_[lane] > 0)
            parts[lane].attempt = times_[lane];
        times_[lane] = parts[lane].attempt;
    }
}

/// Returns whether a part is accurate enough; otherwise it is to be halved.
bool StepMaps::accept(Part& part, double misfit) const {
    if (misfit <= 1 || part.accepted)
        return true;
    if (part.halvings == 0)
        part.first_misfit = misfit;
    if (part.halvings < TangentCheck::most_halvings) {
        ++part.halvings;
        part.attempt *= 0.5;
        return false;
    }
    if (std::isfinite(misfit) && misfit <= TangentCheck::least_gain * part.first_misfit)
        return true;
    part.accepted = true;
    part.attempt = part.length;
    return false;
}

/// Multiplies the map of the completed parts by that of this part.
void StepMaps::apply(const Part& part, std::size_t lane) {
    double* map = &maps_[part.step * map_size_];
    if (part.before == 0) {
        for (std::size_t i = 0; i < directions_ * directions_; ++i)
            map[i] = sums_[i * lanes_ + lane];
        return;
    }
    std::ranges::fill(product_, 0.0);
    for (std::size_t d = 0; d < directions_; ++d)
        for (std::size_t j = 0; j < directions_; ++j)
            for (std::size_t r = 0; r < directions_; ++r)
                product_[d * directions_ + r] +=
                    sums_[(j * directions_ + r) * lanes_ + lane] * map[d * directions_ + j];
    std::ranges::copy(product_, map);
}

} // namespace graze
